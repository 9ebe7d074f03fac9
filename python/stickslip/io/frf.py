"""Frequency response functions, measured and computed, in Universal File Format (dataset 58)."""

from __future__ import annotations

import io
import os
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Literal, Protocol, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.checks import (
    brief,
    choice,
    file_path,
    members,
    optional_package,
    real_array,
    set_fields,
    text,
)
from stickslip.disk import BladedDisk
from stickslip.errors import ModelError
from stickslip.files import write
from stickslip.interruption import Interruption
from stickslip.io.source import readable
from stickslip.model import Model

Quantity: TypeAlias = Literal["displacement", "velocity", "acceleration"]

_QUANTITIES = {8: "displacement", 11: "velocity", 12: "acceleration"}
_DERIVATIVES = {"displacement": 0, "velocity": 1, "acceleration": 2}
_FREQUENCY, _FORCE, _FRF, _UNITS = 18, 13, 4, 164
_OTHER_UNITS = {
    *("g", "gn", "mm", "cm", "um", "µm", "in", "inch", "ft", "mil", "mils", "ips", "db"),
    *("kn", "mn", "lbf", "lb", "kgf", "kp"),
}
"""Units of labels that are none of SI, in small letters."""
_GIVEN_IN = re.compile(r"\bin\b(?=[\s(\[]+[mn]\b)")
"""The word before a unit: accel in m/s^2."""
_END, _TEXT, _HEAD = b"    -1", b"    58", 13
"""What ends and begins a dataset, what text says of itself, and its lines before the numbers."""
_NUMBERS = re.compile(rb"[-+.0-9eEdD \t]*")
_NODE_DOF = re.compile(r"([1-9]\d{0,9})\.([1-6])(-?)")
_LONGEST, _LINE = 10, 80
"""Characters that the format leaves for the name of an entity, and for a line of the head."""
_NONE = "NONE"
"""What stands for no text."""


class Response(Protocol):
    """What a function is made of: a `ForcedResponse`."""

    @property
    def model(self) -> Model: ...  # noqa: D102
    @property
    def omega(self) -> NDArray[np.float64]: ...  # noqa: D102
    @property
    def converged(self) -> NDArray[np.bool_]: ...  # noqa: D102
    @property
    def folds(self) -> NDArray[np.int64]: ...  # noqa: D102
    @property
    def branch(self) -> NDArray[np.int64]: ...  # noqa: D102
    def coefficients(self, dof: str) -> NDArray[np.complex128]: ...  # noqa: D102


@dataclass(frozen=True, eq=False)
class Frf:
    """A frequency response function: motion at one degree of freedom per force at another.

    Parameters
    ----------
    omega : array_like of float, shape (n,)
        Angular frequencies, ascending [rad/s].
    values : array_like of complex, shape (n,)
        Motion per force, x(t) = Re(values F exp(i omega t)) [m/N], [m/s/N] or [m/s^2/N].
    dof : str
        Where the motion is: "node.direction", directions from 1 to 6 and a minus behind for the
        negative one, or another name.
    reference : str
        Where the force is.
    quantity : {"displacement", "velocity", "acceleration"}, optional
        The motion.
    about : str, optional
        What tells it from other functions of the same two, "preload = 120 N": of a file the second
        line of the head, of which the format holds 80 characters.

    Raises
    ------
    ModelError
        If a number is not finite, the frequencies do not ascend from 0 or above, or the lengths
        differ.
    """

    omega: NDArray[np.float64]
    values: NDArray[np.complex128]
    dof: str
    reference: str
    quantity: Quantity = "displacement"
    about: str = ""

    def __init__(
        self,
        omega: ArrayLike,
        values: ArrayLike,
        dof: str,
        reference: str,
        quantity: Quantity = "displacement",
        about: str = "",
    ) -> None:
        frequency = real_array(omega, "frf: omega", "a list of frequencies")
        motion = np.array(values, np.complex128)
        if frequency.ndim != 1 or frequency.shape != motion.shape or frequency.size < 2:
            raise ModelError(
                f"frf: {frequency.shape} frequencies, {motion.shape} values; give two lists of one "
                "length, at least 2"
            )
        if not (np.isfinite(frequency).all() and np.isfinite(motion).all()):
            raise ModelError("frf: a frequency or value is not finite")
        if frequency[0] < 0.0 or (np.diff(frequency) <= 0.0).any():
            raise ModelError("frf: the frequencies do not ascend from 0 or above; sort them")
        set_fields(
            self,
            omega=frequency,
            values=motion,
            dof=text(dof, "frf: dof"),
            reference=text(reference, "frf: reference"),
            quantity=choice(quantity, "frf: quantity", _DERIVATIVES),
            about=about if about == "" else text(about, "frf: about", lines=True),
        )

    @classmethod
    def of(cls, response: Response, dof: str, reference: str, about: str = "") -> Frf:
        """Return the fundamental of a computed response per force, of the points that were solved.

        `dof` is an observed degree of freedom, `reference` one with a force of the first harmonic;
        other forces stay in proportion to it. A structure with friction has another displacement
        per force at every level. A curve that folds or has further branches is refused: it has
        several values at a frequency.
        """
        forces = [f for f in response.model.forces if f.harmonic == 1 and f.dof == reference]
        amplitude = sum(force.coefficient for force in forces)
        if not amplitude:
            raise ModelError(f"frf: no force at {brief(reference)}; name a dof with a force")
        if response.folds.size:
            raise ModelError(
                f"frf: the curve folds {response.folds.size} times, so that it has several values "
                "at a frequency; give the frequencies as a list"
            )
        if response.branch.max() > 0:
            raise ModelError(
                "frf: the curve has further branches, so that it has several values at a "
                "frequency; give the frequencies as a list"
            )
        solved = response.converged
        order = np.argsort(response.omega[solved])
        motion = response.coefficients(dof)[solved, 1] / amplitude
        said = "; ".join(filter(None, (_further(response.model, reference), about)))
        return cls(response.omega[solved][order], motion[order], dof, reference, about=said)

    def receptance(self) -> NDArray[np.complex128]:
        """Return displacement per force [m/N], shape (n,); of derivatives nan at 0 rad/s."""
        with np.errstate(divide="ignore", invalid="ignore"):
            moved = self.values / (1j * self.omega) ** _DERIVATIVES[self.quantity]
        return np.where(np.isfinite(moved), moved, np.nan)


def _further(model: Model, reference: str) -> str:
    """Tell of the forces that act beside that at the reference."""
    if isinstance(model, BladedDisk):
        return f"to forces on all {model.sectors} sectors, engine order {model.engine_order}"
    others = dict.fromkeys(f.dof for f in model.forces if f.harmonic == 1 and f.dof != reference)
    return f"with forces in proportion at {', '.join(others)}" if others else ""


def read_frf(path: str | os.PathLike[str]) -> tuple[Frf, ...]:
    """Read the frequency response functions of a Universal File, in SI units.

    Their `.receptance()` gives m/N whatever was measured.

    Parameters
    ----------
    path : str or path-like
        The file, `.uff` or `.unv`: datasets 58 and 58b. Other datasets and functions are passed
        over. Files whose dataset 164 or labels name other units than those of SI are refused.

    Raises
    ------
    ModelError
        If the package pyuff is missing, the file is missing or damaged, or holds no frequency
        response function per force.
    """
    file = file_path(path, "path")
    # pyuff catches everything, Ctrl-C too: the block raises what was lost in it.
    with readable(file, "Universal File"), Interruption() as watch, watch.at_once():
        pyuff = optional_package("pyuff", f"{file}: Universal Files")
        present = _require_datasets(file)
        universal = pyuff.UFF(str(file))
        kinds = np.atleast_1d(universal.get_set_types())
        if np.count_nonzero(kinds == 58) != present:
            raise ValueError(
                f"of {present} datasets 58 {np.count_nonzero(kinds == 58)} can be found: blanks "
                "beside their -1 or 58"
            )
        sets = [universal.read_sets(int(at)) for at in np.flatnonzero(kinds == 58)]
        for at in np.flatnonzero(kinds == _UNITS):
            _require_si(universal.read_sets(int(at)))
        found = [_frf(one) for one in sets if one["func_type"] == _FRF]
    if not found:
        raise ModelError(f"{file}: it holds no frequency response function (dataset 58, type 4)")
    return tuple(found)


def write_frf(path: str | os.PathLike[str], functions: Frf | Iterable[Frf]) -> None:
    """Write frequency response functions to a Universal File, dataset 58 as text.

    The file is written whole or not at all. The format holds 6 digits of the frequency and 12 of
    the values; names other than "node.direction" have at most 10 characters. The package pyuff is
    needed.
    """
    file = file_path(path, "path")
    given = (functions,) if isinstance(functions, Frf) else members(functions, "frf", "[frf, ...]")
    for one in given:
        if not isinstance(one, Frf):
            raise ModelError(f"frf: {brief(one)} is not an Frf; give ss.Frf(...)")
    write(file, universal_file(file, given))


def universal_file(file: Path, functions: Iterable[Frf]) -> bytes:
    """Return the content of a Universal File; see `write_frf`."""
    pyuff = optional_package("pyuff", f"{file}: Universal Files")
    sets = [_dataset(pyuff, one) for one in functions]
    content = io.StringIO()
    with Interruption() as watch, watch.at_once():  # see `read_frf`
        for one in sets:
            # `UFF.write_sets` writes to files by name only, and hides why a disk refuses them.
            pyuff.pyuff._write58(content, one)
    return content.getvalue().encode()


def _frf(dataset: Mapping[str, object]) -> Frf:
    """Check what pyuff takes on trust."""
    numbers = {name: int(str(dataset[name])) for name in ("num_pts", "abscissa_spec_data_type")}
    values, frequency = np.asarray(dataset["data"]), np.asarray(dataset["x"])
    if not len(values) == numbers["num_pts"] == len(frequency):
        raise ValueError(f"{numbers['num_pts']} points announced, {len(values)} present")
    if numbers["abscissa_spec_data_type"] not in (0, _FREQUENCY):
        raise ValueError("a function of something else than frequency")
    if dataset["orddenom_spec_data_type"] not in (0, _FORCE):
        raise ValueError("a response per something else than force")
    for axis, what in (("ordinate", "response"), ("orddenom", "force")):
        label = str(dataset.get(f"{axis}_axis_units_lab", "")).strip()
        if not _OTHER_UNITS.isdisjoint(re.split(r"[^a-zµ]+", _GIVEN_IN.sub("", label.lower()))):
            raise ValueError(f"its {what} is in {label[:20]!r}; export it in m, s and N")
    quantity = _QUANTITIES.get(int(str(dataset["ordinate_spec_data_type"])))
    if quantity is None:
        raise ValueError("neither displacement, nor velocity, nor acceleration")
    dof, reference = (_dof(dataset, side) for side in ("rsp", "ref"))
    about = str(dataset["id2"]).strip().removeprefix(_NONE)
    return Frf(2.0 * np.pi * frequency, values, dof, reference, quantity, about)  # type: ignore[arg-type]


def _require_si(units: Mapping[str, object]) -> None:
    """Refuse a file whose numbers are not in metres and newtons."""
    code, length, force = (float(str(units[name])) for name in ("units_code", "length", "force"))
    if code != 1 and not (length == 1.0 and force == 1.0):
        raise ValueError(f"its units are those of code {code:g}; export it in m, s and N")


def _dof(dataset: Mapping[str, object], side: str) -> str:
    node, way = int(str(dataset[f"{side}_node"])), int(str(dataset[f"{side}_dir"]))
    if node > 0:
        return f"{node}.{abs(way)}{'-' if way < 0 else ''}"
    return str(dataset[f"{side}_ent_name"]).strip() or "none"


def _dataset(pyuff: ModuleType, frf: Frf) -> object:
    kind = next(code for code, name in _QUANTITIES.items() if name == frf.quantity)
    places: dict[str, object] = {}
    for side, dof in (("rsp", frf.dof), ("ref", frf.reference)):
        match = _NODE_DOF.fullmatch(dof)
        if match is None and len(dof) > _LONGEST:
            raise ModelError(
                f"frf: {brief(dof)} has {len(dof)} characters; the format holds {_LONGEST}"
            )
        places[f"{side}_ent_name"] = _NONE if match else dof
        places[f"{side}_node"] = int(match[1]) if match else 0
        places[f"{side}_dir"] = int(match[3] + match[2]) if match else 0
    return pyuff.prepare_58(
        binary=0,
        func_type=_FRF,
        data=np.array(frf.values),
        x=frf.omega / (2.0 * np.pi),
        id1=f"{frf.quantity} of {frf.dof} per force at {frf.reference}",
        id2=(" ".join(frf.about.split()) or _NONE)[:_LINE],
        abscissa_spacing=0,
        abscissa_spec_data_type=_FREQUENCY,
        ordinate_spec_data_type=kind,
        orddenom_spec_data_type=_FORCE,
        ordinate_axis_units_lab=("m", "m/s", "m/s^2")[_DERIVATIVES[frf.quantity]],
        orddenom_axis_units_lab="N",
        abscissa_axis_units_lab="Hz",
        **places,
    )


def _require_datasets(file: Path) -> int:
    """Refuse what pyuff passes over: a lost delimiter, and characters that are no numbers.

    Return how many functions there are, of which it passes over some as well.
    """
    kind, number, ended, functions = b"", 0, False, 0
    for line in file.read_bytes().splitlines():
        if line.rstrip().endswith(_END):
            ended, number = number > 0, 0 if number else 1
        elif number:
            kind = line.rstrip() if number == 1 else kind
            number += 1
            if not kind[:6].strip().isdigit():
                raise ModelError(f"{file}: a dataset without its number; the file is damaged")
            functions += number == 2 and kind.split()[0].rstrip(b"b") == b"58"
            if number > _HEAD and kind == _TEXT and not _NUMBERS.fullmatch(line):
                shown = brief(line.decode("latin-1").strip())
                raise ModelError(f"{file}: {shown} holds no numbers; the file is damaged")
        elif line.strip() and not ended:
            raise ModelError(
                f"{file}: no Universal File; read_curve reads a table of frequencies and amplitudes"
            )
        elif line.strip():
            raise ModelError(f"{file}: a line stands outside the datasets; the file is damaged")
    if number or not ended:
        raise ModelError(f"{file}: the last dataset does not end; the file was cut short")
    return functions
