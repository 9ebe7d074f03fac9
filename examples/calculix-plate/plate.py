"""From a CalculiX deck to the response with a damper.

    apt install calculix-ccx
    python examples/calculix-plate/plate.py

runs ccx on plate.inp in a folder of its own, reads the matrices it writes, reduces them, adds a
friction damper, and prints the peak over the slip force of the damper.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

import stickslip as ss

DECK = Path(__file__).resolve().parent / "plate.inp"
TIP, DAMPER = "101.3", "141.3"  # node.direction: a corner of the free end, a quarter up


def matrices(folder: Path) -> tuple[object, object, tuple[str, ...]]:
    """Run CalculiX and return mass, stiffness and the names of their rows."""
    ccx = shutil.which("ccx")
    if ccx is None:
        sys.exit("ccx is not installed: apt install calculix-ccx")
    shutil.copy(DECK, folder)
    subprocess.run([ccx, DECK.stem], cwd=folder, check=True, capture_output=True)
    mass, stiffness = (
        ss.read_matrix(folder / f"plate{end}", sparse=True) for end in (".mas", ".sti")
    )
    return mass, stiffness, ss.read_dofs(folder / "plate.dof")


def main() -> dict[float, float]:
    """Return the peak of the tip [m] by slip force [N]."""
    with tempfile.TemporaryDirectory() as folder:
        mass, stiffness, dofs = matrices(Path(folder))
    reduced = ss.craig_bampton(mass, stiffness, {"damper": DAMPER, "tip": TIP}, modes=10, dofs=dofs)
    print(reduced.report(5))
    plate = reduced.structure(ss.ModalDamping(0.001))
    low, high = 0.9, 1.2
    peaks = {}
    for slip_force in (0.0, 0.1, 1.0, 10.0, np.inf):
        damper = ss.Jenkins("damper", stiffness=1e6, slip_force=slip_force)
        model = ss.Model(plate, [damper], [ss.Force("tip", 0.1)])
        free = ss.natural_frequencies(model, slipping=[0])[0]
        stuck = ss.natural_frequencies(model)[0]
        response = ss.forced_response(model, omega=(low * free, high * stuck), harmonics=15)
        peaks[slip_force] = response.peak("tip").amplitude
        print(f"slip force {slip_force:6g} N: peak of the tip {peaks[slip_force]:.4e} m")
    return peaks


if __name__ == "__main__":
    main()
