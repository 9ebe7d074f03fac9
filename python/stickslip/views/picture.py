"""Pictures: panels one below the other, written to a file."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from pathlib import Path
from typing import Protocol, TypeAlias

from stickslip.drawn import Axes
from stickslip.errors import ModelError
from stickslip.files import make_folder, write


class Panel(Protocol):
    """Draws something on axes."""

    def __call__(self, *, ax: Axes) -> object:
        """Draw it."""
        ...


Panels: TypeAlias = list[Panel]


def draw(panels: Sequence[Panel], file: Path) -> None:
    """Draw panels one below the other into a file.

    Parameters
    ----------
    panels : sequence of Panel
        What to draw, from top to bottom.
    file : Path
        The picture; its ending says in which format. Folders are made as needed.

    Raises
    ------
    ModelError
        If the format is unknown, a panel refuses what it is to draw, or the picture cannot be
        written.
    """
    content = drawn_as(panels, file.suffix, str(file))
    make_folder(file.parent)
    write(file, content)


def drawn_as(panels: Sequence[Panel], suffix: str, entry: str) -> memoryview:
    """Return the bytes of a picture, in the format of an ending; see `draw`."""
    from matplotlib.figure import Figure

    # made without pyplot: no window system is asked for, and nothing stays open
    figure = Figure(figsize=(7.0, 0.6 + 3.9 * len(panels)), layout="constrained")
    known = figure.canvas.get_supported_filetypes()
    kind = suffix.lstrip(".").lower()
    if kind not in known:
        kinds = ", ".join(f".{kind}" for kind in sorted(known))
        raise ModelError(f"{entry}: '{suffix}' is no format of pictures; known: {kinds}")
    for row, panel in enumerate(panels):
        panel(ax=figure.add_subplot(len(panels), 1, row + 1))
    picture = io.BytesIO()
    figure.savefig(picture, format=kind, dpi=150)
    return picture.getbuffer()


def labelled(
    panels: Iterable[Callable[..., object]], names: Sequence[str], traits: Sequence[str]
) -> Panels:
    """Name the curves of panels: by their results, each with what distinguishes it, if anything."""
    from stickslip.plot.style import named

    labels = [*map(named, names)]
    if len(set(traits)) > 1:
        labels = [f"{label}: {trait}" for label, trait in zip(labels, traits, strict=True)]
    return [partial(panel, labels=labels) for panel in panels]


def titled(panel: Panel, name: str) -> Panel:
    """Put the name of a result over its panel."""
    from stickslip.plot.style import named

    def drawn(*, ax: Axes) -> None:
        panel(ax=ax)
        ax.set_title(": ".join(filter(None, [named(name), ax.get_title()])), fontsize="medium")

    return drawn
