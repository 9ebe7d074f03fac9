"""Reports: self-contained HTML pages of results, for readers without stickslip."""
