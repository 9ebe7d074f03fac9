"""Results for other programs: tables as CSV, Parquet and Excel, arrays as MATLAB, UFF58."""

from __future__ import annotations

import io
import math
import os
import re
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, ClassVar, Literal, NamedTuple, Protocol, TypeAlias

import numpy as np

from stickslip.checks import brief, file_path, optional_package, text, unknown
from stickslip.errors import ModelError
from stickslip.files import require_place, write
from stickslip.io.frf import Frf, universal_file
from stickslip.results.dataset import Dataset
from stickslip.results.table import Frame, Tables

_ROWS, _COLUMNS, _CHARACTERS = 2**20, 2**14, 2**15 - 1
"""Of a sheet, and of one of its cells."""
_CONTROL = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f]")
"""What XML has no characters for."""
_TITLE = 31
"""Characters of the name of a sheet."""
_ABOUT = "about"
"""The sheet that says what the columns are."""


class Exported(Protocol):
    """What is asked of a result."""

    kind: ClassVar[str]
    headline: ClassVar[str]

    def tables(self) -> Tables: ...  # noqa: D102
    def to_pandas(self, table: str | None = None) -> Frame: ...  # noqa: D102
    def to_dataset(self) -> Dataset: ...  # noqa: D102


def export(result: Exported, path: str | os.PathLike[str], table: str | None) -> None:
    """Write a result to a file of another program; see `Result.export`."""
    file = file_path(path, "path")
    suffix = ending(file.suffix, str(file))
    require_place(file)
    if table is not None and FORMATS[suffix].tables == "none":
        raise ModelError(f"table: {brief(table)}, but {suffix} files hold no tables; leave it out")
    write(file, FORMATS[suffix].content(result, file, table))


def ending(suffix: str, entry: str) -> str:
    """Return the ending of a format, ".csv", or refuse one that is unknown."""
    if suffix.lower() not in FORMATS:
        raise ModelError(f"{entry}: {unknown('format', suffix, FORMATS)}")
    return suffix.lower()


def table_of(result: Exported, tables: Tables, name: str | None) -> str:
    """Return the name of a table of a result, by default of that of its main numbers."""
    if name is None:
        return tables.holding(result.headline)
    if text(name, "table") not in tables:
        known = ", ".join(tables)
        raise ModelError(f"table: {brief(name)} is none of the result; it has {known}")
    return name


def headed(frame: Frame) -> Frame:
    """Return a table with units in its headers: "omega [rad/s]"."""
    units = frame.attrs["units"]
    made = frame.set_axis(
        [name if units[name] == "1" else f"{name} [{units[name]}]" for name in frame], axis=1
    )
    made.attrs = {}
    return made


def _csv(result: Exported, file: Path, table: str | None) -> bytes:
    # Shortest digits that lead back to the same number, whatever NumPy is told to print.
    written = headed(result.to_pandas(table)).to_csv(
        index=False, lineterminator="\n", float_format=lambda number: repr(float(number))
    )
    return str(written).encode()


def _parquet(result: Exported, file: Path, table: str | None) -> bytes:
    optional_package("pyarrow", f"{file}: Parquet files", extra="export")
    content = io.BytesIO()
    headed(result.to_pandas(table)).to_parquet(content, engine="pyarrow", index=False)
    return content.getvalue()


def _excel(result: Exported, file: Path, table: str | None) -> memoryview:
    xlsxwriter = optional_package("xlsxwriter", f"{file}: Excel files", extra="export")
    tables = result.tables()
    names = list(tables) if table is None else [table_of(result, tables, table)]
    for name in names:
        if tables.rows(name) >= _ROWS:
            raise ModelError(
                f"{file}: the table {name} has {tables.rows(name)} rows, a sheet {_ROWS - 1}; "
                "export it as .csv or .parquet, or give table= another one"
            )
    content = io.BytesIO()
    # Without temporary files: their disk may be full.
    options = {"in_memory": True, "strings_to_formulas": False, "strings_to_urls": False}
    book = xlsxwriter.Workbook(content, options)
    about = book.add_worksheet(_ABOUT)
    columns = [["sheet", "table", "column", "unit", "meaning"]]
    for title, name in zip(_titles(names), names, strict=True):
        frame, meanings = tables[name], tables[name].attrs["meanings"]
        units = frame.attrs["units"].items()
        columns += [[title, name, column, unit, meanings[column]] for column, unit in units]
        sheet = book.add_worksheet(title)
        _fill(sheet, file, [headed(frame)])
        _fill(sheet, file, frame.itertuples(index=False), first=1)
    _fill(about, file, columns)
    book.close()
    return content.getbuffer()


def _fill(sheet: Any, file: Path, rows: Iterable[Iterable[Any]], first: int = 0) -> None:
    """Write rows into a sheet: numbers, texts, and nothing for what is not a number."""
    for row, cells in enumerate(rows, first):
        for column, value in enumerate(cells):
            if isinstance(value, float) and not math.isfinite(value):
                value = "" if math.isnan(value) else str(value)
            if isinstance(value, str) and not _fits(value):
                raise ModelError(
                    f"{file}: a cell cannot hold {brief(value)}; export it as .csv or .parquet"
                )
            sheet.write(row, column, value)


def _fits(text: str) -> bool:
    """Return whether a cell can hold a text, as it is."""
    return len(text) <= _CHARACTERS and not _CONTROL.search(text)


def _titles(names: list[str]) -> list[str]:
    """Return names of sheets, which are short, different, and not that of the first one."""
    titles: list[str] = []
    for name in names:
        title = name[:_TITLE]
        if title in (*titles, _ABOUT):
            mark = f"~{len(titles) + 1}"
            title = title[: _TITLE - len(mark)] + mark
        titles.append(title)
    return titles


def _matlab(result: Exported, file: Path, _: str | None) -> bytearray | memoryview:
    """Write every variable as an array with its dimensions; texts about them as structures."""
    from scipy.io import savemat
    from scipy.io.matlab import MatWriteError

    dataset = result.to_dataset()
    made: dict[str, Any] = {}
    about: dict[str, dict[str, str]] = {"units": {}, "meanings": {}, "dimensions": {}}
    for variable, data in dataset.variables.items():
        name, values = str(variable), data.values
        values = values.reshape(-1, 1) if values.ndim == 1 else values
        made[name] = values.astype(object) if values.dtype.kind in "UO" else values
        about["units"][name] = str(data.attrs.get("units", "1"))
        about["meanings"][name] = str(data.attrs.get("long_name", ""))
        about["dimensions"][name] = " ".join(map(str, data.dims))
        if "flag_meanings" in data.attrs:
            codes = zip(data.attrs["flag_values"], data.attrs["flag_meanings"].split(), strict=True)
            told = ", ".join(f"{code} {word}" for code, word in codes)
            about["meanings"][name] += f": {told}"
    texts = {str(name): _plain(value) for name, value in dataset.attrs.items()}
    content: Any = io.BytesIO()
    try:
        savemat(
            content,
            made | about | {"result": texts},
            do_compression=True,
            long_field_names=True,
        )
    except (MatWriteError, OverflowError) as error:
        raise ModelError(
            f"{file}: MATLAB's format cannot hold it ({error}); save the result as .nc, "
            "which MATLAB reads too"
        ) from None
    return memoryview(content.getbuffer())


def _plain(value: Any) -> Any:
    return value if isinstance(value, str | np.ndarray | np.generic) else np.asarray(value)


def _universal(result: Any, file: Path, _: str | None) -> bytes:
    """Write a function per degree of freedom; of a sweep per value, which the head names."""
    swept = zip(result.results, result.labels, strict=True) if result.kind == "sweep" else None
    return universal_file(
        file,
        [
            Frf.of(one, dof, reference, about)
            for one, about in swept or [(result, "")]
            for reference in [_reference(one, file)]
            for dof in one.dofs
        ],
    )


def _reference(result: Any, file: Path) -> str:
    """Return where the force is of which a result has the response functions."""
    if result.kind != "forced_response":
        kind = result.kind.replace("_", " ")
        article = "an" if kind[0] in "aeiou" else "a"
        raise ModelError(
            f"{file}: a Universal File holds response functions, the result is {article} {kind}; "
            "export it as .csv"
        )
    forces = list(dict.fromkeys(one.dof for one in result.model.forces if one.harmonic == 1))
    if len(forces) != 1:
        raise ModelError(
            f"{file}: {len(forces)} degrees of freedom have a force of the first harmonic; say in "
            "Python which one: ss.write_frf(file, ss.Frf.of(result, dof, reference))"
        )
    return str(forces[0])


class _Format(NamedTuple):
    """A kind of file."""

    content: _Content
    tables: Literal["none", "one", "all"]
    """How many tables a file holds."""


_Content: TypeAlias = Callable[["Exported", Path, str | None], bytes | bytearray | memoryview]

FORMATS: Mapping[str, _Format] = {
    ".csv": _Format(_csv, tables="one"),
    ".parquet": _Format(_parquet, tables="one"),
    ".xlsx": _Format(_excel, tables="all"),
    ".mat": _Format(_matlab, tables="none"),
    ".uff": _Format(_universal, tables="none"),
    ".unv": _Format(_universal, tables="none"),
}
"""What a result can be exported to, by the ending of the file."""
