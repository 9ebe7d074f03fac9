"""Meshes of other programs: where nodes are, and fields on them for ParaView."""

from __future__ import annotations

import io
import os
import re
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.linalg import eigh

from stickslip.checks import (
    brief,
    file_path,
    optional_package,
    real_number,
    set_fields,
    unknown,
    whole_number,
)
from stickslip.errors import ModelError
from stickslip.fe.reduction import Reduction
from stickslip.files import refusal, write
from stickslip.io.source import plain, readable
from stickslip.results.arrays import Measure, amplitude_of
from stickslip.results.forced_response import ForcedResponse
from stickslip.units import physical_number

_NAME = re.compile(r"(\d{1,18})\.([1-6])")
_GRID = re.compile(r"GRID(?:\*\s*|\s*,\s*|\s+)(\d+)", re.IGNORECASE)


@dataclass(frozen=True, eq=False)
class Mesh:
    """Nodes with their numbers, and the elements between them.

    Parameters
    ----------
    nodes : array_like of float, shape (n, 3)
        Coordinates, in the unit of the mesh.
    cells : sequence of (str, array_like of int, shape (elements, nodes of one))
        Elements by their kind, in the names and the order of meshio; nodes are counted from 0.
    numbers : array_like of int, shape (n,), optional
        Numbers of the nodes, as names of degrees of freedom have them. Default: 1, 2, ...

    Raises
    ------
    ModelError
        If a coordinate is not finite, an element has a node that is not there, or a number is
        given twice.
    """

    nodes: NDArray[np.float64]
    cells: tuple[tuple[str, NDArray[np.int64]], ...]
    numbers: NDArray[np.int64]

    def __init__(
        self,
        nodes: ArrayLike,
        cells: Sequence[tuple[str, ArrayLike]] = (),
        numbers: ArrayLike | None = None,
    ) -> None:
        places = np.array(nodes, np.float64)
        if places.ndim != 2 or places.shape[1] != 3 or not places.size:
            raise ModelError(f"mesh: nodes of shape {places.shape}; give three coordinates each")
        if not np.isfinite(places).all():
            raise ModelError("mesh: a coordinate is not finite")
        count = len(places)
        known = np.arange(1, count + 1) if numbers is None else np.array(numbers, np.int64)
        if known.shape != (count,) or np.unique(known).size < count:
            raise ModelError(
                f"mesh: {known.size} numbers, {np.unique(known).size} of them different, for "
                f"{count} nodes; give numbers=, one per node"
            )
        elements = tuple((str(kind), np.array(of, np.int64)) for kind, of in cells)
        for kind, of in elements:
            if of.ndim != 2 or ((of < 0) | (of >= count)).any():
                raise ModelError(f"mesh: a {kind} has a node that is not among the {count}")
        set_fields(self, nodes=places, cells=elements, numbers=known)

    def __repr__(self) -> str:
        return f"Mesh({len(self.nodes)} nodes, {sum(len(of) for _, of in self.cells)} elements)"

    @classmethod
    def read(cls, path: str | os.PathLike[str], numbers: ArrayLike | None = None) -> Mesh:
        """Read the mesh of a finite-element program; the package meshio is needed.

        Parameters
        ----------
        path : path-like
            The file: `.inp` (Abaqus, CalculiX), `.bdf` (Nastran), `.msh` (Gmsh), `.vtu` and what
            else meshio reads.
        numbers : array_like of int, optional
            Numbers of the nodes in the order of the file. Default: those of the file in `.inp`,
            `.bdf`, `.nas` and `.fem`, otherwise 1, 2, ...

        Raises
        ------
        ModelError
            If meshio is missing, or the file is missing, damaged or of an unknown kind.
        """
        file = file_path(path, "path")
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
            own = _numbers_of(file) if numbers is None else numbers
            # Elements whose nodes differ in number, as polyhedra, have no table.
            cells = [(block.type, block.data) for block in read.cells if np.ndim(block.data) == 2]
        try:
            return cls(points, cells, own)
        except ModelError as error:
            raise ModelError(f"{file}: {error}") from None

    def node_at(self, point: ArrayLike, within: float | None = None) -> int:
        """Return the number of the node nearest to a point.

        Parameters
        ----------
        point : array_like of float, shape (3,)
            Coordinates, in the unit of the mesh.
        within : float, optional
            How far away the node may be. Default: any distance.

        Raises
        ------
        ModelError
            If no node is that near.
        """
        place = np.array(point, np.float64)
        if place.shape != (3,) or not np.isfinite(place).all():
            raise ModelError(f"point: {brief(point)} has not three finite coordinates")
        distances = np.linalg.norm(self.nodes - place, axis=1)
        nearest = int(distances.argmin())
        if within is not None and distances[nearest] > real_number(within, "within"):
            raise ModelError(
                f"point: the node nearest to {place.tolist()} is {self.numbers[nearest]}, "
                f"{distances[nearest]:.3g} away; allow more than within={within:g}, or look at the "
                "unit of the mesh"
            )
        return int(self.numbers[nearest])

    def dof_at(self, point: ArrayLike, direction: int, within: float | None = None) -> str:
        """Return the degree of freedom of the node nearest to a point, "node.direction".

        `direction` is 1, 2 or 3, of rotations 4, 5 or 6; see `node_at`.
        """
        way = whole_number(direction, "direction", smallest=1, largest=6)
        return f"{self.node_at(point, within)}.{way}"

    def field(self, dofs: Iterable[str], values: ArrayLike) -> NDArray[Any]:
        """Return displacements at the nodes, shape (n, 3).

        Parameters
        ----------
        dofs : iterable of str
            Names "node.direction"; rotations are left out, and what is not named is 0, as of
            clamped nodes.
        values : array_like, shape (N,)
            Displacement of each, real or complex.

        Raises
        ------
        ModelError
            If a name is another, a node is not in the mesh, or the lengths differ.
        """
        moved, names = np.asarray(values), list(dofs)
        if moved.shape != (len(names),):
            raise ModelError(f"field: shape {moved.shape} for {len(names)} dofs; give one of each")
        nodes, ways = self._places(names)
        made = np.zeros((len(self.nodes), 3), moved.dtype)
        kept = ways < 3
        made[nodes[kept], ways[kept]] = moved[kept]
        return made

    def modes(
        self, reduction: Reduction, count: int = 6, springs: Mapping[str, float] | None = None
    ) -> dict[str, NDArray[np.float64]]:
        """Return the natural modes of a reduced structure as fields, for `write_vtu`.

        `springs` to ground at boundary degrees of freedom [N/m] are added: stuck dampers. Shapes
        are mass-normalised, (n, 3).
        """
        names = _rows_of(reduction)
        stiffness = reduction.stiffness.copy()
        for dof, spring in (springs or {}).items():
            if dof not in reduction.boundary:
                raise ModelError(f"springs: {unknown('dof', dof, reduction.boundary)}")
            place = reduction.boundary.index(dof)
            stiffness[place, place] += physical_number(spring, "N/m", f"springs: {dof}")
        largest = len(reduction.dofs)
        wanted = whole_number(count, "count", smallest=1, largest=largest)
        squares, shapes = eigh(stiffness, reduction.mass, subset_by_index=(0, wanted - 1))
        hertz = np.sqrt(np.clip(squares, 0.0, None)) / (2.0 * np.pi)
        moved = reduction.recover(shapes.T)
        return {
            f"mode {number} at {frequency:.6g} Hz": self.field(names, shape)
            for number, (frequency, shape) in enumerate(zip(hertz, moved, strict=True), 1)
        }

    def motion(
        self,
        response: ForcedResponse,
        index: int,
        reduction: Reduction | None = None,
        measure: Measure = "half_range",
    ) -> dict[str, NDArray[np.float64]]:
        """Return a point of a response as fields, for `write_vtu`.

        They are the amplitude of each component and the fundamental, real and imaginary part, of
        the displacement, shape (n, 3) [m]; and at the nodes of contacts, elsewhere not-a-number,
        the share of the period that they slip and the work that they dissipate [J], shape (n,).
        A contact between two nodes is at both, with half of its work at each; a node with several
        has the largest share and the sum of the works.

        Parameters
        ----------
        response : ForcedResponse
            With all degrees of freedom observed: ``observe=model.structure.dofs``.
        index : int
            Position of the point.
        reduction : Reduction, optional
            What leads to all degrees of freedom. Default: those of the model are all, with names
            "node.direction".
        measure : {"half_range", "max", "fundamental"}, optional
            Of the amplitude.
        """
        dofs = response.model.structure.dofs
        if response.dofs != tuple(dofs):
            raise ModelError(
                "response: not all degrees of freedom were observed; compute it with "
                "observe=model.structure.dofs"
            )
        if reduction is not None and tuple(dofs) != reduction.dofs:
            raise ModelError("reduction: the response has other degrees of freedom than it")
        count = len(response.omega)
        point = whole_number(index, "index", smallest=-count, largest=count - 1)
        series = response.arrays.displacement[point]
        names = tuple(dofs) if reduction is None else _rows_of(reduction)
        whole: Any = series if reduction is None else reduction.recover(series)
        first = self.field(names, whole[1])
        return {
            "displacement amplitude": self.field(names, amplitude_of(whole.T.copy(), measure)),
            "displacement fundamental real": first.real,
            "displacement fundamental imag": first.imag,
            **self._contacts(response, point, reduction),
        }

    def write_vtu(self, path: str | os.PathLike[str], fields: Mapping[str, ArrayLike]) -> None:
        """Write mesh and nodal fields for ParaView, whole or not at all.

        `fields` are real values at the nodes by name, shape (n,) or (n, 3). The package meshio is
        needed.
        """
        write_vtu(path, self.nodes, self.cells, fields)

    def _contacts(
        self, response: ForcedResponse, point: int, reduction: Reduction | None
    ) -> dict[str, NDArray[np.float64]]:
        """Return slip and dissipation at the nodes of contacts."""
        slip, work = (np.full(len(self.nodes), np.nan) for _ in range(2))
        model = response.model
        rows = [contact.rows(model.structure) for contact in model.contacts]
        for number, ends in enumerate(np.vstack(rows) if rows else []):
            touched = [model.structure.dofs[place] for place in np.flatnonzero(ends)]
            if reduction is not None:
                full = _rows_of(reduction)
                kept = [one for one in touched if one in reduction.boundary]
                touched = [full[reduction.rows[reduction.boundary.index(one)]] for one in kept]
            nodes = np.unique(self._places(touched)[0])
            share = response.arrays.slip_fraction[point, number]
            lost = response.arrays.dissipation[point, number] / max(len(nodes), 1)
            slip[nodes] = np.fmax(slip[nodes], share)
            work[nodes] = np.where(np.isnan(work[nodes]), lost, work[nodes] + lost)
        return {"slip fraction": slip, "dissipation": work} if rows else {}

    def _places(self, names: Sequence[str]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return nodes and directions of degrees of freedom, both counted from 0."""
        found = [_NAME.fullmatch(name) for name in names]
        for name, match in zip(names, found, strict=True):
            if match is None:
                raise ModelError(f"dof {brief(name)}: it names no node; names are node.direction")
        numbers = np.array([int(match[1]) for match in found if match], np.int64)
        ways = np.array([int(match[2]) - 1 for match in found if match], np.int64)
        order = np.argsort(self.numbers)
        places = np.searchsorted(self.numbers, numbers, sorter=order).clip(max=len(order) - 1)
        nodes = order[places]
        strange = numbers[self.numbers[nodes] != numbers]
        if strange.size:
            raise ModelError(
                f"node {strange[0]}: it is not in the mesh of {len(self.nodes)} nodes; read the "
                "mesh of the same model, or give numbers="
            )
        return nodes, ways


def write_vtu(
    path: str | os.PathLike[str],
    nodes: NDArray[np.float64],
    cells: Sequence[tuple[str, NDArray[np.int64]]],
    fields: Mapping[str, ArrayLike],
) -> None:
    """Write nodes, elements and nodal fields for ParaView; see `Mesh.write_vtu`."""
    meshio = optional_package("meshio", f"{path}: .vtu files")
    file = file_path(path, "path")
    values = {name: np.asarray(value) for name, value in fields.items()}
    for name, value in values.items():
        if value.shape not in ((len(nodes),), (len(nodes), 3)) or value.dtype.kind not in "fiub":
            raise ModelError(
                f"field {brief(name)}: {value.dtype} of shape {value.shape}; give real numbers of "
                f"shape ({len(nodes)},) or ({len(nodes)}, 3)"
            )
    data = {name: value.astype(np.float64) for name, value in values.items()}
    mesh = meshio.Mesh(nodes, list(cells), point_data=data)
    try:
        # meshio writes to files by name only.
        with tempfile.TemporaryDirectory() as folder:
            made = Path(folder) / "mesh.vtu"
            mesh.write(made)
            content = made.read_bytes()
    except OSError as error:
        raise refusal(file, "cannot be written", error) from error
    write(file, content)


def _rows_of(reduction: Reduction) -> tuple[str, ...]:
    if reduction.row_names is None:
        raise ModelError("reduction: its rows have no names; give dofs= to craig_bampton")
    return reduction.row_names


def _numbers_of(file: Path) -> list[int] | None:
    """Return the numbers of the nodes, which meshio does not tell; None of other formats."""
    kind = file.suffix.lower()
    if kind == ".inp":
        found, among = [], False
        for line in plain(file.read_bytes(), "latin-1").splitlines():
            if line.startswith("**"):
                continue
            if line.startswith("*"):
                among = line.partition(",")[0].strip("* ").upper() == "NODE"
            elif among and line.strip():
                found.append(int(line.partition(",")[0]))
        return found
    if kind in (".bdf", ".nas", ".fem"):
        lines = plain(file.read_bytes(), "latin-1").splitlines()
        return [int(match[1][:16]) for line in lines if (match := _GRID.match(line))]
    return None
