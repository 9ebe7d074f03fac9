"""What the page shows of one position of the sliders: figures, tables and messages."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any, TypeAlias, get_args

import numpy as np

from stickslip.analyses.optimal_damper import optimal_damper
from stickslip.analyses.variation import chosen_contacts
from stickslip.drawn import Axes
from stickslip.errors import ModelError
from stickslip.html.figures import Drawn, drawn
from stickslip.model import Model
from stickslip.plot import style
from stickslip.plot.limits import force_level
from stickslip.results.forced_response import ForcedResponse
from stickslip.results.optimal_damper import OptimalDamper
from stickslip.settings.balance import HarmonicSettings
from stickslip.settings.variation import COULOMB, Common, Parameter
from stickslip.study import Study
from stickslip.views.kinds import cautions, failures, view_of
from stickslip.views.picture import Panel
from stickslip.views.tables import Table

Look: TypeAlias = Callable[[float], None]
"""Is told the share of the work done; raises if nobody waits for it any more."""

PARAMETERS = tuple(one for one in get_args(Parameter) if one != "gap")
"""What a damper curve can be over. A gap is not looked for by factors."""

_WIDE = 10.0
"""Factor up and down between which parameters of Coulomb contacts are looked for."""

ONE_DRAWS = threading.Lock()
"""Held while something is drawn: Matplotlib is not made for several threads."""


@dataclass
class Pane:
    """A part of the page."""

    name: str
    panels: list[Panel] = field(default_factory=list)
    figures: list[Drawn] = field(default_factory=list)
    tables: list[Table] = field(default_factory=list)
    failures: list[str] = field(default_factory=list)
    cautions: list[str] = field(default_factory=list)

    def draw(self, look: Look) -> Pane:
        """Draw the panels; what one refuses is a message."""
        for panel in self.panels:
            look(1.0)
            try:
                with ONE_DRAWS:
                    self.figures.append(drawn(panel))
            except ModelError as error:
                self.failures.append(str(error))
        return self

    def message(self) -> dict[str, Any]:
        """Return what the page is told."""
        return {
            "pane": self.name,
            "figures": [vars(figure) for figure in self.figures],
            "tables": [_told(table) for table in self.tables],
            "failures": self.failures,
            "cautions": self.cautions,
        }


def curve(study: Study, result: ForcedResponse, dof: str) -> Pane:
    """Return the response curve between its linear limits, with its error band and its peak."""
    output = study.tables.output
    view = view_of([result], output.frequency_unit)
    return Pane(
        "curve",
        panels=list(view.panels([result], [dof], output)),
        tables=view.tables([("", result)], "", [dof], output.length_unit),
        failures=failures(result),
        cautions=cautions(result),
    )


def contacts(study: Study, result: ForcedResponse, dof: str) -> Pane:
    """Return what contacts do: slip over frequency, and loops at the highest point."""
    view = view_of([result])
    return Pane("contacts", panels=list(view.details(result, [dof], study.tables.output)))


def damper(
    study: Study, result: ForcedResponse, dof: str, parameter: Parameter, look: Look
) -> Pane:
    """Return the peak of a curve along a parameter, with the optimum and the present value.

    Raises
    ------
    ModelError
        If the model has no such parameter, or no minimum is found.
    """
    model = result.model
    common, now = present(model, parameter)
    found = _optimum(study, result, dof, parameter, common, now, look)
    output = study.tables.output
    view = view_of([found], output.frequency_unit)
    at, unit = now, found.curve.settings.variation.unit.removesuffix("1")
    if parameter == "level" and force_level(model):
        at, unit = force_level(model), "N"
    drawn = view.panels([found], [dof], output)
    return Pane(
        "damper",
        panels=[partial(_with_present, one, at, unit) for one in drawn],
        tables=view.tables([("", found)], "", [dof], output.length_unit),
        failures=failures(found),
        cautions=cautions(found),
    )


def present(model: Model, parameter: Parameter) -> tuple[Common, float]:
    """Return how contacts share a parameter, and its value now.

    It is the value that all have, or the factor 1 on different ones.

    Raises
    ------
    ModelError
        If none of them has it.
    """
    if parameter == "level":
        return "value", 1.0
    chosen_contacts(model, parameter, None, "factor")
    able = [one for one in model.contacts if parameter in one.adjustable()]
    values = {value for one in able for value in one.adjustable()[parameter] if np.isfinite(value)}
    if len(values) == 1 and all(parameter not in one.factors for one in able):
        (value,) = values
        if value > 0.0:
            return "value", value
    return "factor", 1.0


def parameters(model: Model) -> list[Parameter]:
    """Return the parameters that a damper curve of a model can be over."""
    known = {name for contact in model.contacts for name in contact.adjustable()}
    # what a level does depends on the slip forces that it is set against
    known |= {"level"} if "slip_force" in known and force_level(model) else set()
    return [name for name in PARAMETERS if name in known]


def _optimum(
    study: Study,
    result: ForcedResponse,
    dof: str,
    parameter: Parameter,
    common: Common,
    now: float,
    look: Look,
) -> OptimalDamper:
    omega, analysis = result.omega, study.tables.analysis
    keys: dict[str, Any] = {}
    if isinstance(analysis, HarmonicSettings):
        keys = {name: getattr(analysis, name) for name in HarmonicSettings.model_fields}
    if omega.min() < omega.max():
        keys["omega"] = float(omega.min()), float(omega.max())
    if parameter in COULOMB:
        keys["bounds"] = now / _WIDE, now * _WIDE
    given = {"dof": dof, "parameter": parameter, "common": common}
    return optimal_damper(result.model, **given, **keys, progress=look)


def _with_present(panel: Panel, value: float, unit: str, *, ax: Axes) -> None:
    """Draw a damper curve, and where on it the sliders stand."""
    panel(ax=ax)
    low, high = ax.get_xlim()
    now = style.written(value, unit)
    if low <= value <= high:
        ax.axvline(value, color="0.35", lw=1.0, ls=":", label=f"now: {now}")
        style.finish(ax, made=False)


def _told(table: Table) -> dict[str, object]:
    columns: Sequence[Any] = table.columns
    cells = [[str(cell) for cell in column.cells] for column in columns]
    return {
        "title": str(table.title or ""),
        "headings": [str(column.header) for column in columns],
        "numbers": [column.justify == "right" for column in columns],
        "rows": [list(row) for row in zip(*cells, strict=True)],
        "notes": str(table.caption or "").splitlines(),
    }
