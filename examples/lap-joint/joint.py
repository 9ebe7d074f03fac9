"""From a CalculiX deck of a lap joint to the slip in its interface.

    python examples/lap-joint/joint.py [elements along the overlap, default 4] [picture.png]

writes joint.inp, two plates that overlap, reads it as any other deck, pairs the nodes of the two
faces, reduces the plates to the displacements between them and a few modes, presses them together,
bends the joint by rising forces, and shakes it around its first resonance. The matrices are those
of CalculiX where it is installed; where it is not, the package's own, which are the same to twelve
digits.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import skfem

import stickslip as ss

LENGTH, OVERLAP, WIDTH, THICKNESS = 0.10, 0.04, 0.02, 0.006  # m
STEEL = (210e9, 0.3, 7850.0)  # Pa, -, kg/m3
CLAMPING = 4e3  # N, spread over the overlap from both sides
FRICTION, K_T, K_N = 0.3, 2e12, 4e12  # -, N/m3, N/m3
LEVELS = (200.0, 400.0, 800.0)  # N, across the plates in the middle of the overlap
SHAKEN = 20.0  # N, the same way, at the frequencies of the curve
CURVE = np.linspace(0.90, 1.02, 13)  # over the first natural frequency of the stuck joint
CENTRE = np.array([LENGTH - OVERLAP / 2, WIDTH / 2])


def solid(size: int) -> ss.Solid:
    """Return both plates as one model: nodes on the two faces are at the same places."""
    long = round(size * (LENGTH - OVERLAP) / OVERLAP)
    across = np.linspace(0.0, WIDTH, max(size // 2, 1) + 1)
    overlap = np.linspace(LENGTH - OVERLAP, LENGTH, size + 1)
    lower_x = np.concatenate([np.linspace(0.0, LENGTH - OVERLAP, long + 1)[:-1], overlap])
    upper_x = 2 * LENGTH - OVERLAP - lower_x[::-1]
    lower, upper = (
        skfem.MeshHex.init_tensor(x, across, z)
        for x, z in (
            (lower_x, np.linspace(-THICKNESS, 0.0, 2)),
            (upper_x, np.linspace(0.0, THICKNESS, 2)),
        )
    )
    # Side by side, not merged: the faces keep nodes of their own.
    points = np.hstack([lower.p, upper.p])
    mesh = skfem.MeshHex(points, np.hstack([lower.t, upper.t + lower.p.shape[1]]))
    return ss.Solid(mesh, *STEEL)


def write_deck(model: ss.Solid, deck: Path) -> None:
    """Write what a preprocessor would: nodes, elements, surfaces, supports, and the step."""
    x, _, z = model.nodes.T
    body = np.zeros(len(x), dtype=bool)  # True: the upper plate
    upper = model.nodes[model.elements].mean(axis=1)[:, 2] > 0.0
    body[model.elements[upper].ravel()] = True
    near = 1e-9
    inside = (x > LENGTH - OVERLAP - near) & (x < LENGTH + near) & (abs(z) < near)
    sets = {
        "FOOT": ~body & inside,
        "PAD": body & inside,
        "ENDS": (x < near) | (x > 2 * LENGTH - OVERLAP - near),
        "TOP": body & (z > THICKNESS - near),
        "BOTTOM": ~body & (z < near - THICKNESS),
    }
    lines = ["*NODE"]
    lines += [f"{n}, {a!r}, {b!r}, {c!r}" for n, (a, b, c) in enumerate(model.nodes.tolist(), 1)]
    lines.append("*ELEMENT, TYPE=C3D20, ELSET=PLATES")
    for number, nodes in enumerate((model.elements + 1).tolist(), 1):
        words = [str(one) for one in (number, *nodes)]
        lines += [", ".join(words[:11]) + ",", ", ".join(words[11:])]
    for name, among in sets.items():
        members = np.flatnonzero(among) + 1
        lines.append(f"*NSET, NSET={name}")
        lines += [
            ", ".join(map(str, members[start : start + 12])) for start in range(0, len(members), 12)
        ]
    young, poisson, density = STEEL
    lines += ["*MATERIAL, NAME=STEEL", "*ELASTIC", f"{young}, {poisson}", "*DENSITY", f"{density}"]
    lines += ["*SOLID SECTION, ELSET=PLATES, MATERIAL=STEEL", "*BOUNDARY", "ENDS, 1, 3"]
    lines += ["*STEP", "*FREQUENCY, SOLVER=MATRIXSTORAGE", "*END STEP", ""]
    deck.write_text("\n".join(lines))


def matrices(model: ss.Solid, mesh: ss.Mesh, deck: Path) -> tuple[object, object, list[str]]:
    """Return mass, stiffness and the names of their rows, without the clamped ends."""
    ccx = shutil.which("ccx")
    if ccx is not None:
        subprocess.run([ccx, deck.stem], cwd=deck.parent, check=True, capture_output=True)
        mass, stiffness = (
            ss.read_matrix(deck.with_suffix(end), sparse=True) for end in (".mas", ".sti")
        )
        return mass, stiffness, list(ss.read_dofs(deck.with_suffix(".dof")))
    held = set(mesh.numbers[mesh.node_sets["ENDS"]].tolist())
    free = [row for row in range(3 * len(mesh.numbers)) if row // 3 + 1 not in held]
    mass, stiffness = (one[free][:, free] for one in (model.mass, model.stiffness))
    return mass, stiffness, [model.dofs[row] for row in free]


def clamping(mesh: ss.Mesh, dofs: list[str]) -> np.ndarray:
    """Return the load that presses both plates together, shape (N,) [N]."""
    load = dict.fromkeys(dofs, 0.0)
    for part, sign in (("TOP", -1.0), ("BOTTOM", 1.0)):
        side = mesh.surface(part)
        x = side.points[:, 0]
        shares = side.areas * ((x > LENGTH - OVERLAP - 1e-9) & (x < LENGTH + 1e-9))
        for node, share in zip(side.labels, shares / shares.sum(), strict=True):
            if f"{node}.3" in load:
                load[f"{node}.3"] += sign * CLAMPING * share
    return np.array(list(load.values()))


def joint(size: int) -> tuple[ss.ContactInterface, ss.Structure, list[ss.Force]]:
    """Return interface, reduced structure, and what the bolt does to it."""
    model = solid(size)
    with tempfile.TemporaryDirectory() as folder:
        deck = Path(folder) / "joint.inp"
        write_deck(model, deck)
        mesh = ss.read_mesh(deck)
        mass, stiffness, dofs = matrices(model, mesh, deck)
    interface = ss.ContactInterface.from_surfaces(mesh, "PAD", mesh, "FOOT")
    # Displacements between the plates instead of those of both: half as many are kept.
    mass, stiffness, bolt = (
        interface.relative(one, dofs) for one in (mass, stiffness, clamping(mesh, dofs))
    )
    top = mesh.surface("TOP")
    middle = top.labels[np.hypot(*(top.points[:, :2] - CENTRE).T).argmin()]
    kept = {dof: dof for dof in interface.first_dofs} | {"middle": f"{middle}.3"}
    reduced = ss.craig_bampton(mass, stiffness, kept, modes=20, dofs=dofs)
    return (
        interface,
        reduced.structure(ss.Rayleigh(mass=20.0, stiffness=2e-7)),
        reduced.forces(bolt, harmonic=0),
    )


def shaken(
    plates: ss.Structure,
    touching: ss.Coulomb,
    bolt: list[ss.Force],
    interface: ss.ContactInterface,
    curve: np.ndarray = CURVE,
) -> tuple[ss.ForcedResponse, np.ndarray]:
    """Return the response under the bolt's load, and the area that slips at each frequency [m2]."""
    model = ss.Model(plates, [touching], [*bolt, ss.Force("middle", SHAKEN)])
    lowest = ss.natural_frequencies(model)[0]
    response = ss.forced_response(
        model, curve * lowest, harmonics=3, observe=["middle"], stability=False
    )
    return response, ss.slip_area(interface, response)


def main(size: int = 4, picture: str | None = None, curve: np.ndarray = CURVE) -> dict[str, object]:
    """Return what the example's test asserts."""
    clock = time.perf_counter()
    interface, plates, bolt = joint(size)
    laws = {"friction": FRICTION, "tangential_stiffness": K_T, "normal_stiffness": K_N}
    touching = interface.contact(**laws, relative=True)
    at_rest = ss.static_response(ss.Model(plates, [touching], bolt))
    pressed = ss.ContactMap.of(interface, at_rest)
    print(interface)
    print(
        f"at rest: {pressed.normal_force:.1f} N on {interface.area * 1e4:.2f} cm2, "
        f"{pressed.open_area * 1e4:.2f} cm2 open; {time.perf_counter() - clock:.1f} s"
    )
    found = {"force": pressed.normal_force, "open": pressed.open_area, "slip": {}}
    for level in LEVELS:
        model = ss.Model(plates, [touching], [*bolt, ss.Force("middle", level, harmonic=0)])
        clock = time.perf_counter()
        bent = ss.static_response(model)
        seen = ss.ContactMap.of(interface, bent)
        print(f"{level:5.0f} N: {bent.status}, {seen}; {time.perf_counter() - clock:.1f} s")
        found["slip"][level] = seen.slip_area
    clock = time.perf_counter()
    response, slips = shaken(plates, touching, bolt, interface, curve)
    spent = time.perf_counter() - clock
    amplitude = response.amplitude("middle")
    print(f"{SHAKEN:.0f} N shaking, {len(curve)} frequencies in {spent:.1f} s:")
    for omega, height, area, status in zip(
        response.omega, amplitude, slips, response.status, strict=True
    ):
        print(f"{omega:8.1f} rad/s: {height:.4e} m, {area * 1e4:.2f} cm2 slip, {status}")
    found |= {"status": response.status, "amplitude": amplitude, "shaken_slip": slips}
    if picture is not None:
        seen.plot(field="slip").figure.savefig(picture, dpi=150)
        seen.write_vtu(Path(picture).with_suffix(".vtu"))
    return found


if __name__ == "__main__":
    main(*(int(one) for one in sys.argv[1:2]), *sys.argv[2:3])
