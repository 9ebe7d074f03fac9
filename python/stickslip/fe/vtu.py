"""Meshes and fields on them in files for ParaView."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.checks import brief, file_path, optional_package
from stickslip.errors import ModelError
from stickslip.files import write


def write_vtu(
    path: str | os.PathLike[str],
    nodes: NDArray[np.float64],
    cells: Sequence[tuple[str, NDArray[np.int64]]],
    fields: Mapping[str, ArrayLike],
) -> None:
    """Write nodes, elements and nodal fields for ParaView; see `Mesh.write_vtu`."""
    file = file_path(path, "path")
    meshio = optional_package("meshio", f"{file}: .vtu files")
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
        cause = error.strerror or str(error) or type(error).__name__
        raise ModelError(
            f"{file}: meshio needs a folder for temporary files, which fails ({cause}); make room "
            "there, or name another in the variable TMPDIR"
        ) from error
    write(file, content)
