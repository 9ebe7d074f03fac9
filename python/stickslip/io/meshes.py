"""Meshes from the files of finite-element programs."""

from __future__ import annotations

import io
import os
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from stickslip.checks import file_path, optional_package
from stickslip.errors import ModelError
from stickslip.fe.mesh import Mesh
from stickslip.io.ansys_mesh import mesh_of_archive
from stickslip.io.archive import is_archive, parse_archive
from stickslip.io.bulk_data import read_bulk
from stickslip.io.decks import read_deck
from stickslip.io.source import plain, readable
from stickslip.model.matrix_units import MatrixUnits, Units


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
        Other files, `.bdf` (Nastran), `.msh` (Gmsh), `.vtu`, need the package meshio. Of Nastran's
        bulk data the nodes of every `SET1` are a node set, "SET1 7" by its number.
    numbers : array_like of int, optional
        Numbers of the nodes in the order of the file. Default: those of the file in `.inp`,
        `.cdb`, `.dat`, `.bdf`, `.nas` and `.fem`, otherwise 1, 2, ...
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
    if file.suffix.lower() in (".inp", ".cdb", ".dat"):
        own_mesh = _deck_or_archive(file)
        if own_mesh is not None:
            return _changed(own_mesh, metres, numbers)
    with readable(file, "mesh"):
        meshio = optional_package("meshio", f"{file}: meshes")
        # It names the line of what is wrong, and meshio does not.
        bulk = read_bulk(file) if file.suffix.lower() in (".bdf", ".nas", ".fem") else None
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
        own = bulk.numbers if bulk and numbers is None else numbers
        # Elements whose nodes differ in number, as polyhedra, have no table.
        cells = [(block.type, block.data) for block in read.cells if np.ndim(block.data) == 2]
    try:
        return Mesh(metres * points, cells, own, bulk.node_sets() if bulk else None)
    except ModelError as error:
        raise ModelError(f"{file}: {error}") from None


def _deck_or_archive(file: Path) -> Mesh | None:
    """Return a mesh that no further package has to read; None: it is of another program."""
    ending = file.suffix.lower()
    with readable(file, "archive of ANSYS"):
        text = plain(file.read_bytes(), "latin-1")
        if ending == ".cdb" or is_archive(text):
            return mesh_of_archive(parse_archive(text))
    return read_deck(file) if ending == ".inp" else None


def _changed(mesh: Mesh, metres: float, numbers: ArrayLike | None) -> Mesh:
    """Return a mesh in another unit of length, with other numbers if they are given."""
    return Mesh(
        metres * mesh.nodes,
        mesh.cells,
        mesh.numbers if numbers is None else numbers,
        mesh.node_sets,
        mesh.surfaces,
        mesh.rotated,
    )
