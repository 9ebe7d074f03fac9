"""What goes wrong on the command line, as one line on standard error and an exit code."""

from __future__ import annotations

import os
import re
import signal
import sys
import threading
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial, wraps
from types import FrameType
from typing import Any, ParamSpec, cast

import typer
from typer.core import TyperCommand, TyperGroup

from stickslip.checks import brief
from stickslip.errors import ModelError
from stickslip.interruption import SIGNALS
from stickslip_command.stop import STOPPED, leave

NOT_CONVERGED, REFUSED, DEFECT = 1, 2, 70
_AGAIN = 0.05
"""Seconds after which a signal that came during an import is heeded."""

P = ParamSpec("P")
# Its own base class has moved from click into typer.
_Refusal = cast("type[Exception]", typer.BadParameter.__mro__[2])


class _Untyped:
    """Flags take no value: the help shows them without a type."""

    def get_params(self, ctx: Any) -> Any:
        """Return arguments and options."""
        parameters = super().get_params(ctx)  # type: ignore[misc]
        for parameter in parameters:
            if getattr(parameter, "is_flag", False):
                parameter.metavar = ""
        return parameters


class Command(_Untyped, TyperCommand):
    """A command."""


class Commands(_Untyped, TyperGroup):
    """The commands; what cannot be understood of a command line is refused in one line."""

    def main(self, args: Sequence[str] | None = None, *others: Any, **options: Any) -> object:
        """Run the command that the arguments name."""
        from stickslip.cli.console import complain, give_up

        for name in ("stdout", "stderr"):
            # A program that was started without them has nowhere to write to.
            if getattr(sys, name) is None:
                setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115
        if not (sys.argv[1:] if args is None else args):
            args = ["--help"]
        try:
            code = super().main(args, *others, **options | {"standalone_mode": False})
            sys.stdout.flush()
        except typer.Abort:
            complain("interrupted", "nothing more was saved")
            code = STOPPED + signal.SIGINT
        except _Refusal as error:
            line = " ".join(cast("typer.BadParameter", error).format_message().split()).rstrip(".")
            complain("error", f"{line}; see stickslip --help")
            code = REFUSED
        except OSError as error:
            # The help; all else is guarded.
            code = 0
            try:
                give_up(error)
            except ModelError as said:
                complain("error", str(said))
                code = REFUSED
        sys.exit(code if isinstance(code, int) else 0)


def integer(written: object) -> int:
    """Read an option; Python's own reading takes 1_0 and the digits of all scripts."""
    text = str(written)
    if not re.fullmatch("-?[0-9]{1,18}", text):
        raise typer.BadParameter(f"{brief(text)} is not a whole number; give 0, 1, ...")
    return int(text)


def _imports(frame: FrameType | None) -> bool:
    """Say whether the command is importing a module; one that calls it may be imported itself."""
    while frame is not None and frame.f_code.co_filename != __file__:
        if frame.f_code.co_filename == "<frozen importlib._bootstrap>":
            return True
        frame = frame.f_back
    return False


@contextmanager
def _ended_by_signals(ended: list[int]) -> Iterator[None]:
    """Let signals that would kill a run end it as Ctrl-C does, and note them.

    Signals that the parent ignores, as ``nohup`` does with SIGHUP and a shell without job control
    with the Ctrl-C of what it runs behind ``&``, stay ignored.
    """
    # On Windows it would end the process at once.
    send = partial(os.kill, os.getpid()) if os.name == "posix" else signal.raise_signal

    def end(number: int, frame: FrameType | None) -> None:
        if _imports(frame):
            # Compiled modules swallow the exception here, or raise others in its place.
            later = threading.Timer(_AGAIN, send, (number,))
            later.daemon = True
            later.start()
            return
        ended.append(number)
        raise KeyboardInterrupt

    handlers = {
        number: signal.getsignal(number)
        for number in SIGNALS
        if threading.current_thread() is threading.main_thread()
        and signal.getsignal(number) in (signal.SIG_DFL, signal.default_int_handler, leave)
    }
    for number in handlers:
        signal.signal(number, end)
    try:
        yield
    finally:
        for number, handler in handlers.items():
            signal.signal(number, handler)


def guarded(command: Callable[P, None]) -> Callable[P, None]:
    """Turn what a command raises into one line on standard error and an exit code."""

    @wraps(command)
    def safe(*args: P.args, **kwargs: P.kwargs) -> None:
        from stickslip.cli.console import complain, give_up

        if os.environ.get("STICKSLIP_DEBUG", "0") not in ("", "0"):
            return command(*args, **kwargs)
        ended: list[int] = []
        try:
            with warnings.catch_warnings(), _ended_by_signals(ended):
                # the table marks these peaks
                warnings.filterwarnings("ignore", message="peak of ", category=UserWarning)
                warnings.showwarning = lambda text, *_, **__: complain("note", str(text))
                command(*args, **kwargs)
        except (typer.Exit, typer.Abort):
            raise
        except KeyboardInterrupt as error:
            complain("interrupted", str(error) or "nothing more was saved")
            raise typer.Exit(STOPPED + (ended[0] if ended else signal.SIGINT)) from None
        except ModelError as error:
            complain("error", str(error))
            raise typer.Exit(REFUSED) from None
        except BrokenPipeError as error:
            # Nobody reads any more.
            give_up(error)
        except OSError as error:
            complain("error", f"{error.filename or 'file'}: {error.strerror or error}")
            raise typer.Exit(REFUSED) from None
        except Exception as error:
            if ended:
                # An error of a library, which the signal has left half done.
                complain("interrupted", "nothing more was saved")
                raise typer.Exit(STOPPED + ended[0]) from None
            cause = " ".join(f"{type(error).__name__}: {error}".split())
            advice = (
                "this is a defect of stickslip; set STICKSLIP_DEBUG=1 to see where, and report it"
            )
            complain("error", f"{cause} ({advice})")
            raise typer.Exit(DEFECT) from None

    return safe
