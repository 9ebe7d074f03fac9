"""What is said and drawn of sweeps: what is of their results, together."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import partial
from typing import Any

from stickslip.drawn import plots
from stickslip.results.forced_response import ForcedResponse
from stickslip.results.sweep import Sweep
from stickslip.views.kinds import Dofs, Output, Rows, View, view_of
from stickslip.views.picture import Panels, titled
from stickslip.views.tables import Row, Table


class SweepView(View[Sweep]):
    """The tables and pictures of the results, with the values of the parameter."""

    def rows(self, result: Sweep, dofs: Dofs, length: float) -> Rows:
        """Return the rows of all results."""
        view = self._of(result)
        return [row for one in result.results for row in view.rows(one, dofs, length)]

    def tables(
        self,
        results: Sequence[tuple[str, Sweep]],
        label: str,
        dofs: Iterable[str],
        length_unit: str,
    ) -> list[Table]:
        """Tabulate the results, each with its value of the parameter."""
        view, first = self._of(results[0][1]), results[0][1]
        named = [
            (f"{name} {text}".strip() if label else text, member)
            for name, result in results
            for text, member in zip(result.written, result.results, strict=True)
        ]
        heading = first.parameter.replace("_", " ")
        return view.tables(named, heading, dofs, length_unit)

    def _of(self, result: Sweep) -> View[Any]:
        """Return the view of the results, whose tables have the columns of this one."""
        view = _view(result)
        view.rpm = view.rpm or self.rpm
        return view

    def about(self, result: Sweep) -> list[Row]:
        """Say what was varied."""
        variation = result.settings.variation
        of = "" if variation is None else f" of {', '.join(variation.names) or 'the forces'}"
        varied = result.parameter.replace("_", " ")
        rows = [("varied", f"{varied}{of}"), ("values", ", ".join(result.written))]
        members = [_view(result).about(one) for one in result.results]
        named = list(zip(result.written, members, strict=True))
        alike = [row for row in members[0] if all(row in own for own in members)]
        apart = [
            (what, f"{name}: {said}")
            for subject in dict.fromkeys(what for own in members for what, _ in own)
            for name, own in named
            for what, said in own
            if what == subject and (what, said) not in alike
        ]
        return [*rows, *alike, *apart]

    def failures(self, result: Sweep) -> list[str]:
        """Word what was not solved, value by value."""
        view = _view(result)
        return [
            f"{name}: {text}"
            for name, one in zip(result.labels, result.results, strict=True)
            for text in view.failures(one)
        ]

    def panels(self, results: Sequence[Sweep], dofs: Dofs, output: Output) -> Panels:
        """Return the family of curves, of each sweep by itself."""
        drawn: Panels = []
        for result in results:
            if isinstance(result.results[0], ForcedResponse):
                units: dict[str, Any] = {
                    "length_unit": output.length_unit,
                    "omega_unit": output.frequency_unit,
                }
                curves = partial(plots.curves, list(result.results), labels=result.labels, **units)
                drawn += [partial(curves, dof=dof) for dof in dofs]
            elif result.drawn_together:
                drawn += _view(result).panels(result.results, dofs, output)
            else:
                for name, one in zip(result.labels, result.results, strict=True):
                    own = _view(result).panels([one], dofs, output)
                    drawn += [titled(panel, name) for panel in own]
        return drawn


def _view(result: Sweep) -> View[Any]:
    return view_of(result.results)
