"""One open page: what it asks for, and what it is told, in the order in which it is seen.

It has desks at which one thing is worked on, always the newest: what is older is dropped.
"""

from __future__ import annotations

import base64
import json
import threading
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import Any, Generic, Literal, NamedTuple, TypeVar, cast

from pydantic import BaseModel, ConfigDict, ValidationError

from stickslip.checks import choice
from stickslip.errors import ModelError
from stickslip.explore import panes
from stickslip.explore.draft import Draft
from stickslip.explore.panes import Look, Pane
from stickslip.model.notable import physical_dofs
from stickslip.results.forced_response import ForcedResponse
from stickslip.settings.variation import Parameter
from stickslip.study import Study
from stickslip.views.picture import Panel, drawn_as

Task = TypeVar("Task")


class OutdatedError(Exception):
    """Nobody waits any more for what is being computed."""


class Desk(Generic[Task]):
    """A thread with room for one task in work and one that waits.

    Its `work` takes a task and a look, to be called often, which raises `OutdatedError` once the
    task is no longer wanted. An analysis takes it as its `progress`.
    """

    def __init__(self, work: Callable[[Task, Look], None]) -> None:
        self._work = work
        self._change = threading.Condition()
        self._waiting: list[Task] = []
        self._dropped = self._ended = False
        # A daemon: the program may end while it computes.
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def give(self, task: Task) -> None:
        """Put the newest task on the desk, in place of those before."""
        with self._change:
            self._waiting, self._dropped = [task], True
            self._change.notify()

    def drop(self) -> None:
        """Want nothing of what was given any more."""
        with self._change:
            self._waiting, self._dropped = [], True

    def end(self) -> None:
        """Drop everything, for good."""
        with self._change:
            self._waiting, self._dropped, self._ended = [], True, True
            self._change.notify()

    def ended(self, patience: float) -> bool:
        """Wait until the thread has ended; False if it takes longer [s]."""
        self._thread.join(patience)
        return not self._thread.is_alive()

    def _look(self, _: float) -> None:
        if self._dropped:
            raise OutdatedError

    def _run(self) -> None:
        while True:
            with self._change:
                self._change.wait_for(lambda: self._waiting or self._ended)
                if self._ended:
                    return
                task, self._dropped = self._waiting.pop(), False
            with suppress(OutdatedError):
                self._work(task, self._look)


Tell = Callable[[dict[str, Any]], None]

PANES = ("curve", "contacts", "damper")
_DOFS = 60
"""Degrees of freedom offered, beside those that the study shows."""
_TELL_EVERY = 0.25
"""Seconds between two words on how far a computation is."""


class Asked(BaseModel):
    """What a page asks for: numbers and names, nothing that is run."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False)

    number: int
    want: Literal["panes", "study", "picture"]
    values: list[float]
    dof: str
    over: str


class Position(NamedTuple):
    """Where the sliders stand."""

    number: int
    source: str
    """The study file."""
    dof: str
    over: str


class Computed(NamedTuple):
    """The curve at a position."""

    position: Position
    study: Study
    result: ForcedResponse


class Session:
    """One open page, to which `tell` sends a message from any thread."""

    def __init__(self, path: Path, tell: Tell) -> None:
        self.draft, self._tell = Draft(path), tell
        study = self.draft.study
        known = study.tables.analysis.observed or physical_dofs(study.model)
        self._dofs = list(dict.fromkeys([*study.dofs, *known]))[:_DOFS]
        self._overs = panes.parameters(study.model)
        self._computed: Computed | None = None
        self._panels: dict[str, list[Panel]] = {}
        self._curves: Desk[Position] = Desk(self._guarded(PANES[:2], self._curve))
        self._dampers: Desk[Computed] = Desk(self._guarded(PANES[2:], self._damper))
        self._pictures: Desk[str] = Desk(self._picture)
        self._desks: tuple[Desk[Any], ...] = self._curves, self._dampers, self._pictures

    def greeting(self) -> dict[str, Any]:
        """Return what a page is told first: the study and its sliders."""
        study = self.draft.study
        told = ("group", "label", "value", "unit", "low", "high", "log")
        knobs = [{key: asdict(knob)[key] for key in told} for knob in self.draft.knobs]
        left_out = "The table [sweep] of the file is left out here." if self.draft.swept else ""
        return {
            "name": study.name,
            "description": ". ".join(filter(None, [study.tables.description, left_out])),
            "knobs": knobs,
            "dofs": self._dofs,
            "overs": self._overs,
        }

    def take(self, message: str | bytes) -> None:
        """Do what a page asks for; what cannot be understood is refused in one line."""
        try:
            asked = self._read(message)
            text = self.draft.text(asked.values)
        except ModelError as error:
            self._tell({"refused": str(error)})
            return
        match asked.want:
            case "study":
                file = f"{self.draft.name}.toml"
                self._tell({"file": file, "text": self.draft.exported(asked.values)})
            case "picture":
                self._pictures.give(f"{self.draft.name}.png")
            case "panes":
                self._dampers.drop()
                self._curves.give(Position(asked.number, text, asked.dof, asked.over))

    def end(self) -> None:
        """Drop everything; the page has gone."""
        for desk in self._desks:
            desk.end()

    def ended(self, patience: float) -> bool:
        """Wait until nothing is computed any more; False if it takes longer [s]."""
        return all(desk.ended(patience) for desk in self._desks)

    def _read(self, message: str | bytes) -> Asked:
        try:
            asked = Asked.model_validate_json(message)
        except ValidationError as error:
            first = error.errors(include_url=False, include_input=False)[0]
            place = ".".join(map(str, first["loc"])) or "message"
            raise ModelError(f"{place}: {first['msg']}") from None
        knobs = self.draft.knobs
        if len(asked.values) != len(knobs):
            raise ModelError(f"values: {len(asked.values)} for {len(knobs)} sliders")
        choice(asked.dof, "dof", self._dofs)
        if self._overs or asked.over:
            choice(asked.over, "over", self._overs)
        return asked

    def _guarded(
        self, names: Sequence[str], work: Callable[[Any, Look], None]
    ) -> Callable[[Any, Look], None]:
        """Let what goes wrong be a message in the first of the panes."""

        def safe(task: Any, look: Look) -> None:
            position = task if isinstance(task, Position) else task.position
            told = time.monotonic()

            def heeded(share: float) -> None:
                nonlocal told
                look(share)
                if share < 1.0 and time.monotonic() > told + _TELL_EVERY:
                    told = time.monotonic()
                    self._tell({"number": position.number, "pane": names[0], "share": share})

            try:
                work(task, heeded)
            except OutdatedError:
                raise
            except Exception as error:
                self._failed(position, names, _line(error))

        return safe

    def _failed(self, position: Position, names: Sequence[str], text: str) -> None:
        # what depends on a curve that there is not has nothing to show either
        for name in PANES[PANES.index(names[0]) :]:
            said = [text] if name == names[0] else []
            self._show(position, Pane(name, failures=said))

    def _curve(self, position: Position, look: Look) -> None:
        known = self._computed
        if known is None or known.position.source != position.source:
            study = self.draft.parsed(position.source)
            result = cast("ForcedResponse", next(study.run(look)))
        else:
            study, result = known.study, known.result
        look(1.0)
        self._computed = computed = Computed(position, study, result)
        self._show(position, panes.curve(study, result, position.dof).draw(look))
        self._show(position, panes.contacts(study, result, position.dof).draw(look))
        if position.over:
            self._dampers.give(computed)
        else:
            self._show(position, Pane("damper"))

    def _damper(self, computed: Computed, look: Look) -> None:
        position, study, result = computed
        over = cast("Parameter", position.over)
        pane = panes.damper(study, result, position.dof, over, look)
        self._show(position, pane.draw(look))

    def _show(self, position: Position, pane: Pane) -> None:
        self._panels[pane.name] = pane.panels
        self._tell({"number": position.number} | pane.message())

    def _picture(self, name: str, _: Look) -> None:
        """Send everything that is shown as one picture."""
        panels = [panel for name in PANES for panel in self._panels.get(name, [])]
        try:
            if not panels:
                raise ModelError("picture: nothing is drawn yet; wait for the curve")
            with panes.ONE_DRAWS:
                data = base64.b64encode(drawn_as(panels, ".png", name)).decode()
        except Exception as error:
            self._tell({"refused": _line(error)})
        else:
            self._tell({"file": name, "picture": data})


def _line(error: Exception) -> str:
    """Word an error in a line."""
    if isinstance(error, ModelError):
        return str(error)
    said = " ".join(f"{type(error).__name__}: {error}".split())
    return f"{said} (this is a defect of stickslip)"


def packed(message: dict[str, Any]) -> str:
    """Return a message as JSON, without what JSON does not have."""
    return json.dumps(message, allow_nan=False)
