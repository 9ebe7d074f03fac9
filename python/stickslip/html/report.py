"""The report: results of any kind on one page that needs nothing else to be read."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Literal, TypeAlias, Union

from stickslip.checks import as_list, brief, choice, file_path, members, text
from stickslip.errors import ModelError
from stickslip.files import require_place, write
from stickslip.html.sections import Entry, content
from stickslip.results.result import Result
from stickslip.results.store import load
from stickslip.study.tables import OutputTable

if TYPE_CHECKING:
    from jinja2 import Environment

Reported: TypeAlias = Union[Result, str, "os.PathLike[str]"]


def report(
    results: Reported | Iterable[Reported] | Mapping[str, Reported],
    path: str | os.PathLike[str],
    *,
    title: str | None = None,
    dofs: Iterable[str] | str | None = None,
    omega_unit: Literal["rad/s", "Hz", "rpm"] | None = None,
    length_unit: Literal["auto", "m", "mm", "um"] = "auto",
) -> None:
    """Write results as a self-contained HTML page, whole or not at all.

    The page has interactive figures, tables, the model, what was assumed, what is in doubt, how
    long everything took and with which version. It asks nothing of a network: plotly.js (5 MB) is
    part of it. Results of one kind and the same degrees of freedom are drawn together.

    Parameters
    ----------
    results : Result, path-like, iterable or mapping of these
        What to report. Files are those that `save` wrote; the keys of a mapping are the names that
        the page uses.
    path : path-like
        The page, ending in .html; an existing one is replaced.
    title : str, optional
        Heading of the page. Default: the names of the results.
    dofs : str or iterable of str, optional
        Degrees of freedom to show. Default: those with a force or a contact.
    omega_unit : {"rad/s", "Hz", "rpm"}, optional
        Unit of the frequency axes, of responses over the speed that of the speed, and rpm of
        tables; of a disk rpm are those of the rotor. Default: "rad/s"; of responses over the speed
        "rpm", of diagrams over speed or nodal diameter "Hz".
    length_unit : {"auto", "m", "mm", "um"}, optional
        Unit of the amplitudes. Default: that which suits the numbers.

    Raises
    ------
    ModelError
        If there is no result, a file is damaged or of an unknown kind, a degree of freedom belongs
        to none of the results, there is no such unit, the page cannot be written, or plotly or
        jinja2 is not installed: ``pip install 'stickslip[report]'``.
    """
    target = file_path(path, "path")
    if target.suffix.lower() not in (".html", ".htm"):
        raise ModelError(f"{target}: a report is a page of HTML; let its name end in .html")
    require_place(target)
    if omega_unit is not None:
        choice(omega_unit, "omega_unit", ["rad/s", "Hz", "rpm"])
    choice(length_unit, "length_unit", ["auto", "m", "mm", "um"])
    entries = _entries(results)
    shown = _dofs(dofs, entries)
    if title is not None:
        text(title, "title")
    page = _templates().get_template("report.html")
    output = OutputTable(omega_unit=omega_unit, length_unit=length_unit)
    with warnings.catch_warnings():
        # the page marks these peaks
        warnings.filterwarnings("ignore", message="peak of ", category=UserWarning)
        html = page.render(content(entries, shown, output, title))
    write(target, html.encode())


def _templates() -> Environment:
    """Return the templates, or say what is missing before anything is drawn."""
    try:
        import plotly  # noqa: F401
        from jinja2 import Environment, PackageLoader, StrictUndefined
    except ImportError as error:
        raise ModelError(
            f"report: {error.name} is not installed; install it with pip install "
            "'stickslip[report]'"
        ) from None
    return Environment(
        loader=PackageLoader("stickslip.html", "page"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )


def _entries(results: object) -> list[Entry]:
    """Return the results, read from their files; files of one name get that of their folder too."""
    neither = "is neither a result nor a file of one"
    if isinstance(results, Result | str | os.PathLike):
        results = [results]
    found = as_list(results)
    if found is None:
        raise ModelError(f"results: {brief(results)} {neither}")
    named: list[tuple[str, object]] = [("", one) for one in found]
    if isinstance(results, Mapping):
        named = [(text(name, "name of a result"), one) for name, one in results.items()]
    if not named:
        raise ModelError("results: empty; give at least one result or file")
    entries = []
    for place, (name, one) in enumerate(named):
        anchor = f"result-{place + 1}"
        if isinstance(one, Result):
            unnamed = "result" if len(named) == 1 else f"result {place + 1}"
            entries.append(Entry(name or unnamed, one, None, anchor))
        elif isinstance(one, str | os.PathLike):
            source = file_path(one, f"results[{place}]")
            entries.append(Entry(name or source.stem, load(source), source, anchor))
        else:
            raise ModelError(f"results[{place}]: {brief(one)} {neither}")
    names = [entry.name for entry in entries]
    return [
        entry._replace(name=f"{entry.source.resolve().parent.name}{os.sep}{entry.name}")
        if entry.source is not None and names.count(entry.name) > 1
        else entry
        for entry in entries
    ]


def _dofs(dofs: Iterable[str] | str | None, entries: list[Entry]) -> tuple[str, ...] | None:
    if dofs is None:
        return None
    given = (dofs,) if isinstance(dofs, str) else members(dofs, "dofs", "['tip']")
    wanted = tuple(text(dof, "dofs") for dof in given)
    if not wanted:
        raise ModelError("dofs: empty; name at least one, or leave it out")
    for dof in wanted:
        if not any(dof in entry.result.dofs for entry in entries):
            # its message says whether it is unknown or was not observed
            entries[0].result._column(dof)
    return wanted
