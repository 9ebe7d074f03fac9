"""What the documents say is run: Python, study files, commands, and the messages they quote.

Conventions of the pages, beside plain Markdown:

- Python blocks of a page run in order in one namespace; a ``text title="Output"`` block after one
  holds exactly what it prints.
- A TOML block with ``title="NAME"`` is a file that later blocks and commands of the page may use;
  every TOML block, whole or a single table, must be a valid study.
- Lines ``$ stickslip ...`` of console blocks run, and must succeed.
- The class ``norun``, as in ``{.python .norun}``, exempts a block.
"""

from __future__ import annotations

import ast
import re
import shlex
import shutil
import tomllib
from collections.abc import Iterator, Mapping
from contextlib import redirect_stdout
from dataclasses import dataclass
from io import StringIO
from pathlib import Path

import pytest
from typer.testing import CliRunner

ROOT = Path(__file__).resolve().parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
EXAMPLE = ROOT / "examples" / "snecma-beam"

_BLOCK = re.compile(
    r"^(?P<indent> *)(?P<fence>```+)(?P<info>[^\n`]*)\n(?P<body>.*?)^ *(?P=fence) *$",
    re.MULTILINE | re.DOTALL,
)


@dataclass(frozen=True)
class Block:
    """A fenced block of a page."""

    page: Path
    line: int
    language: str
    title: str
    body: str


def blocks(page: Path) -> list[Block]:
    return list(_blocks(page))


def _blocks(page: Path) -> Iterator[Block]:
    text = page.read_text(encoding="utf-8") if page.exists() else ""
    for match in _BLOCK.finditer(text):
        title = re.search(r'title="([^"]*)"', match["info"])
        words = re.findall(r"[\w-]+", match["info"].partition("title=")[0])
        if not words or "norun" in words:
            continue
        lines = [line.removeprefix(match["indent"]) for line in match["body"].splitlines()]
        yield Block(
            page,
            text.count("\n", 0, match.start()) + 2,
            words[0],
            title[1] if title else "",
            "\n".join(lines) + "\n",
        )


def _named(page: Path) -> str:
    return page.name


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A working folder with the example studies; no window is opened, no figure stays open."""
    shutil.copytree(ROOT / "examples", tmp_path / "examples")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.slow
@pytest.mark.parametrize("page", PAGES, ids=_named)
def test_page_runs_as_written(page: Path, folder: Path) -> None:
    namespace: dict[str, object] = {"__name__": "__main__"}
    printed = ""
    for block in blocks(page):
        if block.language == "python":
            printed = _run(block, namespace)
        elif block.language == "console":
            _command(block)
        elif block.title == "Output":
            assert printed == block.body, f"{page.name}:{block.line} shows other output"
        elif block.title:
            (folder / block.title).write_text(block.body, encoding="utf-8")


def _run(block: Block, namespace: dict[str, object]) -> str:
    # Empty lines in front make a traceback point to the line of the page.
    source = "\n" * (block.line - 1) + block.body
    out = StringIO()
    with redirect_stdout(out):
        exec(compile(source, str(block.page), "exec"), namespace)
    return out.getvalue()


def _command(block: Block) -> None:
    from stickslip.cli import app

    for line in block.body.splitlines():
        if not line.startswith("$ stickslip "):
            continue
        words = shlex.split(line.removeprefix("$ stickslip "), comments=True)
        arguments = [file for word in words for file in _expanded(word)]
        outcome = CliRunner().invoke(app, arguments)
        assert outcome.exit_code == 0, f"{block.page.name}: {line}\n{outcome.output}"


def _expanded(word: str) -> list[str]:
    """Replace a pattern by the files it stands for, as a shell would."""
    return sorted(map(str, Path().glob(word))) or [word] if "*" in word else [word]


def _studies() -> list[Block]:
    return [block for page in PAGES for block in blocks(page) if block.language == "toml"]


@pytest.mark.slow
@pytest.mark.parametrize("block", _studies(), ids=lambda block: f"{block.page.stem}:{block.line}")
def test_toml_block_is_a_valid_study(block: Block, folder: Path) -> None:
    from stickslip.study import Study
    from stickslip.study.tables import StudyTables

    given = tomllib.loads(block.body)
    if {"structure", "analysis"} <= given.keys():
        for file in EXAMPLE.glob("*.mtx"):
            shutil.copy(file, folder)
        Study.parse(block.body, folder=folder)
        return
    example = tomllib.loads((EXAMPLE / "study.toml").read_text(encoding="utf-8"))
    StudyTables.model_validate(_completed(given, example))


def _completed(given: Mapping[str, object], example: Mapping[str, object]) -> dict[str, object]:
    """Fill a fragment up with the example, down to the keys of its tables."""
    whole = dict(example) | dict(given)
    for name in ("structure", "analysis"):
        table, sample = given.get(name), example[name]
        if isinstance(table, dict) and isinstance(sample, dict):
            # These have frequencies of their own, or none.
            own = ("limit-cycles", "nonlinear-modes", "static", "fit", "uncertainty")
            own += ("campbell", "speed-response", "flutter-map")
            driven = table.get("kind") not in own
            needed = ("mass", "stiffness", "omega") if driven else ("mass", "stiffness")
            whole[name] = {key: sample[key] for key in needed if key in sample} | table
    return whole


def _messages() -> list[tuple[str, str]]:
    """Every message in the first column of the tables of the troubleshooting page."""
    text = (ROOT / "docs" / "troubleshooting.md").read_text(encoding="utf-8")
    text = text[text.index("## Structure") :]
    found = re.findall(r"^\| `([^`]+)` \|", text, re.MULTILINE)
    return [(message, part) for message in found for part in message.split("…") if part.strip()]


def _spoken() -> str:
    """All text that the package and the core can say."""
    said: list[str] = []
    for file in (ROOT / "python" / "stickslip").rglob("*.py"):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Constant) and isinstance(node.value, str):
                said.append(node.value)
    # A line of Rust text may be continued after a backslash.
    for file in (ROOT / "core" / "src").rglob("*.rs"):
        said.append(re.sub(r"\\\n\s*", "", file.read_text(encoding="utf-8")))
    return "\0".join(said)


@pytest.mark.slow
def test_quoted_messages_exist() -> None:
    spoken = _spoken()
    wrong = [message for message, part in _messages() if part.strip() not in spoken]
    assert not wrong, wrong
    assert len(_messages()) > 20


def test_every_status_is_explained() -> None:
    from stickslip import Status

    text = (ROOT / "docs" / "troubleshooting.md").read_text(encoding="utf-8")
    assert [status for status in Status if f"`{status.name}`" not in text] == []


def test_public_names_are_documented() -> None:
    import stickslip as ss

    text = (ROOT / "docs" / "api.md").read_text(encoding="utf-8")
    assert [name for name in ss.__all__ if not re.search(rf"\b{name}\b", text)] == []


@pytest.mark.parametrize("page", PAGES, ids=_named)
def test_names_of_the_package_exist(page: Path) -> None:
    import stickslip as ss

    text = page.read_text(encoding="utf-8")
    named = re.findall(r"\bss\.([A-Za-z_][\w.]*\w)", text)
    assert [name for name in named if not _exists(ss, name)] == []


def _exists(owner: object, name: str) -> bool:
    first, _, rest = name.partition(".")
    return hasattr(owner, first) and (not rest or _exists(getattr(owner, first), rest))


def test_source_files_of_the_theory_exist() -> None:
    text = (ROOT / "docs" / "theory.md").read_text(encoding="utf-8")
    files = re.findall(r"`((?:core|python|bindings)/[\w/.-]+\.(?:rs|py))`", text)
    assert [file for file in files if not (ROOT / file).is_file()] == []
    assert len(set(files)) > 10


def test_every_key_of_study_files_is_documented() -> None:
    from stickslip.study import json_schema

    text = (ROOT / "docs" / "study-file.md").read_text(encoding="utf-8")
    missing = [key for key in _keys(json_schema()) if not re.search(rf"`[^`\n]*\b{key}\b", text)]
    assert missing == []


def _keys(schema: object) -> Iterator[str]:
    if isinstance(schema, dict):
        properties = schema.get("properties", {})
        yield from properties
        for value in schema.values():
            yield from _keys(value)
    elif isinstance(schema, list):
        for value in schema:
            yield from _keys(value)
