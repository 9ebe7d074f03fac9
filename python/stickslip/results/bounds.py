"""What the numbers of a result file can be, whatever was done to the file."""

from __future__ import annotations

from collections.abc import Mapping
from math import inf
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["require_bounds"]


class Bound(NamedTuple):
    """What the entries of a variable can be; not-a-number is allowed where there are fractions."""

    kind: str
    """Kind of number as NumPy writes it: f, i, u or b."""
    least: float = -inf
    """Least value."""
    most: float | str = inf
    """Largest value, or the dimension in which the entries are positions."""


_TYPES = {kind: np.dtype(name) for kind, name in zip("fiub", ("f8", "i8", "u1", "?"), strict=True)}
_COUNT = Bound("i", 0)
_SIZE = Bound("f", 0.0)
_SHARE = Bound("f", 0.0, 1.0 + 1e-6)  # sums of times are rounded
_CODE = Bound("u")
_FLAG = Bound("b")
_REAL = Bound("f")
_BOUNDS: Mapping[str, Bound] = {
    "amplitude": _SIZE,
    "at_edge": _FLAG,
    "blade": Bound("i", -1, "sector"),
    "certified_amplitude": _SIZE,
    "certified_code": _CODE,
    "certified_error": _REAL,
    "certified_estimate": _SIZE,
    "certified_indices": Bound("i", 0, "omega"),
    "certified_omega": _SIZE,
    "certified_waveform_error": _SIZE,
    "change_after": Bound("i", 0, "cycle"),
    "change_kind": Bound("i", 0, 3),
    "change_unstable": _COUNT,
    "closed": _FLAG,
    "contact_displacement_imag": _REAL,
    "contact_displacement_real": _REAL,
    "contact_force_imag": _REAL,
    "contact_force_real": _REAL,
    "coupling_stiffness": _SIZE,
    "damping": _REAL,
    "decided": _SIZE,
    "deviation": _REAL,
    "displacement_imag": _REAL,
    "displacement_real": _REAL,
    "error_estimate": _SIZE,
    "event_kind": Bound("u", 0, 2),
    "event_offset": _COUNT,
    "event_point": Bound("i", 0, "point"),
    "event_time": _SIZE,
    "events": _COUNT,
    "final": _REAL,
    "harmonics_kept": _COUNT,
    "iterations": _COUNT,
    "mass": _REAL,
    "mode": Bound("i", -1, "row"),
    "neutral": _COUNT,
    "omega": _SIZE,
    "patterns": _REAL,
    "poincare": _REAL,
    "range": _REAL,
    "reason": _CODE,
    "residual": _SIZE,
    "samples": _COUNT,
    "share": _SHARE,
    "slip_fraction": _SHARE,
    "slipping": _FLAG,
    "start": _REAL,
    "state": _REAL,
    "status": _CODE,
    "stiffness": _REAL,
    "tail": _REAL,
    "time": _SIZE,
    "tuned_amplitude": _SIZE,
    "tuned_at_edge": _FLAG,
    "tuned_error_estimate": _SIZE,
    "tuned_harmonics_kept": _COUNT,
    "tuned_omega": _SIZE,
    "value": _REAL,
    "velocity": _REAL,
}
"""By the names in files, of every kind of result."""


def require_bounds(dataset: xr.Dataset) -> None:
    """Refuse numbers that no result has: a negative frequency, the blade 99999, text for a number.

    Parameters
    ----------
    dataset : xarray.Dataset
        As it is read from a file.

    Raises
    ------
    ValueError
        Naming the variable, and the value.
    """
    for name, variable in dataset.variables.items():
        bound = _BOUNDS.get(str(name))
        if bound is not None:
            _require(str(name), variable.values, bound, dataset.sizes)
    if "event_offset" in dataset:
        ends, events = dataset["event_offset"].values, dataset.sizes.get("event", 0)
        if ends.ndim != 1 or ends[0] != 0 or ends[-1] != events or (np.diff(ends) < 0).any():
            raise ValueError(f"event_offset does not divide the {events} events")


def _require(name: str, values: NDArray[Any], bound: Bound, sizes: Mapping[Any, int]) -> None:
    if values.dtype != _TYPES[bound.kind]:
        raise ValueError(f"{name} holds {values.dtype.name} instead of {_TYPES[bound.kind].name}")
    most = sizes.get(bound.most, 0) - 1 if isinstance(bound.most, str) else bound.most
    outside = (values < bound.least) | (values > most)
    if outside.any():
        raise ValueError(
            f"{name} = {values[outside].flat[0]:.6g}, outside {bound.least:g} to {most:g}"
        )
