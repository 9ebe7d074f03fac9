"""The finite-element step: mesh, matrices, 18 component modes, and what they are checked against.

    python examples/turbine-blade/reduce.py

writes the model that the package ships, the report of the checks (report.json, report.md) and a
picture of mesh and mode shapes. With all checks it takes some minutes and 7 GB; `--coarse` a few
seconds, and writes into the current folder only.
"""

from __future__ import annotations

import json
import os
import resource
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from blade import Blade
from scipy.sparse import csc_array
from scipy.sparse.linalg import LinearOperator, gmres

import stickslip as ss
from stickslip.fe.sparse import Factor

HERE = Path(__file__).resolve().parent
SHIPPED = HERE.parents[1] / "python" / "stickslip" / "data" / "turbine_blade.npz"
PICTURE = HERE.parents[1] / "docs" / "assets" / "turbine-blade-modes.png"
DAMPER_STIFFNESS = 1e6  # [N/m]
RATIO, FIRST, LAST = 5e-4, 1600.0, 47000.0  # damping ratio at two frequencies [rad/s]
DAMPING = ss.Rayleigh(
    mass=2.0 * RATIO * FIRST * LAST / (FIRST + LAST), stiffness=2.0 * RATIO / (FIRST + LAST)
)
COARSE = {"along": 8, "through": 2, "up": (1, 4, 1, 12), "beside": (1, 2)}


@dataclass(frozen=True)
class Model:
    """The blade, clamped: its elements, free degrees of freedom, load and reduction."""

    blade: Blade
    solid: ss.Solid
    free: np.ndarray
    load: np.ndarray
    reduction: ss.Reduction

    @classmethod
    def of(cls, blade: Blade) -> Model:
        """Mesh, assemble, clamp and reduce."""
        solid = blade.solid()
        held = (3 * blade.clamped(solid)[:, None] + np.arange(3)).ravel()
        free = np.setdiff1d(np.arange(len(solid.dofs)), held)
        names = [solid.dofs[dof] for dof in free]
        boundary = {  # across the blade row, in which the damper rubs and the tip bends
            "damper": solid.dofs[3 * blade.damper(solid) + 1],
            "tip": solid.dofs[3 * blade.tip(solid) + 1],
        }
        matrices = solid.mass[free][:, free], solid.stiffness[free][:, free]
        reduction = ss.craig_bampton(*matrices, boundary, modes=16, dofs=names)
        return cls(blade, solid, free, blade.pressure(solid)[free], reduction)

    def everywhere(self, moved: np.ndarray) -> np.ndarray:
        """Return a motion of the free degrees of freedom with zeros where the root is clamped."""
        whole = np.zeros(len(self.solid.dofs), np.asarray(moved).dtype)
        whole[self.free] = moved
        return whole

    def save(self, path: Path) -> None:
        """Write the reduced matrices and forces."""
        forces = {force.dof: force.amplitude for force in self.reduction.forces(self.load)}
        np.savez_compressed(
            path,
            mass=self.reduction.mass,
            stiffness=self.reduction.stiffness,
            force=[forces.get(dof, 0.0) for dof in self.reduction.dofs],
        )


def response_errors(model: Model, omegas: np.ndarray) -> list[dict[str, object]]:
    """Compare linear responses, damper stuck, with direct solutions of the full structure."""
    reduction = model.reduction
    place = reduction.rows[reduction.boundary.index("damper")]
    spring = csc_array(([DAMPER_STIFFNESS], ([place], [place])), reduction.full_mass.shape)
    K, M = reduction.full_stiffness, reduction.full_mass
    C = DAMPING.mass * M + DAMPING.stiffness * K
    small = reduction.structure(DAMPING)
    stuck = small.stiffness.copy()
    stuck[0, 0] += DAMPER_STIFFNESS
    force = {one.dof: one.amplitude for one in reduction.forces(model.load)}
    work = np.array([force.get(dof, 0.0) for dof in reduction.dofs])
    errors = []
    for omega in omegas:
        dynamic = (K + spring + 1j * omega * C - omega**2 * M).tocsc()
        # The undamped matrix D is factored, in half the memory; GMRES adds the damping to it, as
        # (1 + i omega D^-1 C) x = D^-1 f.
        factor = Factor((K + spring - omega**2 * M).tocsc())

        def damped(x: np.ndarray, factor: Factor = factor, omega: float = omega) -> np.ndarray:
            force = omega * (C @ x)
            return x + 1j * (factor.solve(force.real) + 1j * factor.solve(force.imag))

        operator = LinearOperator(dynamic.shape, damped, dtype=complex)
        start = factor.solve(model.load).astype(complex)
        full, info = gmres(operator, start, rtol=1e-9, restart=40, maxiter=2)
        if info:
            raise RuntimeError(f"no solution of the full structure at {omega:.6g} rad/s")
        residual = np.linalg.norm(dynamic @ full - model.load) / np.linalg.norm(model.load)
        own = np.linalg.solve(stuck + 1j * omega * small.damping - omega**2 * small.mass, work)
        for dof, row, value in zip(reduction.boundary, reduction.rows, own, strict=False):
            errors.append(
                {
                    "omega": float(omega),
                    "dof": dof,
                    "full": abs(full[row]),
                    "reduced": abs(value),
                    "error": abs(value - full[row]) / abs(full[row]),
                    "residual": float(residual),
                }
            )
        print(f"direct solution at {omega:.6g} rad/s: error {errors[-1]['error']:.1e}", flush=True)
    return errors


def picture(model: Model, path: Path) -> None:
    """Draw the mesh and three mode shapes."""
    from matplotlib import pyplot
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection
    from scipy.linalg import eigh

    mesh, reduction = model.solid.mesh, model.reduction
    faces = mesh.facets[:, mesh.boundary_facets()].T
    # scikit-fem numbers the corners of a face crosswise
    middle = mesh.p[:, faces].transpose(1, 2, 0)
    turn = middle - middle.mean(axis=1, keepdims=True)
    along = turn[:, 0] / np.linalg.norm(turn[:, 0], axis=1)[:, None]
    normal = np.cross(turn[:, 0], turn[:, 1])
    across = np.cross(normal / np.linalg.norm(normal, axis=1)[:, None], along)
    angle = np.arctan2((turn * across[:, None]).sum(-1), (turn * along[:, None]).sum(-1))
    faces = np.take_along_axis(faces, angle.argsort(axis=1), axis=1)
    squares, shapes = eigh(reduction.stiffness, reduction.mass)
    figure = pyplot.figure(figsize=(10, 6))
    for place, mode in enumerate((None, 0, 1, 2)):
        # Axes in 3D draw into a square; these overlap, and are transparent.
        axes = figure.add_axes((0.25 * place - 0.155, 0.0, 0.56, 0.94), projection="3d")
        points, colour = mesh.p.T, np.zeros(mesh.p.shape[1])
        title = f"{len(model.free):,} free DOFs"
        if mode is not None:
            moved = model.everywhere(reduction.recover(shapes[:, mode])).reshape(-1, 3)
            moved = moved[: len(points)] / np.abs(moved).max()
            points, colour = points + 0.02 * moved, np.linalg.norm(moved, axis=1)
            title = f"mode {mode + 1}, {np.sqrt(squares[mode]) / (2 * np.pi):.0f} Hz"
        shade = pyplot.get_cmap("viridis")(colour[faces].mean(axis=1) / max(colour.max(), 1e-9))
        fill = shade if mode is not None else "0.85"
        axes.add_collection3d(
            Poly3DCollection(points[faces], facecolors=fill, edgecolors="0.3", linewidths=0.12)
        )
        low, high = mesh.p.min(axis=1), mesh.p.max(axis=1)
        centre, half = 0.5 * (low + high), 0.5 * (high - low).max()
        for axis, mid, reach in zip("xyz", centre, (0.4 * half, 0.4 * half, half), strict=True):
            getattr(axes, f"set_{axis}lim")(mid - reach, mid + reach)
        axes.set_box_aspect((0.4, 0.4, 1.0), zoom=1.0)
        axes.view_init(18, -62)
        axes.set_axis_off()
        axes.patch.set_alpha(0.0)
        figure.text(0.25 * place + 0.125, 0.95, title, ha="center")
    figure.savefig(path, dpi=110)
    pyplot.close(figure)


def main(coarse: bool = False) -> dict[str, object]:
    """Make the model, check it, write everything."""
    started, busy = time.perf_counter(), time.process_time()
    model = Model.of(Blade(**COARSE) if coarse else Blade())
    reduced_after, processor = time.perf_counter() - started, time.process_time() - busy
    reduction = model.reduction
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
    print(f"{reduction}, {reduced_after:.1f} s, {memory:.1f} GB with mesh and assembly", flush=True)
    reports = {
        "free": reduction.report(10),
        "stuck": reduction.report(10, {"damper": DAMPER_STIFFNESS}),
    }
    first, second = reports["stuck"].full[:2]
    # Beside the peaks, on flanks where a wrong frequency shows most: at a peak D is singular.
    beside = 1.0 + RATIO
    fifth = reports["stuck"].full[4]
    omegas = np.array([0.5 * first, beside * first, 1.3 * first, beside * second, 1.01 * fifth])
    errors = response_errors(model, omegas)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
    summary: dict[str, object] = {
        "dofs": reduction.size,
        "reduced": len(reduction.dofs),
        "seconds_to_reduce": round(reduced_after, 1),
        "processor_seconds_to_reduce": round(processor, 1),
        "seconds_with_checks": round(time.perf_counter() - started, 1),
        "cores_busy_with_others": round(os.getloadavg()[1], 1),
        "memory_to_reduce_gb": round(memory, 2),
        "peak_memory_gb": round(peak, 2),
        "largest_frequency_error": {
            state: float(np.nanmax(report.errors)) for state, report in reports.items()
        },
        "frequencies_hz": {
            state: (report.full / (2.0 * np.pi)).round(4).tolist()
            for state, report in reports.items()
        },
        "largest_response_error": max(float(str(one["error"])) for one in errors),
        "responses": errors,
    }
    target = Path.cwd() if coarse else HERE
    model.save(target / "blade.npz")
    if not coarse:
        model.save(SHIPPED)
    (target / "report.json").write_text(json.dumps(summary, indent=1) + "\n")
    parts = [f"## Damper {state}\n\n```text\n{report}\n```" for state, report in reports.items()]
    lines = ["rad/s      dof      full [m]       reduced [m]    error      residual"]
    lines += [
        f"{one['omega']:<10.6g} {one['dof']:<8} {one['full']:<14.6e} {one['reduced']:<14.6e} "
        f"{one['error']:<10.1e} {one['residual']:.1e}"
        for one in errors
    ]
    parts.append("## Responses, damper stuck\n\n```text\n" + "\n".join(lines) + "\n```")
    head = (
        "# The reduction of the blade, checked\n\n"
        f"Written by reduce.py: {reduction.size} free DOFs reduced in {reduced_after:.0f} s "
        f"({processor:.0f} s of processor time) and {memory:.1f} GB, mesh and assembly included; "
        f"{peak:.1f} GB at most with the direct solutions."
    )
    (target / "report.md").write_text("\n\n".join([head, *parts]) + "\n")
    picture(model, target / "modes.png" if coarse else PICTURE)
    return summary


if __name__ == "__main__":
    main("--coarse" in sys.argv[1:])
