"""What ``stickslip plot`` draws: the picture that its options ask for."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

from stickslip.errors import ModelError
from stickslip.model.notable import notable_dofs
from stickslip.plot.style import OmegaUnit
from stickslip.results import ForcedResponse
from stickslip.results.exact_response import ExactResponse
from stickslip.results.result import Result
from stickslip.study.tables import OutputTable
from stickslip.views.kinds import view_of
from stickslip.views.picture import Panel, titled


@dataclass(frozen=True)
class Wanted:
    """What of results is to be drawn, as the options of the command say."""

    dofs: Sequence[str] | None
    omega_unit: OmegaUnit
    log: bool
    per_force: bool
    contact: str

    def picture(
        self, asked: Mapping[str, str], results: Sequence[tuple[str, Result]]
    ) -> tuple[str, list[Panel]]:
        """Return the name of a picture of named results and its panels, from top to bottom.

        `asked` are the pictures asked for instead of the default one, each with its frequency.
        """
        if len(asked) > 1:
            first, second, *_ = asked
            raise ModelError(f"--{first} and --{second} exclude each other; give one")
        if not asked:
            return self._default(results)
        ((picture, omega),) = asked.items()
        panels: list[Panel] = []
        for name, result in results:
            if not isinstance(result, ForcedResponse):
                raise ModelError(
                    f"--{picture}: {name} holds a {result.kind.replace('_', ' ')}, which has no "
                    "such picture; leave the option out"
                )
            single = self._single(result, picture, omega)
            panels += (titled(panel, name) for panel in single) if len(results) > 1 else single
        return picture, panels

    def _default(self, named: Sequence[tuple[str, Result]]) -> tuple[str, list[Panel]]:
        from stickslip import plot

        results = [result for _, result in named]
        view, dofs = view_of(results), self._dofs(results[0])
        curves = [result for result in results if isinstance(result, ForcedResponse)]
        if not curves:
            output = OutputTable(omega_unit=self.omega_unit)
            return results[0].kind.replace("_", "-"), view.named_panels(named, dofs, output)
        drawn = partial(
            plot.curves,
            curves,
            omega_unit=self.omega_unit,
            log=self.log,
            normalise="force" if self.per_force else None,
        )
        return "curve", [partial(drawn, dof=dof) for dof in dofs]

    def _dofs(self, result: Result) -> Sequence[str]:
        return self.dofs or notable_dofs(result.model, result.dofs)

    def _single(self, result: ForcedResponse, picture: str, omega: str) -> Iterator[Panel]:
        """Give the panels of one curve for a picture other than the default one."""
        from stickslip import plot

        unit = self.omega_unit
        if picture == "waveform":
            index = _index(result, omega, "--waveform")
            for dof in self._dofs(result):
                yield partial(plot.waveform, result, dof, index, omega_unit=unit)
        elif picture == "loop":
            counted = re.fullmatch("[0-9]{1,9}", self.contact)
            place = int(self.contact) if counted else self.contact
            index = _index(result, omega, "--loop")
            yield partial(plot.hysteresis, result, place, index, omega_unit=unit)
        elif not isinstance(result, ExactResponse):
            raise ModelError(
                f'--{picture}: needs exact orbits; run the study with kind = "exact", or leave it '
                "out"
            )
        elif picture == "events":
            index = _index(result, omega, "--events")
            yield partial(plot.events, result, index, omega_unit=unit)
        else:
            yield partial(plot.multipliers, result, omega_unit=unit)


def _index(result: ForcedResponse, text: str, option: str) -> int:
    """Return the computed point nearest to a frequency, which must lie among them."""
    from stickslip.units import quantity

    bare = re.fullmatch("[-+.0-9eE]+", text)
    omega = quantity(f"{text} rad/s" if bare else text, "rad/s", option)
    return result.nearest(omega, f"{option} = {text!r}:")
