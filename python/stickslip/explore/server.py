"""The local server of the explorer: one page, its files, and a socket to the solver."""

from __future__ import annotations

import asyncio
import atexit
import os
import signal
import socket
import sys
import threading
import time
import webbrowser
from collections.abc import Callable, Mapping
from importlib.resources import files
from pathlib import Path
from typing import Any

from tornado.httpserver import HTTPServer
from tornado.netutil import bind_sockets
from tornado.web import Application, HTTPError, RequestHandler
from tornado.websocket import WebSocketClosedError, WebSocketHandler

from stickslip.errors import ModelError
from stickslip.explore.session import Session, packed

HOST = "127.0.0.1"
_MOST_PAGES = 8
_LONGEST = 1 << 16
"""Bytes of a message of a page, and of the body of a request."""
_PATIENCE = 2.0
"""Seconds that computations have to end when the server does; most take a tenth."""
# Styles of plotly stand in the page. Nothing is loaded from elsewhere, and no page frames this one.
_POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src data: blob:; "
    "connect-src 'self'; form-action 'none'; base-uri 'none'; frame-ancestors 'none'"
)
_HEADERS = {
    "Content-Security-Policy": _POLICY,
    "Cache-Control": "no-store",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
}
_KINDS = {".html": "text/html", ".css": "text/css", ".js": "text/javascript"}


def serve(path: Path, port: int, tell: Callable[[str], None], *, browser: bool) -> None:
    """Serve the explorer of a study until Ctrl-C.

    Parameters
    ----------
    path : Path
        The study file.
    port : int
        Port of the loopback address; 0 takes a free one.
    tell : callable
        Is told the address of the page.
    browser : bool
        Whether to open the page in the browser.

    Raises
    ------
    ModelError
        If the study is refused or the port cannot be had.
    """
    ears = _bound(port)
    pages = _Pages()
    try:
        asyncio.run(_serve(path, ears, pages, tell, browser=browser))
    finally:
        pages.end()


class _Pages:
    """The pages that are open, and those that have gone while something is computed for them."""

    def __init__(self) -> None:
        self.open: set[Session] = set()
        self._left: set[Session] = set()

    def leave(self, page: Session) -> None:
        page.end()
        self.open.discard(page)
        self._left = {one for one in self._left | {page} if not one.ended(0.0)}

    def end(self) -> None:
        """End all computations, before the interpreter takes their threads away.

        A thread that is in the core then would abort the program. One that does not end in time is
        left behind: the program leaves without looking back.
        """
        pages, end = self.open | self._left, time.monotonic() + _PATIENCE
        for page in pages:
            page.end()
        if not all(page.ended(max(end - time.monotonic(), 0.0)) for page in pages):
            atexit.register(_leave)


def _leave() -> None:
    for stream in (sys.stdout, sys.stderr):
        stream.flush()
    os._exit(128 + signal.SIGINT)


def _bound(port: int) -> list[socket.socket]:
    try:
        return bind_sockets(port, HOST, family=socket.AF_INET)
    except OSError as error:
        raise ModelError(
            f"port {port}: {error.strerror or error}; give another with --port, 0 for any free one"
        ) from None


async def _serve(
    path: Path,
    ears: list[socket.socket],
    pages: _Pages,
    tell: Callable[[str], None],
    *,
    browser: bool,
) -> None:
    port = ears[0].getsockname()[1]
    names = {f"{name}:{port}" for name in (HOST, "localhost")}
    if port == 80:
        names |= {HOST, "localhost"}
    shared = {"names": frozenset(names)}
    content = {address: shared | one for address, one in _content().items()}
    application = Application(
        [
            *((address, _File, one) for address, one in content.items()),
            ("/socket", _Socket, shared | {"path": path, "pages": pages}),
        ],
        default_handler_class=_Nothing,
        default_handler_args=shared,
        # who asks for what is nobody's business
        log_function=lambda _: None,
        websocket_max_message_size=_LONGEST,
    )
    server = HTTPServer(application, max_body_size=_LONGEST, max_header_size=_LONGEST)
    server.add_sockets(ears)
    address = f"http://{HOST}:{port}/"
    tell(address)
    if browser:
        threading.Thread(target=webbrowser.open, args=(address,), daemon=True).start()
    await asyncio.Event().wait()


def _content() -> dict[str, dict[str, object]]:
    from plotly.offline import get_plotlyjs

    here, report = files("stickslip.explore") / "page", files("stickslip.html") / "page"
    served = {
        "/": here / "explore.html",
        "/explore.css": here / "explore.css",
        "/explore.js": here / "explore.js",
        "/report.css": report / "report.css",
    }
    found: dict[str, dict[str, object]] = {
        address: {"content": file.read_bytes(), "kind": _KINDS[Path(file.name).suffix]}
        for address, file in served.items()
    }
    found["/plotly.js"] = {"content": get_plotlyjs().encode(), "kind": _KINDS[".js"]}
    return found


class _Local(RequestHandler):
    """Answers pages of this server only.

    A foreign page can let its own name mean this machine (DNS rebinding); it cannot forge the
    headers that tell the name it used and where it came from.
    """

    def initialize(self, names: frozenset[str], **_: object) -> None:
        self.names = names

    def set_default_headers(self) -> None:
        for name, value in _HEADERS.items():
            self.set_header(name, value)
        self.clear_header("Server")

    def prepare(self) -> None:
        host = self.request.headers.get("Host", "")
        origin = self.request.headers.get("Origin")
        if host not in self.names or (origin is not None and origin != f"http://{host}"):
            raise HTTPError(403)

    def write_error(self, status_code: int, **_: Any) -> None:
        self.set_header("Content-Type", "text/plain; charset=UTF-8")
        self.finish(f"{status_code}\n")

    def log_exception(self, kind: Any, value: Any, trace: Any) -> None:
        # what a client does wrong is answered, and no event; all else is a defect
        if not isinstance(value, HTTPError):
            said = " ".join(f"{type(value).__name__}: {value}".split())
            sys.stderr.write(f"error: {said} (this is a defect of stickslip)\n")


class _Nothing(_Local):
    def prepare(self) -> None:
        super().prepare()
        raise HTTPError(404)


class _File(_Local):
    def initialize(self, names: frozenset[str], content: bytes = b"", kind: str = "") -> None:  # type: ignore[override]
        super().initialize(names)
        self.content, self.kind = content, kind

    def get(self) -> None:
        self.set_header("Content-Type", f"{self.kind}; charset=UTF-8")
        self.finish(self.content)


class _Socket(_Local, WebSocketHandler):
    def initialize(self, names: frozenset[str], path: Path, pages: _Pages) -> None:  # type: ignore[override]
        super().initialize(names)
        self.path, self.pages = path, pages
        self.session: Session | None = None

    def prepare(self) -> None:
        super().prepare()
        if "Origin" not in self.request.headers:
            raise HTTPError(403)

    def check_origin(self, origin: str) -> bool:
        # prepare has done it
        return True

    def open(self, *_: str, **__: str) -> None:
        loop = asyncio.get_running_loop()
        if len(self.pages.open) >= _MOST_PAGES:
            self._send({"refused": f"{_MOST_PAGES} pages are open; close one, and load this again"})
            self.close()
            return

        def tell(message: Mapping[str, Any]) -> None:
            text = packed(dict(message))
            try:
                loop.call_soon_threadsafe(self._send, text)
            except RuntimeError:
                # the server has ended
                return

        try:
            self.session = Session(self.path, tell)
        except ModelError as error:
            self._send({"refused": str(error)})
            self.close()
            return
        self.pages.open.add(self.session)
        self._send(self.session.greeting())

    def on_message(self, message: str | bytes) -> None:
        if self.session is not None:
            self.session.take(message)

    def on_close(self) -> None:
        if self.session is not None:
            self.pages.leave(self.session)

    def _send(self, message: Mapping[str, Any] | str) -> None:
        text = message if isinstance(message, str) else packed(dict(message))
        try:
            self.write_message(text)
        except WebSocketClosedError:
            # the page has gone
            return
