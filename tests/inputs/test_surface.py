"""Areas and normals of surfaces of finite elements."""

import numpy as np
import pytest

from stickslip import ModelError
from stickslip.fe.surface import Surface, turned


def flat(faces, points):
    return Surface.of(np.arange(1, len(points) + 1), points, faces, "test")


def random_triangles(seed):
    """Triangles of random points in a plane that is turned; their area by the hull."""
    from scipy.spatial import ConvexHull, Delaunay

    random = np.random.default_rng(seed)
    plane = random.random((40, 2))
    turn = np.linalg.qr(random.standard_normal((3, 3)))[0]
    turn[2] *= np.linalg.det(turn)
    triangles = Delaunay(plane).simplices.astype(np.int64)
    points = np.column_stack([plane, np.full(40, 0.3)]) @ turn
    return triangles, points, ConvexHull(plane).volume, turn


def quadratic(faces, points):
    """The same faces with nodes at the middles of their edges."""
    corners = faces.shape[1]
    edges = np.stack([faces, np.roll(faces, -1, axis=1)], axis=-1)
    keys, place = np.unique(np.sort(edges.reshape(-1, 2), axis=1), axis=0, return_inverse=True)
    middles = points[keys].mean(axis=1)
    added = place.reshape(-1, corners) + len(points)
    return np.hstack([faces, added]), np.vstack([points, middles])


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("order", [1, 2])
def test_areas_of_random_triangles_add_up(seed, order):
    faces, points, area, turn = random_triangles(seed)
    if order == 2:
        faces, points = quadratic(faces, points)
    surface = flat([faces], points)
    assert surface.area == pytest.approx(area, rel=1e-13)
    assert (surface.areas > 0.0).all()
    cosine = surface.normals @ turn[2]
    np.testing.assert_allclose(np.abs(cosine), 1.0, rtol=0, atol=1e-12)
    np.testing.assert_allclose(flat([turned(faces)], points).normals, -surface.normals, atol=1e-12)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("order", [1, 2])
def test_areas_of_random_quadrilaterals_add_up(seed, order):
    random = np.random.default_rng(seed)
    x, y = np.meshgrid(np.arange(5.0), np.arange(4.0), indexing="ij")
    inner = (x % 4 > 0) & (y % 3 > 0)
    x, y = (one + 0.3 * inner * random.uniform(-1, 1, x.shape) for one in (x, y))
    points = np.column_stack([x.ravel(), y.ravel(), np.zeros(20)])
    grid = np.arange(20).reshape(5, 4)
    corners = grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]
    faces = np.stack([one.ravel() for one in corners], axis=1)
    if order == 2:
        faces, points = quadratic(faces, points)
    surface = flat([faces], points)
    assert surface.area == pytest.approx(12.0, rel=1e-13)
    assert (surface.areas > 0.0).all()
    np.testing.assert_allclose(surface.normals, np.tile([0.0, 0.0, 1.0], (len(points), 1)))


def test_linear_areas_are_those_of_uniform_pressure():
    """A quarter of each square, by hand: corners 1, edges 2, the middle 4."""
    points = np.array([[x, y, 0.0] for x in range(3) for y in range(3)], dtype=float)
    grid = np.arange(9).reshape(3, 3)
    faces = np.stack(
        [one.ravel() for one in (grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:])],
        axis=1,
    )
    np.testing.assert_allclose(4 * flat([faces], points).areas, [1, 2, 1, 2, 4, 2, 1, 2, 1])


def test_a_curved_quadratic_surface_has_its_area():
    """A quarter of a cylinder of radius 1 and length 1: pi / 2, to the error of its elements."""
    errors = []
    for count in (4, 8):
        angle = np.linspace(0.0, np.pi / 2, 2 * count + 1)
        ring = np.column_stack([np.cos(angle), np.sin(angle)])
        points = np.array([[*ring[i], z] for z in (0.0, 0.5, 1.0) for i in range(len(ring))])
        at = np.arange(len(points)).reshape(3, -1)
        lines = [
            [
                *(at[0, i], at[0, i + 2], at[2, i + 2], at[2, i]),
                *(at[0, i + 1], at[1, i + 2], at[2, i + 1], at[1, i]),
            ]
            for i in range(0, 2 * count, 2)
        ]
        surface = flat([np.array(lines)], points)
        errors.append(abs(surface.area - np.pi / 2))
        radial = surface.points * [1.0, 1.0, 0.0]
        cosine = np.einsum("ni,ni->n", surface.normals, radial)
        inner = (radial[:, :2] > 1e-9).all(axis=1)  # at the ends faces lie on one side only
        np.testing.assert_allclose(cosine[inner], 1.0, rtol=0, atol=1e-12)
        assert (cosine > 0.99).all()
    assert errors[1] < errors[0] / 12.0
    assert errors[1] < 1e-5


@pytest.mark.parametrize("width", [1.0, 1.5])
def test_shells_that_are_numbered_in_opposite_senses_are_refused(width):
    """Of unequal areas their normals do not cancel, and one would be that of the wrong side."""
    corners = [[0, 0], [1, 0], [1, 1], [0, 1], [1 + width, 0], [1 + width, 1]]
    points = np.column_stack([corners, np.zeros(6)])
    faces = np.array([[0, 1, 2, 3], [1, 4, 5, 2]])
    np.testing.assert_array_equal(flat([faces], points).normals, [[0.0, 0.0, 1.0]] * 6)
    opposite = flat([faces[:1], turned(faces[1:])], points)
    assert opposite.area == pytest.approx(1.0 + width)
    with pytest.raises(ModelError, match="the edge of nodes 2 and 3 are numbered in opposite"):
        _ = opposite.normals
