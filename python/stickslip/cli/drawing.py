"""What ``stickslip plot`` draws: the picture that its options ask for."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Literal

from stickslip.errors import ModelError
from stickslip.results import ForcedResponse
from stickslip.results.exact_response import ExactResponse
from stickslip.views.kinds import view_of
from stickslip.views.picture import titled

if TYPE_CHECKING:
    from stickslip.results.result import Result
    from stickslip.views.picture import Panel

__all__ = ["Wanted", "picture_of"]


@dataclass(frozen=True, kw_only=True)
class Wanted:
    """What of results is to be drawn, as the options of the command say."""

    dofs: Sequence[str] | None = None
    hertz: bool = False
    log: bool = True
    per_force: bool = False
    waveform: str | None = None
    loop: str | None = None
    contact: str = "0"
    events: str | None = None
    multipliers: bool = False

    @property
    def omega_unit(self) -> Literal["rad/s", "Hz"]:
        """Unit of frequency axes."""
        return "Hz" if self.hertz else "rad/s"

    @property
    def picture(self) -> str | None:
        """The picture asked for instead of the default one.

        Raises
        ------
        ModelError
            If several are.
        """
        asked = {
            "waveform": self.waveform is not None,
            "loop": self.loop is not None,
            "events": self.events is not None,
            "multipliers": self.multipliers,
        }
        names = [name for name, is_asked in asked.items() if is_asked]
        if len(names) > 1:
            raise ModelError(f"--{names[0]} and --{names[1]} exclude each other; give one")
        return names[0] if names else None


def picture_of(
    results: Sequence[Result], names: Sequence[str], wanted: Wanted
) -> tuple[str, list[Panel]]:
    """Return the name of a picture and its panels, from top to bottom.

    Parameters
    ----------
    results : sequence of Result
        What to draw.
    names : sequence of str
        What the results are called.
    wanted : Wanted
        What of them.

    Returns
    -------
    name : str
        For the name of the file.
    panels : list of Panel
        What to draw.

    Raises
    ------
    ModelError
        If the results have no such picture, or are of kinds that do not go together.
    """
    picture = wanted.picture
    if picture is None:
        return _default(results, wanted)
    panels = []
    for result, name in zip(results, names, strict=True):
        if not isinstance(result, ForcedResponse):
            raise ModelError(
                f"--{picture}: {name} holds a {result.kind.replace('_', ' ')}, which has no such "
                "picture; leave the option out"
            )
        single = list(_single(result, picture, wanted))
        panels += [titled(panel, name) for panel in single] if len(results) > 1 else single
    return picture, panels


def _default(results: Sequence[Result], wanted: Wanted) -> tuple[str, list[Panel]]:
    from stickslip import plot
    from stickslip.study import notable_dofs
    from stickslip.study.tables import OutputTable

    view = view_of(results)
    dofs = wanted.dofs or notable_dofs(results[0].model, results[0].dofs)
    curves = [result for result in results if isinstance(result, ForcedResponse)]
    if not curves:
        output = OutputTable(omega_unit=wanted.omega_unit)
        return results[0].kind.replace("_", "-"), view.panels(results, dofs, output)
    return "curve", [
        partial(
            plot.curves,
            curves,
            dof,
            omega_unit=wanted.omega_unit,
            log=wanted.log,
            normalise="force" if wanted.per_force else None,
        )
        for dof in dofs
    ]


def _single(result: ForcedResponse, picture: str, wanted: Wanted) -> Iterator[Panel]:
    """Give the panels of one curve for a picture other than the default one."""
    from stickslip import plot
    from stickslip.study import notable_dofs

    if wanted.waveform is not None:
        index = _index(result, wanted.waveform, "--waveform")
        for dof in wanted.dofs or notable_dofs(result.model, result.dofs):
            yield partial(plot.waveform, result, dof, index)
    elif wanted.loop is not None:
        counted = re.fullmatch("[0-9]{1,9}", wanted.contact)
        place = int(wanted.contact) if counted else wanted.contact
        yield partial(plot.hysteresis, result, place, _index(result, wanted.loop, "--loop"))
    elif not isinstance(result, ExactResponse):
        raise ModelError(
            f'--{picture}: needs exact orbits; run the study with kind = "exact", or leave it out'
        )
    elif wanted.events is not None:
        yield partial(plot.events, result, _index(result, wanted.events, "--events"))
    else:
        yield partial(plot.multipliers, result, omega_unit=wanted.omega_unit)


def _index(result: ForcedResponse, text: str, option: str) -> int:
    """Return the computed point nearest to a frequency, which must lie among them."""
    from stickslip.units import quantity

    bare = re.fullmatch("[-+.0-9eE]+", text)
    omega = quantity(f"{text} rad/s" if bare else text, "rad/s", option)
    low, high = float(result.omega.min()), float(result.omega.max())
    if not low * (1 - 1e-6) <= omega <= high * (1 + 1e-6):
        raise ModelError(
            f"{option} = {text!r} is {omega:.6g} rad/s, outside the computed {low:.6g} to "
            f"{high:.6g} rad/s; choose a frequency in between"
        )
    return result.index(omega)
