"""Meshes from the files of finite-element programs."""

from __future__ import annotations

import io
import os
import re
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from stickslip.checks import file_path, optional_package
from stickslip.errors import ModelError
from stickslip.fe.mesh import Mesh
from stickslip.io.ansys_mesh import mesh_of_archive
from stickslip.io.archive import is_archive, parse_archive
from stickslip.io.bulk_mesh import read_bulk_mesh
from stickslip.io.decks import read_deck
from stickslip.io.source import of_deck, readable
from stickslip.model.matrix_units import MatrixUnits, Units

_BULK = re.compile(r"^(?:BEGIN +BULK|GRID[* ,\t])", re.I | re.M)
"""What bulk data has that other files of an ending do not."""


def read_mesh(
    path: str | os.PathLike[str], numbers: ArrayLike | None = None, *, units: Units = None
) -> Mesh:
    """Read the mesh of a finite-element program.

    Parameters
    ----------
    path : path-like
        The file. Of a deck, `.inp` of CalculiX or Abaqus without parts and instances, node sets
        and surfaces are read, too, their names in capitals; solids C3D4, C3D6, C3D8, C3D10, C3D15
        and C3D20 and shells S3 to S8 with all that is added to their names, others are left out.
        Of ANSYS, `.cdb` of CDWRITE and `.dat` of Workbench, components of nodes are node sets,
        those of shells and of contact and surface elements are surfaces.
        Of Nastran's bulk data, `.bdf`, `.nas`, `.fem` or `.dat`, solids and shells are read, and
        the nodes of every `SET1` are a node set, "SET1 7" by its number. Other files, `.msh`
        (Gmsh), `.vtu`, need the package meshio.
    numbers : array_like of int, optional
        Numbers of the nodes in the order of the file. Default: those of the file in `.inp`,
        `.cdb`, `.dat`, `.bdf`, `.nas` and `.fem`; otherwise 1, 2, ...
    units : str, optional
        Mass, length and time of the file, as of `Structure`: with "t-mm-s" coordinates in
        millimetres become metres. Areas of contacts, whose stiffness is in N/m3, need metres.

    Returns
    -------
    Mesh
        In metres with `units`, otherwise in the unit of length of the file.

    Raises
    ------
    ModelError
        If meshio is needed and missing, units are not known, or the file is missing, damaged or
        of an unknown kind.

    References
    ----------
    Dhondt, "CalculiX CrunchiX User's Manual", keywords *NODE, *ELEMENT, *NSET, *ELSET, *SURFACE.
    ANSYS, Inc., "Mechanical APDL Programmer's Reference", "Coded Database File Commands".
    MSC Nastran, "Quick Reference Guide", bulk data entries GRID and SET1.
    """
    file = file_path(path, "path")
    metres = 1.0 if units is None else MatrixUnits.of(units).length
    own = _own(file)
    if own is None:
        return _by_meshio(file, metres, numbers)
    return Mesh(
        metres * own.nodes,
        own.cells,
        own.numbers if numbers is None else numbers,
        own.node_sets,
        own.surfaces,
        own.rotated,
    )


def _own(file: Path) -> Mesh | None:
    """Return a mesh that no further package has to read; None: it is of another program."""
    ending = file.suffix.lower()
    if ending in (".bdf", ".nas", ".fem"):
        with readable(file, "mesh"):
            return read_bulk_mesh(file)
    if ending not in (".inp", ".cdb", ".dat"):
        return None
    with readable(file, "archive of ANSYS"):
        text = of_deck(file.read_bytes())
        if ending == ".cdb" or is_archive(text):
            return mesh_of_archive(parse_archive(text))
    if ending == ".inp":
        return read_deck(file)
    if not _BULK.search(text):
        return None
    with readable(file, "bulk data of Nastran"):
        return read_bulk_mesh(file)


def _by_meshio(file: Path, metres: float, numbers: ArrayLike | None) -> Mesh:
    """Return a mesh of other programs, without sets."""
    with readable(file, "mesh"):
        meshio = optional_package("meshio", f"{file}: meshes")
        said = io.StringIO()
        try:
            with redirect_stdout(said), redirect_stderr(said):
                read = meshio.read(file)
        except SystemExit:
            # So it ends where all readers of an ending have failed.
            raise ValueError(said.getvalue() or "no reader knows it") from None
        points = np.asarray(read.points, dtype=np.float64)
        if points.ndim == 2 and points.shape[1] == 2:
            points = np.pad(points, ((0, 0), (0, 1)))
        # Elements whose nodes differ in number, as polyhedra, have no table.
        cells = [(block.type, block.data) for block in read.cells if np.ndim(block.data) == 2]
    try:
        return Mesh(metres * points, cells, numbers)
    except ModelError as error:
        raise ModelError(f"{file}: {error}") from None
