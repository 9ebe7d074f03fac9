"""Surfaces of finite-element meshes: their faces, the areas and the normals of their nodes."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Self

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import Matrix
from stickslip.errors import ModelError

Places = NDArray[np.int64]
"""Positions of nodes."""

CORNERS = {3: 3, 4: 4, 6: 3, 8: 4}
"""Corners of a face by its number of nodes; the others are middles of its edges, in their order."""
_A, _B = 0.445948490915965, 0.091576213509771
_OF_A, _OF_B = 0.111690794839005, 0.054975871827661
_TRIANGLE = (
    np.array([[_A, _A], [1 - 2 * _A, _A], [_A, 1 - 2 * _A]]),
    np.array([[_B, _B], [1 - 2 * _B, _B], [_B, 1 - 2 * _B]]),
)


def outward(faces: Places, points: Matrix, inside: Matrix) -> Places:
    """Return faces, (m, k), numbered so that their normals point away from the points inside."""
    middle = points[faces[:, : CORNERS[faces.shape[1]]]].mean(axis=1)
    inverted = np.einsum("mi,mi->m", area_vectors(faces, points), middle - inside) < 0.0
    return np.where(inverted[:, None], turned(faces), faces)


def area_vectors(faces: Places, points: Matrix) -> Matrix:
    """Return the normals of faces with straight edges, as long as their areas, shape (m, 3)."""
    corners = (0, 1, 2, CORNERS[faces.shape[1]] - 1)
    first, second, third, last = (points[faces[:, one]] for one in corners)
    return 0.5 * np.cross(third - first, last - second)


def turned(faces: Places) -> Places:
    """Return faces numbered the other way round."""
    corners = CORNERS[faces.shape[1]]
    first, around, middles = np.split(faces, [1, corners], axis=1)
    return np.hstack([first, around[:, ::-1], middles[:, ::-1]])


@dataclass(frozen=True, eq=False)
class Surface:
    """Part of the surface of a mesh: faces of three, four, six or eight nodes."""

    labels: Places
    """Numbers of the nodes in their model, shape (n,)."""
    points: Matrix
    """Coordinates of the nodes [m], shape (n, 3)."""
    faces: tuple[Places, ...]
    """Positions in `labels` of the nodes of the faces, shapes (m, k): corners counted around the
    normal, then the middles of the edges between them."""

    @classmethod
    def of(cls, labels: Places, points: Matrix, faces: Iterable[Places], entry: str) -> Self:
        """Return the surface of some faces of a mesh."""
        given = [one for one in faces if one.size]
        if not given:
            raise ModelError(f"{entry}: it has no faces; name a surface, or all nodes of faces")
        used = np.unique(np.concatenate([one.ravel() for one in given]))
        own = tuple(np.searchsorted(used, one) for one in given)
        return cls(labels[used], points[used], own)

    @property
    def area(self) -> float:
        """Area of all faces [m2]."""
        return float(self.areas.sum())

    @cached_property
    def areas(self) -> Matrix:
        """Area of each node [m2], shape (n,); they add up to the area of the faces.

        Of a face with straight edges the integral of the node's shape function. Of a quadratic one
        that integral is zero or negative at corners; the area of the face is shared out by the
        integrals of the squares instead, which are positive.

        References
        ----------
        Hinton, Rock and Zienkiewicz, "A note on mass lumping and related processes in the finite
        element method", Earthquake Engineering and Structural Dynamics 4 (1976) 245-249.
        """
        areas = np.zeros(len(self.labels))
        for face, shares, vectors in self._integrals:
            sizes = np.linalg.norm(vectors, axis=-1)  # (m, q)
            np.add.at(areas, face, _shared(shares, sizes))
        return areas

    @cached_property
    def normals(self) -> Matrix:
        """Unit normal at each node, the mean of its faces by their areas, shape (n, 3)."""
        self._require_one_side()
        sums = np.zeros((len(self.labels), 3))
        for face, shares, vectors in self._integrals:
            np.add.at(sums, face, np.einsum("qk,mqi->mki", shares, vectors))
        length = np.linalg.norm(sums, axis=1, keepdims=True)
        flat = np.flatnonzero(~(length[:, 0] > 0.0))
        if flat.size:
            raise ModelError(
                f"surface: node {self.labels[flat[0]]} has no normal: the faces around it have no "
                "area, or cancel; leave one of two opposite sides out"
            )
        normals: Matrix = sums / length
        return normals

    def _require_one_side(self) -> None:
        """Refuse neighbours whose normals point to different sides, as those of shells may.

        Around their normals faces go along the edge between them in opposite directions.
        """
        corners = [face[:, : CORNERS[face.shape[1]]] for face in self.faces]
        begin = np.concatenate([one.ravel() for one in corners])
        end = np.concatenate([np.roll(one, -1, axis=1).ravel() for one in corners])
        # Corners of a collapsed face coincide.
        edge, size = begin != end, len(self.labels)
        there, count = np.unique((begin * size + end)[edge], return_counts=True)
        alone = np.setdiff1d(there[count > 1], (end * size + begin)[edge])
        if alone.size:
            one, other = self.labels[list(divmod(int(alone[0]), size))]
            raise ModelError(
                f"surface: the faces at the edge of nodes {one} and {other} are numbered in "
                "opposite senses, so that their normals point to different sides; number them alike"
            )

    @cached_property
    def shortest_edge(self) -> float:
        """Least distance of two corners of a face [m]."""
        corners = [self.points[face[:, : CORNERS[face.shape[1]]]] for face in self.faces]
        edges = [np.linalg.norm(one - np.roll(one, 1, axis=1), axis=-1) for one in corners]
        # Corners of a collapsed face coincide.
        return min(float(one[one > 0.0].min(initial=np.inf)) for one in edges)

    @property
    def _integrals(self) -> Iterable[tuple[Places, Matrix, Matrix]]:
        """Of each kind of face its nodes, their shares at points, and the area vectors there.

        Shapes (m, k), (q, k), (m, q, 3); the vectors are normal, as long as the area of the point.
        """
        for face in self.faces:
            places, weights = _quadrature(face.shape[1])
            values, gradients = _shapes(face.shape[1], places)
            along, across = np.einsum("qdk,mki->dmqi", gradients, self.points[face])
            shares = values if face.shape[1] == CORNERS[face.shape[1]] else values**2
            yield face, shares, np.cross(along, across) * weights[:, None]


def _shared(shares: Matrix, sizes: Matrix) -> Matrix:
    """Return the parts of the nodes of each face, which add up to its area, shape (m, k)."""
    parts = sizes @ shares
    scale = sizes.sum(axis=1) / parts.sum(axis=1)
    result: Matrix = parts * scale[:, None]
    return result


def _quadrature(nodes: int) -> tuple[Matrix, Matrix]:
    """Return places (q, 2) and weights: exact to degree 4 of triangles, 5 of quadrilaterals."""
    if CORNERS[nodes] == 3:
        return np.vstack(_TRIANGLE), np.repeat([_OF_A, _OF_B], 3)
    line, weights = np.polynomial.legendre.leggauss(3)
    return np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2), np.outer(
        weights, weights
    ).ravel()


def _shapes(nodes: int, places: Matrix) -> tuple[Matrix, Matrix]:
    """Return values (q, k) and gradients (q, 2, k) of the shape functions of a face."""
    r, s = places.T
    zero, one = np.zeros_like(r), np.ones_like(r)
    if CORNERS[nodes] == 3:
        corner, slopes = _columns([1 - r - s, r, s], [(-one, -one), (one, zero), (zero, one)])
    else:
        ways = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
        corner, slopes = _columns(
            [(1 + a * r) * (1 + b * s) / 4 for a, b in ways],
            [(a * (1 + b * s) / 4, b * (1 + a * r) / 4) for a, b in ways],
        )
    if nodes == CORNERS[nodes]:
        return corner, slopes
    after = np.roll(np.arange(nodes // 2), -1)
    if CORNERS[nodes] == 3:
        middle = 4 * corner * corner[:, after]
        middles = 4 * (corner[:, None] * slopes[:, :, after] + slopes * corner[:, None, after])
    else:
        middle, middles = _columns(
            [
                *((1 - r**2) * (1 - s) / 2, (1 - s**2) * (1 + r) / 2),
                *((1 - r**2) * (1 + s) / 2, (1 - s**2) * (1 - r) / 2),
            ],
            [
                *((-r * (1 - s), -(1 - r**2) / 2), ((1 - s**2) / 2, -s * (1 + r))),
                *((-r * (1 + s), (1 - r**2) / 2), (-(1 - s**2) / 2, -s * (1 - r))),
            ],
        )
    # A corner loses half of the functions at the middles of its two edges.
    before = np.roll(np.arange(nodes // 2), 1)
    corner = corner - (middle + middle[:, before]) / 2
    slopes = slopes - (middles + middles[:, :, before]) / 2
    return np.hstack([corner, middle]), np.concatenate([slopes, middles], axis=2)


def _columns(
    values: Sequence[Matrix], gradients: Sequence[tuple[Matrix, Matrix]]
) -> tuple[Matrix, Matrix]:
    return np.stack(values, axis=-1), np.stack([np.stack(one, axis=-1) for one in gradients], -1)
