"""Models in NetCDF files: matrices as variables, everything else as JSON texts."""

from __future__ import annotations

import json
from collections.abc import Callable, Hashable, Iterable, Mapping
from typing import Any, TypeAlias

import numpy as np

from stickslip.disk import BladedDisk, Interface, MistunedDisk
from stickslip.model import Model
from stickslip.model.coupling import coupling_from_spec
from stickslip.model.force import force_from_spec
from stickslip.model.laws import contact_from_spec, law_from_spec
from stickslip.model.structure import Structure
from stickslip.results.dataset import Stored, labels
from stickslip.results.fields import Float

_MATRICES = {
    "mass": ("kg", "mass matrix"),
    "damping": ("kg/s", "damping matrix"),
    "stiffness": ("N/m", "stiffness matrix"),
}


def model_variables(model: Model) -> Mapping[Hashable, object]:
    """Return a model as variables of a dataset.

    Of a `BladedDisk` the matrices are those of a sector; of a `MistunedDisk` those of all sectors
    are added.
    """
    kind = type(model).__name__
    return {"model": ((), kind, {"long_name": "kind of model"}), **_KINDS[kind][0](model)}


def model_of(dataset: Stored) -> Model:
    """Return the model that a dataset holds; see `model_variables`."""
    # The first files held no other kind and did not say so.
    kind = str(dataset["model"].values) if "model" in dataset else "Model"
    return _KINDS[kind][1](dataset)


def _model(model: Model) -> dict[Hashable, object]:
    return _structure_variables(model.structure) | part_variables(model)


def _bladed(model: Any) -> dict[Hashable, object]:
    disk: BladedDisk = model
    settings = {
        "sectors": disk.sectors,
        "engine_order": disk.engine_order,
        "engine_orders": {str(k): order for k, order in disk.engine_orders.items()},
    }
    couplings = [coupling.to_spec() for coupling in disk.couplings]
    variables = _model(disk) | _texts("disk", [settings]) | _texts("couplings", couplings)
    if disk.interface is not None:
        for name, (unit, meaning) in _MATRICES.items():
            said = {"units": unit, "long_name": f"block of the {meaning} to the next sector"}
            block = getattr(disk.interface, name)
            variables[f"interface_{name}"] = (("row", "column"), block, said)
    return variables


def _read_bladed(dataset: Stored, prefix: str = "") -> BladedDisk:
    contacts, forces = parts_of(dataset, prefix)
    settings = _read_texts(dataset, "disk")[0]
    interface = None
    if "interface_stiffness" in dataset:
        blocks = ("stiffness", "mass", "damping")
        interface = Interface(*(_real(dataset, f"interface_{name}") for name in blocks))
    return BladedDisk(
        _structure(dataset),
        settings["sectors"],
        [coupling_from_spec(spec) for spec in _read_texts(dataset, "couplings")],
        contacts,
        forces,
        engine_order=settings["engine_order"],
        engine_orders={int(k): order for k, order in settings["engine_orders"].items()},
        interface=interface,
    )


def _mistuned(model: Any) -> dict[Hashable, object]:
    mistuned: MistunedDisk = model
    variables = _bladed(mistuned.disk)
    variables |= part_variables(mistuned.disk, "sector_") | part_variables(mistuned)
    for name, (unit, meaning) in _MATRICES.items():
        said = {"units": unit, "long_name": f"{meaning} of each sector by itself"}
        stack = np.stack([getattr(blade, name) for blade in mistuned.blades])
        variables[f"blade_{name}"] = (("blade", "row", "column"), stack, said)
    said = {"units": "1", "long_name": "damping of each sector known to couple no modes"}
    known = np.array([blade.proportional for blade in mistuned.blades], dtype=np.int8)
    variables["blade_proportional"] = ("blade", known, said)
    return variables


def _read_mistuned(dataset: Stored) -> MistunedDisk:
    disk = _read_bladed(dataset, "sector_")
    stacks = [_real(dataset, f"blade_{name}") for name in ("mass", "stiffness", "damping")]
    known = np.zeros(disk.sectors)
    if "blade_proportional" in dataset:  # files of version 0.1 have none
        known = dataset["blade_proportional"].values
    blades = [
        Structure.of_law(m, k, c, disk.structure.dofs, None, bool(proportional)).made_of(
            disk.structure
        )
        for m, k, c, proportional in zip(*stacks, known, strict=True)
    ]
    return MistunedDisk(disk, blades, *parts_of(dataset))


_Writer: TypeAlias = Callable[[Any], Mapping[Hashable, object]]
_KINDS: Mapping[str, tuple[_Writer, Callable[[Stored], Model]]] = {
    "Model": (_model, lambda dataset: Model(_structure(dataset), *parts_of(dataset))),
    "BladedDisk": (_bladed, _read_bladed),
    "MistunedDisk": (_mistuned, _read_mistuned),
}


def _structure_variables(structure: Structure) -> dict[Hashable, object]:
    variables: dict[Hashable, object] = {
        name: (("row", "column"), getattr(structure, name), {"units": unit, "long_name": meaning})
        for name, (unit, meaning) in _MATRICES.items()
    }
    variables["row"] = labels("row", structure.dofs, "degree of freedom of the structure")
    if np.isfinite(structure.accurate_to):
        said = {"units": "rad/s", "long_name": "frequency up to which the structure is accurate"}
        variables["accurate_to"] = ((), structure.accurate_to, said)
    law = structure.damping_law
    if law is None and structure.proportional and structure.damping.any():
        said = {"units": "1", "long_name": "damping known to couple no modes"}
        variables["damping_proportional"] = ((), np.int8(1), said)
    return variables | _texts("damping_law", [] if law is None else [law.to_spec()])


def _structure(dataset: Stored) -> Structure:
    laws = _read_texts(dataset, "damping_law") if "damping_law" in dataset else []
    return Structure.of_law(
        _real(dataset, "mass"),
        _real(dataset, "stiffness"),
        _real(dataset, "damping"),
        list(map(str, dataset["row"].values)),
        law_from_spec(laws[0]) if laws else None,
        "damping_proportional" in dataset or None,
        float(dataset["accurate_to"].values) if "accurate_to" in dataset else np.inf,
    )


def _real(dataset: Stored, name: str) -> Float:
    """Return a matrix, or several, of real numbers."""
    values: Float = dataset[name].values
    if values.dtype != np.float64:
        raise ValueError(f"{name} holds {values.dtype.name} instead of float64")
    return values


def part_variables(model: Model, prefix: str = "") -> dict[Hashable, object]:
    """Return contacts and forces as variables."""
    contacts = _texts(f"{prefix}contacts", [contact.to_spec() for contact in model.contacts])
    return contacts | _texts(f"{prefix}forces", [force.to_spec() for force in model.forces])


def parts_of(dataset: Stored, prefix: str = "") -> tuple[list[Any], list[Any]]:
    """Return the contacts and forces that `part_variables` wrote."""
    contacts = _read_texts(dataset, f"{prefix}contacts")
    forces = _read_texts(dataset, f"{prefix}forces")
    return [contact_from_spec(spec) for spec in contacts], [force_from_spec(s) for s in forces]


def _texts(name: str, entries: Iterable[Mapping[str, object]]) -> dict[Hashable, object]:
    """Return entries as one JSON text each.

    They are variables rather than attributes: HDF5 keeps no attribute above 64 kB.
    """
    meaning = f"{name.replace('_', ' ')} of the model, one JSON text each"
    return {name: labels(f"{name}_entry", [json.dumps(entry) for entry in entries], meaning)}


def _read_texts(dataset: Stored, name: str) -> list[Any]:
    return [json.loads(text) for text in dataset[name].values]
