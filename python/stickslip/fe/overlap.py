"""Faces of a mesh that lie on others: on the same one, or on half of a quadrilateral."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from stickslip.checks import Matrix
from stickslip.fe.surface import Places, area_vectors

__all__ = ["corner_keys", "distinct", "uncovered"]


def corner_keys(faces: Places) -> Places:
    """Return the corners of faces in ascending order, (m, 4), of triangles after a -1."""
    corners = faces[:, : 4 if faces.shape[1] in (4, 8) else 3]
    padded = np.full((len(faces), 4), -1)
    padded[:, 4 - corners.shape[1] :] = np.sort(corners, axis=1)
    padded[:, 1:][padded[:, 1:] == padded[:, :-1]] = -1
    return np.sort(padded, axis=1)


def uncovered(of_solids: Sequence[Places], shells: Sequence[Places]) -> list[Places]:
    """Return the faces that belong to one solid element only, and the shells on no other face."""
    every = [*of_solids, *shells]
    if not every:
        return []
    keys = np.vstack(list(map(corner_keys, every)))
    unique, first, place = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    place, count = place.ravel(), sum(map(len, of_solids))
    solids = np.bincount(place[:count], minlength=len(unique))
    quads, halves = _halves(unique)
    split = (solids[halves] == 1).sum(axis=1, where=halves >= 0) == 2
    covered = np.zeros(len(unique), dtype=bool)
    covered[halves[halves >= 0]] = covered[quads[split]] = True
    # Bricks on one side of such a quadrilateral, tetrahedra on the other.
    inside = split & (solids[quads] == 1)
    solids[quads[inside]] = 2
    solids[halves[inside][halves[inside] >= 0]] = 2
    kept = solids[place] == 1
    # The first face of several alike is one of a solid, if there is one.
    own = place[count:]
    kept[count:] = (first[own] == np.arange(count, len(keys))) & ~covered[own]
    # Corners of bricks that coincide make edges of faces.
    return _parted(every, kept & (keys[:, 1] >= 0))


def distinct(faces: Sequence[Places], points: Matrix) -> list[Places]:
    """Return faces without those that lie on another one of the same side."""
    given = [one for one in faces if one.size]
    if not given:
        return []
    keys = np.vstack(list(map(corner_keys, given)))
    normals = np.vstack([area_vectors(one, points) for one in given])
    unique, first, place = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    place = place.ravel()

    def turned(others: Places) -> Places:
        against = np.einsum("mi,mi->m", normals, normals[others]) < 0.0
        return np.asarray(against, dtype=np.int64)

    kept = np.zeros(len(keys), dtype=bool)
    kept[np.unique(2 * place + turned(first[place]), return_index=True)[1]] = True
    quads, halves = _halves(unique)
    quad, half = np.nonzero(halves >= 0)
    whole = np.full(len(unique), -1)
    whole[halves[quad, half]] = first[quads[quad]]
    on = whole[place]
    kept &= (on < 0) | (turned(on) == 1)
    return _parted(given, kept)


def _halves(keys: Places) -> tuple[Places, Places]:
    """Return which keys are quadrilaterals that triangles may lie on, (q,), and those triangles.

    The latter, (q, 4), lack one corner each; -1: there is no such triangle.
    """
    triangles = np.flatnonzero((keys[:, 0] < 0) & (keys[:, 1] >= 0))
    shared = np.isin(keys, keys[triangles, 1:]).sum(axis=1) >= 3
    quads = np.flatnonzero((keys[:, 0] >= 0) & shared)
    others = np.array([[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]])
    parts = keys[quads][:, others].reshape(-1, 3)
    rows = np.vstack([keys[triangles, 1:], parts])
    _, group = np.unique(rows, axis=0, return_inverse=True)
    group = group.ravel()
    triangle = np.full(len(rows), -1)
    triangle[group[: len(triangles)]] = triangles
    return quads, triangle[group[len(triangles) :]].reshape(-1, 4)


def _parted(faces: Sequence[Places], kept: np.ndarray) -> list[Places]:
    """Return the faces that are kept, in arrays as they were given."""
    ends = np.cumsum([len(one) for one in faces])[:-1]
    return [one[own] for one, own in zip(faces, np.split(kept, ends), strict=True)]
