"""The energy balance of a steady motion: what the forces do, and where it goes."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stickslip.checks import constant
from stickslip.errors import ModelError
from stickslip.results.fields import Float
from stickslip.results.periodic import Sweep


class Energy(NamedTuple):
    """Energy per period, one entry per point of the curve; not-a-number where it is not solved."""

    work: Float
    """(n,) Work of the external forces [J]."""
    viscous: Float
    """(n,) Energy lost to the damping matrix [J]."""
    friction: Float
    """(n,) Energy lost at all contacts together [J]."""
    apparent: Float
    """(n,) Work that the forces would do in phase with the velocity, pi k |P_k| |X_k| [J]."""

    @property
    def imbalance(self) -> Float:
        """What is missing in work = viscous + friction, relative to the largest, shape (n,).

        The apparent work counts among them: without damping and slip the others are rounding.
        """
        terms = np.abs(np.stack(self))
        scale = np.maximum(terms.max(axis=0), np.finfo(np.float64).tiny)
        return constant((self.work - self.viscous - self.friction) / scale)


def energy_of(result: Sweep) -> Energy:
    """Return the energy balance of a harmonic series, for which all dofs must be observed.

    Over one period the force P_k does the work pi k Im(P_k^T conj(X_k)), and the damping matrix
    takes pi omega k^2 X_k^H C X_k.
    """
    structure, arrays = result.model.structure, result.arrays
    missing = [dof for dof in structure.dofs if dof not in result.dofs]
    if missing:
        raise ModelError(
            f"energy: dof {missing[0]!r} was not observed, and all dofs take part; run again with "
            "observe=model.structure.dofs"
        )
    series = arrays.displacement[:, :, [result.dofs.index(dof) for dof in structure.dofs]]
    order = np.arange(series.shape[1])
    work = np.zeros(arrays.omega.size)
    for force in result.model.forces:
        if force.harmonic < order.size:
            motion = series[:, force.harmonic, structure.index(force.dof)]
            work += np.pi * force.harmonic * (force.coefficient * motion.conj()).imag
    viscous = np.zeros(arrays.omega.size)
    for harmonic in order[series.any(axis=(0, 2))]:
        motion = series[:, harmonic]
        _, damping, _ = result.model.matrices_at(int(harmonic))
        # Skew terms do no work.
        taken = np.einsum("ni,ij,nj->n", motion.conj(), damping, motion).real
        viscous += np.pi * arrays.omega * harmonic**2 * taken
    # A model without contacts has no columns to sum, but unsolved points all the same.
    friction = arrays.dissipation.sum(axis=1)
    work, viscous, friction = (
        constant(np.where(arrays.solved, part, np.nan)) for part in (work, viscous, friction)
    )
    return Energy(work, viscous, friction, apparent_work(result))


def apparent_work(result: Sweep) -> Float:
    """Return the work that the forces at observed dofs would do in phase with the velocity.

    A static load does none, but it is a scale of rounding, and is counted as if of harmonic 1.
    """
    series = result.arrays.displacement
    apparent = np.zeros(result.arrays.omega.size)
    for force in result.model.forces:
        if force.harmonic < series.shape[1] and force.dof in result.dofs:
            motion = series[:, force.harmonic, result.dofs.index(force.dof)]
            apparent += np.pi * max(force.harmonic, 1) * np.abs(force.coefficient * motion)
    return constant(np.where(result.arrays.solved, apparent, np.nan))
