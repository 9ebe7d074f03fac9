"""A twisted turbine blade with platform and root, in parameters: geometry, mesh, load, names.

One grid (i, j, k) of hexahedra holds everything: i along the chord, j through the thickness, k up
the span. The column of the airfoil runs from the root to the tip; root and platform are cells
around it. `python reduce.py` makes the model that the package ships.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from skfem import MeshHex

from stickslip.fe import Solid

YOUNG, POISSON, DENSITY = 200e9, 0.29, 8220.0  # nickel alloy 718 [Pa, -, kg/m^3]


@dataclass(frozen=True)
class Blade:
    """Sizes in m, angles in rad; cells along the chord, through the thickness and up each part."""

    span: float = 0.110
    chord: float = 0.040
    tip_chord: float = 0.032
    thickness: float = 0.0055
    tip_thickness: float = 0.0028
    camber: float = 0.0035
    stagger: float = np.deg2rad(18.0)
    twist: float = np.deg2rad(32.0)
    platform: tuple[float, float, float] = (0.052, 0.030, 0.005)
    shank: tuple[float, float, float] = (0.040, 0.005, 0.035)
    root: tuple[float, float, float] = (0.040, 0.020, 0.014)
    along: int = 18
    through: int = 3
    up: tuple[int, int, int, int] = (4, 8, 2, 40)  # root, shank, platform, airfoil
    beside: tuple[int, int] = (2, 4)  # cells of the platform before and beside the airfoil

    def solid(self) -> Solid:
        """Return the elements."""
        return Solid(self._mesh(), YOUNG, POISSON, DENSITY)

    def clamped(self, solid: Solid) -> np.ndarray:
        """Return the nodes of the root's flanks and bottom, which the disk holds."""
        _, y, z = solid.nodes.T
        bottom = -(self.platform[2] + self.shank[2] + self.root[2])
        flank = (np.abs(np.abs(y) - 0.5 * self.root[1]) < 1e-9) & (z < bottom + self.root[2])
        return np.flatnonzero(flank | (z < bottom + 1e-9))

    def damper(self, solid: Solid) -> int:
        """Return the node under the platform where the damper rubs."""
        _, y, z = self.platform
        return solid.nearest((0.0, 0.5 * y, -z))

    def tip(self, solid: Solid) -> int:
        """Return the node at the trailing edge of the tip."""
        points = self._points()
        return solid.nearest(points[-self.beside[0] - 1, self._core(1)[0], -1])

    def pressure(self, solid: Solid) -> np.ndarray:
        """Return the forces of a pressure on the airfoil: 100 Pa at the tip, 0 at the foot."""
        grid = self._grid()
        i, j = self._core(0), self._core(1)
        foot = sum(self.up[:3])
        side = grid[i[0] : i[-1] + 1, j[0], foot:].ravel()

        def traction(x: np.ndarray) -> np.ndarray:
            angle = self.stagger + self.twist * np.clip(x[2] / self.span, 0.0, 1.0)
            push = 100.0 * np.clip(x[2] / self.span, 0.0, 1.0)
            return np.array([-np.sin(angle) * push, np.cos(angle) * push, 0.0 * push])

        return solid.load(traction, side[side >= 0])

    def _core(self, way: int) -> range:
        """Grid lines of the airfoil's column along the chord (0) or through the thickness (1)."""
        count = (self.along, self.through)[way]
        return range(self.beside[way], self.beside[way] + count + 1)

    def _heights(self) -> np.ndarray:
        depth = np.cumsum([0.0, self.platform[2], self.shank[2], self.root[2]])[::-1]
        levels = [*-depth, self.span]
        parts = [
            np.linspace(a, b, n + 1)[1:]
            for a, b, n in zip(levels[:-1], levels[1:], self.up, strict=True)
        ]
        return np.concatenate([[levels[0]], *parts])

    def _filled(self) -> np.ndarray:
        """Return which cells of the grid are metal."""
        cells = (self.along + 2 * self.beside[0], self.through + 2 * self.beside[1], sum(self.up))
        filled = np.zeros(cells, bool)
        i, j = self._core(0), self._core(1)
        filled[i[0] : i[-1], j[0] : j[-1]] = True
        root, shank, platform, _ = np.cumsum(self.up)
        filled[i[0] : i[-1], :, :root] = True
        filled[:, :, shank:platform] = True
        return filled

    def _section(self, z: float) -> tuple[np.ndarray, np.ndarray]:
        """Return x and y of the column's grid at a height, shape (along + 1, through + 1)."""
        xi = -np.cos(np.linspace(0.25, np.pi - 0.25, self.along + 1))
        xi /= xi[-1]
        eta = np.linspace(-1.0, 1.0, self.through + 1)
        part = np.clip(z / self.span, 0.0, 1.0)
        chord = self.chord + part * (self.tip_chord - self.chord)
        thick = self.thickness + part * (self.tip_thickness - self.thickness)
        half = 0.5 * thick * (0.22 + 0.78 * (1.0 - xi**2))
        x = np.tile(0.5 * chord * xi[:, None], eta.size)
        y = self.camber * (1.0 - xi[:, None] ** 2) + half[:, None] * eta
        angle = self.stagger + self.twist * part
        x, y = np.cos(angle) * x - np.sin(angle) * y, np.sin(angle) * x + np.cos(angle) * y
        # Through the platform the airfoil goes over into the plate of the shank.
        over = np.clip(-z / self.platform[2], 0.0, 1.0)
        plate = 0.5 * self.shank[0] * np.linspace(-1.0, 1.0, self.along + 1)
        wide = 0.5 * self.shank[1]
        return (
            (1.0 - over) * x + over * plate[:, None] * np.ones_like(eta),
            (1.0 - over) * y + over * wide * eta * np.ones((self.along + 1, 1)),
        )

    def _points(self) -> np.ndarray:
        """Return the places of all grid points, shape (i, j, k, 3); those of no cell included."""
        before, beside = self.beside
        heights = self._heights()
        size = (self.along + 2 * before + 1, self.through + 2 * beside + 1, heights.size)
        points = np.zeros((*size, 3))
        outer_x, outer_y = np.arange(1, before + 1) / before, np.arange(1, beside + 1) / beside
        top = -self.platform[2] - self.shank[2]
        for k, z in enumerate(heights):
            x, y = self._section(z)
            wide = self.root[1] if z < top - 1e-9 else self.platform[1]
            if abs(z - top) < 1e-9:
                wide = self.root[1]
            edge_x, edge_y = 0.5 * self.platform[0], 0.5 * wide
            low = y[:, :1] + outer_y[::-1] * (-edge_y - y[:, :1])
            high = y[:, -1:] + outer_y * (edge_y - y[:, -1:])
            y = np.hstack([low, y, high])
            x = np.hstack([np.tile(x[:, :1], beside), x, np.tile(x[:, -1:], beside)])
            first = x[:1] + outer_x[::-1, None] * (-edge_x - x[:1])
            last = x[-1:] + outer_x[:, None] * (edge_x - x[-1:])
            flat = np.linspace(-edge_y, edge_y, y.shape[1])
            shift = outer_x[:, None] * (flat - y[-1]) + y[-1]
            y = np.vstack([(outer_x[:, None] * (flat - y[0]) + y[0])[::-1], y, shift])
            x = np.vstack([first, x, last])
            points[:, :, k] = np.stack([x, y, np.full_like(x, z)], axis=-1)
        return points

    def _grid(self) -> np.ndarray:
        """Return the vertex at each grid point, -1 where no cell touches it."""
        filled = self._filled()
        used = np.zeros(np.array(filled.shape) + 1, bool)
        for corner in np.ndindex(2, 2, 2):
            window = tuple(slice(c, c + n) for c, n in zip(corner, filled.shape, strict=True))
            used[window] |= filled
        grid = np.full(used.shape, -1)
        grid[used] = np.arange(used.sum())
        return grid

    def _mesh(self) -> MeshHex:
        grid, cells = self._grid(), np.argwhere(self._filled())
        corners = MeshHex.elem.doflocs.astype(int)  # the element's own order of its vertices
        vertices = np.array([grid[tuple((cells + corner).T)] for corner in corners])
        return MeshHex(np.ascontiguousarray(self._points()[grid >= 0].T), vertices)
