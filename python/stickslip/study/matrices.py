"""The matrices that a study file names: of files, written out, or made by a damping law."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from difflib import get_close_matches
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from stickslip.checks import brief, file_path, is_file
from stickslip.errors import ModelError
from stickslip.model.structure import ModalDamping, Rayleigh
from stickslip.study.structure_table import MatrixFile, ModalDampingTable, RayleighDamping

if TYPE_CHECKING:
    from stickslip.checks import MatrixLike
    from stickslip.model.structure import DampingLaw
    from stickslip.study.structure_table import Rows


@contextmanager
def named(entry: str) -> Iterator[None]:
    """Say where the entry stands that is complained of."""
    try:
        yield
    except ModelError as error:
        raise ModelError(f"{entry}: {error.study}") from None


def damping_of(
    source: str | MatrixFile | Rows | RayleighDamping | ModalDampingTable | None,
    folder: Path,
    entry: str = "damping",
) -> MatrixLike | DampingLaw | None:
    """Return a damping matrix or law."""
    match source:
        case None:
            return None
        case RayleighDamping(rayleigh=factor):
            return Rayleigh(mass=factor.mass, stiffness=factor.stiffness)
        case ModalDampingTable(modal=ratio):
            return ModalDamping(ratio)
        case source:
            return matrix_of(source, folder, entry)


def matrix_of(source: str | MatrixFile | Rows, folder: Path, entry: str) -> MatrixLike:
    """Return a matrix that is written out, or of a file relative to a folder."""
    from stickslip.io import read_matrix

    if isinstance(source, tuple):
        return np.array(source, dtype=np.float64)
    name, key = (source, None) if isinstance(source, str) else (source.file, source.key)
    path = folder / file_path(name, entry)
    if not is_file(path):
        place = path.parent.resolve()
        raise ModelError(f"{entry} = {brief(name)}: no such file in {place}{neighbour(path)}")
    with named(entry):
        return read_matrix(path, key)


def neighbour(path: Path) -> str:
    """Suggest the file of the folder whose name is nearest."""
    folder = path.parent
    if not folder.is_dir():
        return f"; there is no folder {folder} either"
    near = get_close_matches(path.name, [file.name for file in folder.iterdir()], 1, 0.75)
    return f"; did you mean '{near[0]}'?" if near else ""
