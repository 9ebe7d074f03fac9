"""Study files: a model and its analysis in TOML."""

from stickslip.study.study import Case, Study, json_schema, notable_dofs

__all__ = ["Case", "Study", "json_schema", "notable_dofs"]
