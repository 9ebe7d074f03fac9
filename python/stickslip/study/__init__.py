"""Study files: a model and its analysis in TOML."""

from stickslip.calls import checked_names
from stickslip.study.study import Case, Study, json_schema

__all__ = ["Case", "Study", "json_schema"]

checked_names(globals(), __all__)
