"""What ``stickslip plot`` draws: the picture that its options ask for."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

from stickslip.checks import unknown
from stickslip.disk.bladed_disk import rotor_order
from stickslip.errors import ModelError
from stickslip.model.notable import notable_dofs
from stickslip.plot.style import OmegaUnit
from stickslip.results import ForcedResponse
from stickslip.results.exact_response import ExactResponse
from stickslip.results.result import Result
from stickslip.study.tables import OutputTable
from stickslip.views.kinds import view_of
from stickslip.views.picture import Panel, titled

_OPTIONS = {
    "curve": ("--dof", "--linear", "--per-force"),
    "": ("--dof",),
    "waveform": ("--dof",),
    "loop": ("--contact",),
}
"""What may be chosen of a picture; "" is that of a result that is no response curve."""


@dataclass(frozen=True)
class Wanted:
    """What of results is to be drawn, as the options of the command say."""

    dofs: Sequence[str] | None
    omega_unit: OmegaUnit | None
    log: bool
    per_force: bool
    contact: str | None

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
        self._check_options(picture, f"--{picture}")
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
        kind = results[0].kind.replace("_", " ")
        self._check_options("curve" if curves else "", f"a {kind}")
        if not curves:
            if self.omega_unit is not None and not view.frequencies:
                option = {"Hz": "--hertz", "rpm": "--rpm"}.get(self.omega_unit)
                raise ModelError(f"{option}: changes nothing of a {kind}; leave it out")
            known = dict.fromkeys(dof for result in results for dof in result.dofs)
            for dof in self.dofs or ():
                if dof not in known:
                    raise ModelError(f"--dof: {unknown('dof', dof, known)}")
            output = OutputTable(omega_unit=self.omega_unit)
            return kind.replace(" ", "-"), view.named_panels(named, dofs, output)
        drawn = partial(
            plot.curves,
            curves,
            omega_unit=self.omega_unit or "rad/s",
            log=self.log,
            normalise="force" if self.per_force else None,
        )
        return "curve", [partial(drawn, dof=dof) for dof in dofs]

    def _check_options(self, picture: str, name: str) -> None:
        """Refuse options that change nothing of a picture."""
        given = {
            "--dof": bool(self.dofs),
            "--linear": not self.log,
            "--per-force": self.per_force,
            "--contact": self.contact is not None,
        }
        for option in given:
            if given[option] and option not in _OPTIONS.get(picture, ()):
                raise ModelError(f"{option}: changes nothing of {name}; leave it out")

    def _dofs(self, result: Result) -> Sequence[str]:
        return self.dofs or notable_dofs(result.model, result.dofs)

    def _single(self, result: ForcedResponse, picture: str, omega: str) -> Iterator[Panel]:
        """Give the panels of one curve for a picture other than the default one."""
        from stickslip import plot

        unit = self.omega_unit or "rad/s"
        if picture == "waveform":
            index = _index(result, omega, "--waveform", unit)
            for dof in self._dofs(result):
                yield partial(plot.waveform, result, dof, index, omega_unit=unit)
        elif picture == "loop":
            contact = self.contact or "0"
            place = int(contact) if re.fullmatch("[0-9]{1,9}", contact) else contact
            index = _index(result, omega, "--loop", unit)
            yield partial(plot.hysteresis, result, place, index, omega_unit=unit)
        elif not isinstance(result, ExactResponse):
            raise ModelError(
                f'--{picture}: needs exact orbits; run the study with kind = "exact", or leave it '
                "out"
            )
        elif picture == "events":
            index = _index(result, omega, "--events", unit)
            yield partial(plot.events, result, index, omega_unit=unit)
        else:
            yield partial(plot.multipliers, result, omega_unit=unit)


def _index(result: ForcedResponse, text: str, option: str, unit: OmegaUnit) -> int:
    """Return the computed point nearest to a frequency, which must lie among them.

    In a picture over rpm, which of a disk are those of the rotor, so is a frequency in rpm.
    """
    from stickslip.units import parted, quantity

    bare = re.fullmatch("[-+.0-9eE]+", text)
    omega = quantity(f"{text} rad/s" if bare else text, "rad/s", option)
    if unit == "rpm" and not bare and parted(text)[1] == unit:
        omega *= rotor_order(result.model) or 1.0
    return result.nearest(omega, f"{option} = {text!r}:")
