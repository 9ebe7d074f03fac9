"""A user's own contact law, written in Python: a return map with its tangent, for many nodes."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from copy import copy
from typing import Any, ClassVar, NamedTuple, NoReturn, Self

import numpy as np
from numpy.typing import ArrayLike

from stickslip.checks import Matrix, brief, set_fields
from stickslip.errors import ModelError
from stickslip.model.contact import Bonded, Contact
from stickslip.model.contact_answer import Answers, array_of, arrays_of, compare
from stickslip.model.dofs import Dofs
from stickslip.model.nodes import Displacement, Nodes

_LAST = 1 << 12
"""Calls up to which tangents are compared, at every power of two."""


class Tangents(NamedTuple):
    """Derivative of one step of a return map.

    Of n nodes with d displacements and m numbers of state each. What is equal for all nodes may be
    given without the first dimension.
    """

    state_by_state: ArrayLike
    """New state by the old one, (n, m, m)."""
    state_by_before: ArrayLike
    """New state by the displacements before the step, (n, m, d)."""
    state_by_after: ArrayLike
    """New state by the displacements after the step, (n, m, d)."""
    force_by_state: ArrayLike
    """Force by the new state, (n, d, m)."""
    force_by_after: ArrayLike
    """Force by the displacements after the step at a fixed new state, (n, d, d)."""


class ContactLaw(Contact):
    """Base class of a user's own law, between d relative displacements and d forces of a node.

    A subclass says how many displacements and how many numbers of state a node has, its stiffness
    while it sticks, and what one step does: `directions`, `state_size`, `stiffness`, `step`. That
    is enough for harmonic balance; analyses that need more refuse the law by its name.

    Parameters
    ----------
    dofs : sequence of str, or of sequences of str
        The d degrees of freedom of a node, or sums of them as of `Coulomb`; of many nodes one such
        list each.
    other : sequence of str, or of sequences of str, optional
        As many at its other end: the displacements are x_dofs - x_other. Default: the ground.
    name : str, optional
        By which results and settings refer to it. Default: `law`.

    Notes
    -----
    The law starts from the state zero at displacement zero, where nothing has slipped. With `odd`
    it promises that the opposite motion gives the opposite force and state; with `monotone` that
    the force is a monotone operator of the motion, so that a passive structure has one steady
    motion. Every node is computed at once; the core calls `step` once per sample of a period, and
    not again for what has been answered in an analysis: it may depend on nothing but its arguments
    and on numbers that stay as they are.

    The tangents are compared with differences when an analysis first calls the law, and then ever
    more rarely. A law that has another derivative at a corner may return either.

    Raises
    ------
    ModelError
        If degrees of freedom do not fit `directions`; in an analysis also if `stiffness` or `step`
        return other shapes or numbers that are not finite, if a tangent differs from differences,
        or with the error that `step` raised as its cause.
    """

    law: ClassVar[str]
    """Name in messages and results. Default: that of the class in small letters."""
    directions: ClassVar[int] = 1
    """Number d of displacements of a node."""
    state_size: ClassVar[int] = 1
    """Number m of numbers that a node remembers."""
    odd: ClassVar[bool] = False
    """Whether the opposite motion gives the opposite force."""
    monotone: ClassVar[bool] = False
    """Whether the force is a monotone operator of the motion."""
    core_phases: ClassVar[bool] = False

    nodes: Nodes
    """Where it acts."""
    _raised: Exception | None = None
    _calls: int = 0
    _answers: Answers | None = None

    def __init__(
        self,
        dofs: Sequence[Displacement] | Sequence[Sequence[Displacement]],
        other: Sequence[Displacement] | Sequence[Sequence[Displacement]] | None = None,
        *,
        name: str | None = None,
    ) -> None:
        nodes = Nodes.of(dofs, other, f"{self.law} contact")
        if nodes.size != self.directions:
            raise ModelError(
                f"{self.law} contact: dofs: {nodes.size} names per node for {self.directions} "
                f"displacements of the law; give {self.directions}"
            )
        set_fields(self, name=name, nodes=nodes, _raised=None, _calls=0, _answers=None)
        Contact.__post_init__(self)

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        if "law" not in vars(cls):
            cls.law = cls.__name__.lower()

    __eq__ = object.__eq__
    __hash__ = object.__hash__

    @abstractmethod
    def stiffness(self) -> ArrayLike:
        """Return the stiffness of the stuck contact [N/m], shape (d, d), or (n, d, d)."""

    def state_stiffness(self) -> ArrayLike:
        """Return the derivative of the state by u while it sticks, shape (m, d), or (n, m, d).

        Default: the stiffness, for a state that is the force.
        """
        if self.state_size != self.directions:
            raise ModelError(
                f"{self.law} contact: a state of {self.state_size} for {self.directions} "
                "displacements is no force; define state_stiffness"
            )
        return self.stiffness()

    @abstractmethod
    def step(
        self, before: Matrix, after: Matrix, state: Matrix
    ) -> tuple[ArrayLike, ArrayLike, Tangents]:
        """Take the state of all nodes through a change of their displacements.

        Parameters
        ----------
        before, after : ndarray of float64, shape (n, d)
            Displacements [m].
        state : ndarray of float64, shape (n, m)
            State before the step.

        Returns
        -------
        force : array_like, shape (n, d)
            After the step [N], positive against the displacement: a function of the new state and
            of `after`.
        state : array_like, shape (n, m)
            After the step.
        tangents : Tangents
            Derivatives of both.
        """

    @property
    def dofs(self) -> tuple[str, ...]:
        """Names of the degrees of freedom, those of the first ends before those of the others."""
        return self.nodes.first + self.nodes.other

    @property
    def points(self) -> int:
        """Number n of nodes."""
        return self.nodes.count

    @property
    def components(self) -> tuple[str, ...]:
        """Names of the displacements of a node, "u1", "u2", ...; none where it has one."""
        return () if self.directions == 1 else tuple(f"u{i + 1}" for i in range(self.directions))

    @property
    def tangential(self) -> int:
        """Number of displacements along which a node slips: all."""
        return self.directions

    @property
    def single(self) -> bool:
        """Whether it was given as one node with several displacements."""
        return self.nodes.single and self.directions > 1

    def rows(self, dofs: Dofs) -> Matrix:
        """Return B of u = B x, shape (n * d, N)."""
        return self.nodes.rows(dofs).reshape(-1, len(dofs))

    @property
    def stuck_stiffness(self) -> Matrix:
        """Stiffness while every node sticks [N/m], shape (n_u, n_u)."""
        return self._stuck()[0]

    def linear_limit(self, *, stuck: bool) -> Bonded | None:
        """Return the stuck contact, or that nothing is left at large amplitude."""
        return Bonded(self, self.stuck_stiffness, name=self.name) if stuck else None

    def law_parameters(self) -> list[dict[str, Any]]:
        """Return that the law itself has its parameters."""
        return [{}]

    def core_laws(self, *rows: Matrix) -> list[tuple[Any, ...]]:
        """Return the law as the compiled core takes it: itself, rows of B, no parameters."""
        return [(self, *rows, {})]

    def adjustable(self) -> dict[str, tuple[float, ...]]:
        """Return that analyses vary nothing of a law that they do not know."""
        return {}

    def scaled(self, slip_force: float) -> Self:
        """Return the contact; there is no slip force that another level would multiply."""
        if slip_force != 1.0:
            raise ModelError(
                f"contact {self.name!r}: the law {self.law!r} has no slip force to multiply; build "
                "the model with another law instead"
            )
        return self

    def summary(self) -> str:
        """Return the numbers that were set on the law, in words."""
        values = {key: one for key, one in vars(self).items() if isinstance(one, float | int)}
        shown = (f"{key} {one:g}" for key, one in values.items() if not key.startswith("_"))
        return ", ".join(shown) or f"{self.points} nodes"

    def moved(self, dofs: Sequence[str | None], name: str | None) -> Self:
        """Return the contact at other degrees of freedom."""
        moved = copy(self)
        set_fields(moved, name=name, nodes=self.nodes.moved(dofs))
        set_fields(moved, _raised=None, _calls=0, _answers=None)
        return moved

    def to_spec(self) -> NoReturn:
        """Refuse to write a law that only its own module can read."""
        raise ModelError(
            f"contact {self.name!r}: the law {self.law!r} is written in Python, which no file "
            "holds; pickle the result, or keep its dataset: result.to_dataset().to_netcdf(...)"
        )

    # ------------------------------------------------------------------ what the core calls

    def _stuck(self) -> tuple[Matrix, Matrix]:
        """Return stiffness and state stiffness of all nodes, (n d, n d) and (n m, n d)."""
        n, d, m = self._sizes
        stiffness = array_of(self.stiffness(), (n, d, d), self._entry, "stiffness")
        of_state = array_of(self.state_stiffness(), (n, m, d), self._entry, "state_stiffness")
        largest = np.abs(stiffness).max(initial=0.0)
        skew = np.abs(stiffness - stiffness.transpose(0, 2, 1)).max(initial=0.0)
        if skew > 1e-9 * largest or np.linalg.eigvalsh(stiffness).min() < -1e-9 * largest:
            raise ModelError(
                f"{self._entry}: stiffness: {brief(stiffness.tolist())} is not symmetric and "
                "positive semidefinite; give that of the stuck contact"
            )
        return _diagonal(stiffness), _diagonal(of_state)

    def _step(
        self, before: Matrix, after: Matrix, state: Matrix, derive: bool
    ) -> tuple[Matrix, Matrix, list[Matrix] | None] | None:
        """Return force, state and tangents; None once an error was raised, which is kept."""
        if self._raised is not None:
            return None
        given = np.concatenate((before.ravel(), after.ravel(), state.ravel()))
        # Another thread, whose analysis ends, may forget them at any line.
        known = self._answers
        if known is None:
            known = self._answers = Answers(self._sizes)
        answer = known.find(key := given.tobytes())
        if answer is None:
            # Motions that are no numbers come of an error of another thread: the law is not to
            # blame.
            if not np.isfinite(given).all():
                return None
            answer = self._taken(before, after, state, derive)
            if answer is None:
                return None
            known.keep(key, answer)
        force, new, *tangents = answer
        return force, new, tangents if derive else None

    def _taken(
        self, before: Matrix, after: Matrix, state: Matrix, derive: bool
    ) -> list[Matrix] | None:
        """Take a step; None if it raises an error, which is kept."""
        try:
            for array in (before, after, state):
                array.flags.writeable = False
            answer = self._answer(before, after, state)
            if derive:
                self._calls += 1
                if self._calls & (self._calls - 1) == 0 and self._calls <= _LAST:
                    at = {"before": before, "after": after, "state": state}
                    compare(self._answer, at, answer, self._stuck()[1], self._entry)
        except Exception as error:  # Whatever the user's own code raises.
            self._raised = error
            return None
        return answer

    def raise_own(self) -> None:
        """Raise, once, what the law raised while the core called it."""
        error, self._raised = self._raised, None
        if isinstance(error, ModelError):
            raise error
        if error is not None:
            said = " ".join(str(error).split())
            raise ModelError(
                f"{self._entry}: step raised {type(error).__name__}: {said} (traceback above); "
                "correct it"
            ) from error

    def forget(self) -> None:
        """Forget what the law has answered: after an analysis its numbers may be set anew."""
        self._answers = None

    @property
    def _sizes(self) -> tuple[int, int, int]:
        """Numbers of nodes, of displacements and of numbers of state of each."""
        return self.points, self.directions, self.state_size

    @property
    def _entry(self) -> str:
        return f"contact {self.name!r}, law {self.law!r}"

    def _answer(self, before: Matrix, after: Matrix, state: Matrix) -> list[Matrix]:
        """Return force, state and tangents of a step."""
        answer: Any = self.step(before, after, state)
        full = isinstance(answer, tuple) and len(answer) == 3 and isinstance(answer[-1], tuple)
        if not (full and len(answer[-1]) == len(Tangents._fields)):
            raise ModelError(f"{self._entry}: step returns no (force, state, Tangents(...))")
        force, new, tangents = answer
        return arrays_of((force, new, *tangents), self._sizes, self._entry)


def _diagonal(blocks: Matrix) -> Matrix:
    """Return a matrix with blocks (n, rows, columns) along its diagonal."""
    n, rows, columns = blocks.shape
    whole = np.zeros((n, rows, n, columns))
    whole[np.arange(n), :, np.arange(n)] = blocks
    return whole.reshape(n * rows, n * columns)
