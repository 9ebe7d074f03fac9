"""What every result has: its model, its degrees of freedom, and what was assumed."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from functools import partial
from os import PathLike
from types import MappingProxyType
from typing import TYPE_CHECKING, ClassVar, Self, TypeVar

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import text, unknown
from stickslip.errors import ModelError
from stickslip.model import Model, PointRef
from stickslip.results.diagnostic import Diagnostic

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["Result"]

Kind = TypeVar("Kind", bound=np.generic)


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Result(ABC):
    """A computed motion: immutable, with what it belongs to and what it took for granted.

    A further kind of result is a subclass with `kind`, `to_dataset` and `from_dataset`, and a line
    in `stickslip.results.store.KINDS`; `save` and `load` then work.

    Attributes
    ----------
    model : Model
        What was computed.
    dofs : tuple of str
        The observed degrees of freedom.
    interrupted : bool
        Whether the run was stopped before its end.
    timings : mapping of float
        Seconds by stage.
    counters : mapping of int
        Evaluations by kind.
    diagnostics : tuple of Diagnostic
        What was taken for granted, what puts the numbers in doubt, and what is missing.
    """

    kind: ClassVar[str]
    """Name of this kind of result in files."""

    model: Model
    dofs: tuple[str, ...]
    interrupted: bool
    timings: Mapping[str, float]
    counters: Mapping[str, int]
    diagnostics: tuple[Diagnostic, ...]

    def __post_init__(self) -> None:
        for name in ("timings", "counters"):
            object.__setattr__(self, name, MappingProxyType(dict(getattr(self, name))))

    @property
    def assumptions(self) -> tuple[str, ...]:
        """The texts of the diagnostics."""
        return tuple(one.text for one in self.diagnostics)

    def __reduce__(self) -> tuple[Callable[[], Self], tuple[()]]:
        # What is only kept to save time stays behind, and a mapping proxy cannot be pickled.
        values = {entry.name: getattr(self, entry.name) for entry in fields(self) if entry.init}
        values |= {"timings": dict(self.timings), "counters": dict(self.counters)}
        return partial(type(self), **values), ()

    @abstractmethod
    def to_dataset(self, *, derived: bool = True) -> xr.Dataset:
        """Return everything as an xarray dataset with units on every variable.

        Parameters
        ----------
        derived : bool, optional
            Whether to add what follows from the other variables.

        Returns
        -------
        xarray.Dataset
            Numbers as variables, everything else as attributes; all numbers are copies.
        """

    @classmethod
    @abstractmethod
    def from_dataset(cls, dataset: xr.Dataset, model: Model) -> Self:
        """Return the result that a dataset holds.

        Parameters
        ----------
        dataset : xarray.Dataset
            As `to_dataset` makes it; derived variables are not needed.
        model : Model
            What was computed.

        Returns
        -------
        Result
            Equal to the one that made the dataset, bit by bit.

        Raises
        ------
        KeyError, ValueError
            If the dataset is incomplete, or belongs to another model.
        """

    def save(self, path: str | PathLike[str]) -> None:
        """Write the result with its model to a NetCDF file, whole or not at all.

        Parameters
        ----------
        path : path-like
            The file; an existing one is replaced. Read it with `stickslip.load`.

        Raises
        ------
        ModelError
            If the file cannot be written.
        """
        from stickslip.results.store import save

        save(self, path)

    def locate(self, contact: PointRef) -> tuple[int, int | None]:
        """Return the position of a contact, and of its point if one is meant.

        Parameters
        ----------
        contact : int, str or (int or str, int)
            The contact, or one of its points.

        Returns
        -------
        contact : int
            Position of the contact.
        point : int or None
            Position of the point in it; None for the whole contact.

        Raises
        ------
        ModelError
            If there is no such contact or point.
        """
        if isinstance(contact, tuple | list):
            number, point = self.model.point(contact)
            if point >= self.model.contacts[number].points:
                raise ModelError(
                    f"contact {contact[0]!r}: its {point + 1} elements share one displacement and "
                    "have no results of their own; name it without a point"
                )
            return number, point
        return self.model.contact_index(contact), None

    def _column(self, dof: str) -> int:
        if text(dof, "dof") in self.dofs:
            return self.dofs.index(dof)
        if dof in self.model.structure.dofs:
            raise ModelError(f"dof {dof!r}: it was not observed; add it to observe and run again")
        raise ModelError(unknown("dof", dof, self.dofs))

    def _columns(self, contact: int, point: int | None) -> slice:
        start = sum(one.points for one in self.model.contacts[:contact])
        if point is None:
            return slice(start, start + self.model.contacts[contact].points)
        return slice(start + point, start + point + 1)

    def _select(self, values: NDArray[Kind], contact: PointRef) -> NDArray[Kind]:
        number, point = self.locate(contact)
        columns = values[..., self._columns(number, point)]
        return columns if point is None else columns[..., 0]
