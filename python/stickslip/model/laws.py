"""The registries of friction and damping laws."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from stickslip.checks import brief, require_keys, text, unknown
from stickslip.errors import ModelError
from stickslip.model.contact import Contact
from stickslip.model.coulomb import Coulomb
from stickslip.model.damping import DampingLaw, ModalDamping, Rayleigh
from stickslip.model.jenkins import Jenkins, ParallelJenkins
from stickslip.model.microslip import BoucWen, Iwan, Masing
from stickslip.model.springs import Cubic, Stop
from stickslip.model.structural import StructuralDamper

LAWS: Mapping[str, type[Contact]] = {
    law.law: law
    for law in (
        Jenkins,
        ParallelJenkins,
        Iwan,
        Masing,
        BoucWen,
        StructuralDamper,
        Coulomb,
        Stop,
        Cubic,
    )
}
"""Every law by its name."""

_LIMITS = ("slip_force", "slip_forces")


def unknown_law(law: object) -> str:
    """Word an unknown law, with all laws and where each has its slip limits."""
    keys = dict.fromkeys(key for kind in LAWS.values() for key in kind.keys if key in _LIMITS)
    limits = " and ".join(
        f"{key} of {', '.join(brief(name) for name, kind in LAWS.items() if key in kind.keys)}"
        for key in keys
    )
    return f"{unknown('law', law, LAWS)} (slip limits are {limits})"


def contact_from_spec(spec: Mapping[str, object]) -> Contact:
    """Build a contact, of the class that `LAWS` holds, from the plain values of its `to_spec`."""
    require_keys(spec, "contact", ("law", "dofs", "parameters", "name"), ())
    law, dofs, parameters, name = map(spec.get, ("law", "dofs", "parameters", "name"))
    if not isinstance(law, str) or law not in LAWS:
        raise ModelError(f"contact: {unknown_law(law)}")
    if not isinstance(dofs, list | tuple):
        raise ModelError(f"{law} contact: dofs {brief(dofs)} is not a list of names")
    if not isinstance(parameters, Mapping):
        raise ModelError(f"{law} contact: parameters {brief(parameters)} is not a table")
    if name is not None:
        name = text(name, f"{law} contact: name")
    return LAWS[law].from_parameters(tuple(dofs), parameters, name)


def law_from_spec(spec: Mapping[str, Any]) -> DampingLaw:
    """Build a damping law from the plain values of its `to_spec`."""
    values = {key: value for key, value in spec.items() if key != "law"}
    if isinstance(values.get("stuck"), list):
        values["stuck"] = [contact_from_spec(one) for one in values["stuck"]]
    laws: dict[object, type[DampingLaw]] = {"rayleigh": Rayleigh, "modal": ModalDamping}
    if spec.get("law") not in laws:
        raise ModelError(f"damping: unknown law {brief(spec.get('law'))}; known: {list(laws)}")
    return laws[spec["law"]](**values)
