"""The registry of friction laws."""

from __future__ import annotations

from collections.abc import Mapping
from inspect import signature

from stickslip.checks import brief, text, unknown
from stickslip.errors import ModelError
from stickslip.model.contact import Contact, Jenkins
from stickslip.model.parallel_jenkins import ParallelJenkins
from stickslip.model.structural import StructuralDamper

__all__ = ["LAWS", "contact_from_spec", "unknown_law"]

LAWS: Mapping[str, type[Contact]] = {
    law.law: law for law in (Jenkins, ParallelJenkins, StructuralDamper)
}
"""Every law by its name."""


def unknown_law(law: object) -> str:
    """Word an unknown law, with all laws and where each has its slip limits."""
    limits = " and ".join(
        f"{key} of {brief(name)}"
        for name, kind in LAWS.items()
        for key in signature(kind).parameters
        if key.startswith("slip_force")
    )
    return f"{unknown('law', law, LAWS)} (slip limits are {limits})"


def contact_from_spec(spec: Mapping[str, object]) -> Contact:
    """Build a contact from the plain values of `Contact.to_spec`.

    Parameters
    ----------
    spec : mapping
        `law`, `dofs`, `parameters` and, optionally, `name`.

    Returns
    -------
    Contact
        Of the class that `LAWS` holds for the law.

    Raises
    ------
    ModelError
        If a key is unknown or missing, the law is unknown, or a value is refused by the law.
    """
    keys = ("law", "dofs", "parameters", "name")
    for key in spec:
        if key not in keys:
            raise ModelError(f"contact: {unknown('key', key, keys)}")
    law, dofs, parameters = (spec.get(key) for key in keys[:3])
    if not isinstance(law, str) or law not in LAWS:
        raise ModelError(f"contact: {unknown_law(law)}")
    if not isinstance(dofs, list | tuple):
        raise ModelError(f"{law} contact: dofs {brief(dofs)} is not a list of names")
    if not isinstance(parameters, Mapping):
        raise ModelError(f"{law} contact: parameters {brief(parameters)} is not a table")
    name = spec.get("name")
    if name is not None:
        name = text(name, f"{law} contact: name")
    return LAWS[law].from_parameters(tuple(dofs), parameters, name)
