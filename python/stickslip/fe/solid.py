"""Solid finite elements, hexahedra of 20 nodes with quadratic shape functions, and their stress."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.checks import brief, optional_package, real_number, whole_number
from stickslip.errors import ModelError
from stickslip.fe.sparse import CscArray
from stickslip.fe.vtu import write_vtu
from stickslip.units import physical_number

_BOTTOM = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0)]
_EDGES = [(1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0)]
_VTK = np.array(
    [
        *_BOTTOM,
        *((x, y, 2) for x, y, _ in _BOTTOM),
        *_EDGES,
        *((x, y, 2) for x, y, _ in _EDGES),
        *((x, y, 1) for x, y, _ in _BOTTOM),
    ]
)
"""Places of the 20 nodes in VTK's order, in half edges."""
_MIRRORED = [*range(4, 8), *range(4), *range(12, 16), *range(8, 12), *range(16, 20)]
"""The same with top and bottom exchanged."""
_ELEMENTS = 4000
"""Elements at a time: the entries of all of them need far more memory than the matrix."""
_BLOCK = 2000
"""Nodes at a time: the differences of all instants of so many fit into memory."""

_Array: TypeAlias = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Solid:
    """An elastic body of hexahedra.

    Parameters
    ----------
    mesh : skfem.MeshHex
        Vertices in m; the elements have straight edges.
    young : float
        Young's modulus [Pa].
    poisson : float
        Poisson's ratio.
    density : float
        [kg/m^3].

    Raises
    ------
    ModelError
        If scikit-fem is missing, or a constant is not physical.
    """

    mesh: Any
    young: float
    poisson: float
    density: float
    _basis: Any = field(init=False, repr=False)

    def __post_init__(self) -> None:
        skfem = _skfem()
        if not isinstance(self.mesh, skfem.MeshHex):
            raise ModelError(
                f"solid: mesh {brief(self.mesh)} has no hexahedra; give a skfem.MeshHex"
            )
        for name, unit in (("young", "Pa"), ("density", "kg/m^3")):
            number = physical_number(getattr(self, name), unit, f"solid: {name}")
            if number <= 0.0:
                raise ModelError(f"solid: {name} {number:g} must be positive")
            object.__setattr__(self, name, number)
        if not -1.0 < real_number(self.poisson, "solid: poisson") < 0.5:
            raise ModelError(f"solid: poisson {self.poisson:g} must lie between -1 and 0.5")
        # It numbers and places degrees of freedom: at one point, or its values fill the memory.
        element = skfem.ElementVector(skfem.ElementHexS2())
        middle = np.full((3, 1), 0.5), np.ones(1)
        object.__setattr__(self, "_basis", skfem.Basis(self.mesh, element, quadrature=middle))

    @cached_property
    def nodes(self) -> NDArray[np.float64]:
        """Vertices, then middles of edges [m], shape (n, 3).

        Degree of freedom 3 i + j is direction j of node i.
        """
        return np.asarray(self._basis.doflocs[:, ::3].T, dtype=np.float64)

    @cached_property
    def dofs(self) -> tuple[str, ...]:
        """Names of the degrees of freedom, "node.direction", both from 1."""
        return tuple(f"{node}.{way}" for node in range(1, len(self.nodes) + 1) for way in (1, 2, 3))

    @cached_property
    def stiffness(self) -> CscArray:
        """Stiffness matrix [N/m], sparse, of the free body."""
        shear = self.young / (2.0 * (1.0 + self.poisson))
        lame = 2.0 * shear * self.poisson / (1.0 - 2.0 * self.poisson)

        def of_elements(_: _Array, grad: _Array, weights: _Array) -> _Array:
            flat = grad.reshape(*grad.shape[:2], 60)  # (element, point, function and direction)
            products = np.matmul((flat * weights[:, :, None]).transpose(0, 2, 1), flat)
            products = products.reshape(-1, 20, 3, 20, 3)
            whole: _Array = lame * products + shear * products.transpose(0, 1, 4, 3, 2)
            trace = shear * np.einsum("eaibi->eab", products)
            for way in range(3):
                whole[:, :, way, :, way] += trace
            return whole

        return self._assembled(of_elements)

    @cached_property
    def mass(self) -> CscArray:
        """Consistent mass matrix [kg], sparse."""

        def of_elements(shapes: _Array, _: _Array, weights: _Array) -> _Array:
            of_density = self.density * weights
            scalar = np.einsum("aq,bq,eq->eab", shapes, shapes, of_density, optimize=True)
            whole = np.zeros((len(scalar), 20, 3, 20, 3))
            for way in range(3):
                whole[:, :, way, :, way] = scalar
            return whole

        return self._assembled(of_elements)

    def nearest(self, point: ArrayLike) -> int:
        """Return the node nearest to a point [m]."""
        return int(np.linalg.norm(self.nodes - np.asarray(point), axis=1).argmin())

    def load(
        self, traction: Callable[[NDArray[np.float64]], NDArray[np.float64]], vertices: ArrayLike
    ) -> NDArray[np.float64]:
        """Return the forces of a traction on part of the surface, shape (3 n,) [N].

        `traction` leads from places, shape (3, ...), to force per area, the same shape [Pa]; the
        faces that have all their `vertices` among those given are loaded.
        """
        skfem = _skfem()
        among = np.isin(self.mesh.facets, np.asarray(vertices)).all(axis=0)
        faces = np.intersect1d(np.flatnonzero(among), self.mesh.boundary_facets())
        if not faces.size:
            raise ModelError("solid: no face has all its vertices among those given")
        basis = skfem.FacetBasis(self.mesh, self._basis.elem, facets=faces, intorder=4)

        @skfem.LinearForm  # type: ignore[untyped-decorator, unused-ignore]
        def work(v: Any, w: Any) -> Any:
            force = traction(np.asarray(w.x))
            return force[0] * v[0] + force[1] * v[1] + force[2] * v[2]

        return np.asarray(work.assemble(basis), dtype=np.float64)

    def stress(self, displacement: ArrayLike) -> NDArray[Any]:
        """Return the stress of a displacement field at the nodes, shape (n, 6) [Pa].

        The field is of all degrees of freedom, real or complex [m]; the stress xx, yy, zz, yz, xz,
        xy is the mean of the elements around a node, each evaluated at the node itself.
        """
        given = np.asarray(displacement)
        if np.iscomplexobj(given):
            return np.asarray(self.stress(given.real) + 1j * self.stress(given.imag))
        gradient = np.asarray(self._nodal_basis.interpolate(given).grad)  # (i, j, element, place)
        strain = 0.5 * (gradient + gradient.transpose(1, 0, 2, 3))
        shear = self.young / (2.0 * (1.0 + self.poisson))
        lame = 2.0 * shear * self.poisson / (1.0 - 2.0 * self.poisson)
        stress = 2.0 * shear * strain
        for way in range(3):
            stress[way, way] += lame * np.trace(strain)
        places = self._node_of_place
        count = np.bincount(places.ravel(), minlength=len(self.nodes))
        parts = [(0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1)]
        sums = [
            np.bincount(places.ravel(), stress[i, j].ravel(), minlength=len(self.nodes))
            for i, j in parts
        ]
        return np.asarray(np.array(sums).T / count[:, None])

    def write_vtu(self, path: str | os.PathLike[str], fields: Mapping[str, ArrayLike]) -> None:
        """Write mesh and nodal fields for ParaView, whole or not at all.

        `fields` are real values at the nodes by name, shape (n,) or (n, 3). The package meshio is
        needed.
        """
        write_vtu(path, self.nodes, [("hexahedron20", self.elements)], fields)

    def _assembled(self, of_elements: Callable[[_Array, _Array, _Array], _Array]) -> CscArray:
        """Add up matrices of elements, shape (elements, 20, 3, 20, 3), of their `_shapes`.

        The forms of scikit-fem give the same to rounding, eleven times slower: they are evaluated
        for each of the 60 x 60 pairs of shape functions.
        """
        from scipy.sparse import coo_array

        size = 3 * len(self.nodes)
        dofs = (3 * self._node_of_place[:, :, None] + np.arange(3)).reshape(-1, 60)
        dofs = dofs.astype(np.int32 if size <= np.iinfo(np.int32).max else np.int64)
        parts = []
        for first in range(0, len(dofs), _ELEMENTS):
            some = np.arange(first, min(first + _ELEMENTS, len(dofs)))
            rows = np.broadcast_to(dofs[some, :, None], (len(some), 60, 60))
            columns = rows.transpose(0, 2, 1)
            entries = of_elements(*self._shapes(some)).ravel(), (rows.ravel(), columns.ravel())
            parts.append(coo_array(entries, shape=(size, size)).tocsc())
        while len(parts) > 1:  # in pairs: one after the other, each would copy all before it
            pairs = zip(parts[::2], parts[1::2], strict=False)
            parts = [one + other for one, other in pairs] + parts[len(parts) // 2 * 2 :]
        parts[0].eliminate_zeros()
        return parts[0]

    def _shapes(self, elements: NDArray[np.int64]) -> tuple[_Array, _Array, _Array]:
        """Shape functions and weights at the points of some elements.

        The values (function, point) are the same in every element; the gradients are (element,
        point, function, direction).
        """
        skfem = _skfem()
        # Order 4 integrates the mass of a brick exactly.
        basis = skfem.Basis(self.mesh, skfem.ElementHexS2(), intorder=4, elements=elements)
        values = np.array([np.atleast_2d(np.asarray(one[0]))[0] for one in basis.basis])
        shape = basis.dx.shape
        grad = np.array([np.broadcast_to(one[0].grad, (3, *shape)) for one in basis.basis])
        return values, np.ascontiguousarray(grad.transpose(2, 3, 0, 1)), np.asarray(basis.dx)

    @cached_property
    def _nodal_basis(self) -> Any:
        """The basis evaluated at the nodes of each element, in the element's order."""
        skfem = _skfem()
        scalar = skfem.ElementHexS2()
        places = np.asarray(scalar.doflocs).T
        weights = np.full(places.shape[1], 1.0 / places.shape[1])
        return skfem.Basis(self.mesh, self._basis.elem, quadrature=(places, weights))

    @cached_property
    def _node_of_place(self) -> NDArray[np.int64]:
        """The node at each place of each element, shape (elements, 20)."""
        return np.asarray(self._basis.element_dofs[::3].T // 3, dtype=np.int64)

    @cached_property
    def elements(self) -> NDArray[np.int64]:
        """Positions of the nodes of each element, shape (m, 20).

        In the order of C3D20 of CalculiX and Abaqus, and of VTK: corners, then middles of edges.
        """
        places = np.rint(2.0 * np.asarray(_skfem().ElementHexS2().doflocs)).astype(int)
        order = [int(np.flatnonzero((places == place).all(axis=1))[0]) for place in _VTK]
        cells = self._node_of_place[:, order]
        # Meshes may map their elements mirrored; other programs want the corners right-handed.
        first, along, across, up = (self.nodes[cells[:, corner]] for corner in (0, 1, 3, 4))
        volume = np.einsum("ei,ei->e", np.cross(along - first, across - first), up - first)
        return np.where((volume < 0.0)[:, None], cells[:, _MIRRORED], cells)


def _skfem() -> Any:
    return optional_package("skfem", "solid: finite elements", "scikit-fem")


def von_mises(stress: ArrayLike) -> NDArray[np.float64]:
    """Return the von Mises equivalent [Pa] of real stresses, shape (..., 6).

    They are xx, yy, zz, yz, xz, xy [Pa].
    """
    xx, yy, zz, yz, xz, xy = np.moveaxis(np.asarray(stress, dtype=np.float64), -1, 0)
    normal = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
    return np.asarray(np.sqrt(0.5 * normal + 3.0 * (yz**2 + xz**2 + xy**2)))


def von_mises_range(harmonics: ArrayLike, samples: int = 64) -> NDArray[np.float64]:
    """Return the range of the von Mises stress over a period.

    The largest von Mises equivalent of the difference of the stresses at two instants,
    max over t1, t2 of vM(s(t1) - s(t2)). Unlike the range of vM(s(t)), which has no sign, it is
    twice the amplitude in a motion that goes as far to either side, and static stress adds nothing.

    Parameters
    ----------
    harmonics : array_like of complex, shape (H+1, n, 6)
        S_k of s(t) = Re sum_k S_k exp(i k omega t): xx, yy, zz, yz, xz, xy [Pa].
    samples : int, optional
        Instants per period between which the difference is taken, an even number.

    Returns
    -------
    ndarray of float64, shape (n,)
        [Pa].

    Raises
    ------
    ModelError
        If the shape is another, or `samples` is not an even number from 4.

    References
    ----------
    The equivalent stress range of ASME BPVC VIII-2, 5.5.3 (components of two instants subtracted).
    """
    given = np.asarray(harmonics)
    if given.ndim != 3 or given.shape[2] != 6:
        raise ModelError(f"stress: shape {given.shape}; give (harmonics, nodes, 6)")
    count = whole_number(samples, "samples", smallest=4)
    if count % 2:
        raise ModelError(f"samples: {count} is odd; half periods need an even number")
    phases = np.exp(2j * np.pi * np.outer(np.arange(count) / count, np.arange(len(given))))
    largest = np.zeros(given.shape[1])
    for start in range(0, given.shape[1], _BLOCK):
        nodes = slice(start, start + _BLOCK)
        history = np.real(np.tensordot(phases, given[:, nodes], axes=1))  # (instant, node, 6)
        for lag in range(1, count // 2 + 1):
            difference = von_mises(history - np.roll(history, lag, axis=0)).max(axis=0)
            largest[nodes] = np.maximum(largest[nodes], difference)
    return largest
