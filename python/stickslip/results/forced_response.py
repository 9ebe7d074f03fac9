"""What `stickslip.forced_response` returns: a curve, with status and error beside the numbers."""

from __future__ import annotations

from collections.abc import Hashable
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import constant
from stickslip.drawn import Drawn
from stickslip.results.arrays import STABILITY
from stickslip.results.blades import BladeMotion
from stickslip.results.bounded import Bounded
from stickslip.results.certificate import Certificate
from stickslip.results.dataset import Stored
from stickslip.results.energy import Energy, energy_of
from stickslip.results.fields import Int
from stickslip.results.sensitivities import Sensitivities
from stickslip.results.stability import States, truths


class ForcedResponse(BladeMotion, Sensitivities, Bounded):
    """Steady response to periodic forces over the excitation frequency.

    Amplitudes and all that derives from them are not-a-number at points that were not solved;
    `status` says why. Degrees of freedom are addressed by name, contacts by position or name, and
    one contact point as (contact, point). Angular frequencies are in rad/s, displacements in m,
    forces in N. Arrays are read-only.

    Attributes
    ----------
    certificate : Certificate or None
        The comparison with exact orbits that `stickslip.certify` made.
    """

    kind: ClassVar[str] = "forced_response"
    title = "Forced response of a structure with dry friction, by harmonic balance"

    certificate: Certificate | None = None

    @cached_property
    def folds(self) -> Int:
        """Positions of the points at which the curve turns back in frequency, in its order.

        Located to about 1e-7 along the curve, and the frequency to the square of it. Empty of
        curves over given frequencies.
        """
        return constant(np.flatnonzero(self.arrays.fold))

    @cached_property
    def jumps(self) -> Int:
        """Positions of the points to which the sweep has jumped from another branch.

        The branch of the point before turns back between the two frequencies. Empty of curves over
        a range, which are followed around their folds.
        """
        return constant(np.flatnonzero(self.arrays.jump))

    @cached_property
    def branch(self) -> Int:
        """Number of the branch that each point lies on, (n,).

        0 is the branch that begins at the end of the range; those with higher numbers were found
        beside it: the curve does not come by their motions inside the range. There may be more.
        """
        return constant(np.cumsum(self.arrays.further))

    @cached_property
    def stability(self) -> States:
        """State of each motion, "stable", "unstable" or "not decided".

        Where laws and damping leave one motion alone it is stable. Else Floquet multipliers of the
        linearised equations decide, unless the largest is nearer to 1 than its error, the motion is
        a travelling wave, or ``stability=False``.
        """
        return constant(np.array(STABILITY)[self.arrays.stability])

    @cached_property
    def stable(self) -> NDArray[np.object_]:
        """`stability` as True, False or None (not decided) per point.

        Of Python's objects: write ``result.stable == True`` or ``result.stability == "stable"`` to
        choose points.
        """
        return truths(self.stability)

    plot = Drawn("curves")
    plot_waveform = Drawn("waveform")
    plot_hysteresis = Drawn("hysteresis")
    plot_slip = Drawn("slip")

    def __repr__(self) -> str:
        omega = self.omega
        solved = "all solved" if self.arrays.solved.all() else f"{self.arrays.solved.sum()} solved"
        return (
            f"{type(self).__name__}({omega.size} points from {omega.min():g} to {omega.max():g} "
            f"rad/s ({solved}), {len(self.dofs)} dofs, harmonics={self.settings.harmonics!r})"
        )

    @cached_property
    def energy(self) -> Energy:
        """Work of the forces and energy lost, per period.

        Raises ModelError if a degree of freedom was not observed: all of them take part.
        """
        return energy_of(self)

    def _further_variables(self, *, derived: bool) -> dict[Hashable, Any]:
        certified = {} if self.certificate is None else self.certificate.variables()
        return certified | super()._further_variables(derived=derived)

    @classmethod
    def _further_arguments(cls, dataset: Stored) -> dict[str, Any]:
        return {"certificate": Certificate.of_dataset(dataset)}
