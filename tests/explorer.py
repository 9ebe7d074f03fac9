"""An explorer that runs as a process of its own, and what asks it by hand."""

import asyncio
import json
import re
import signal
import subprocess
from typing import Self

from tornado.httpclient import AsyncHTTPClient, HTTPRequest
from tornado.websocket import websocket_connect

from beam_study import COMMAND

PATIENCE = 60.0


class Explorer:
    """The command ``stickslip explore`` on a study, at `address`, until it is ended."""

    def __init__(self, study, *arguments):
        command = [*COMMAND, "explore", str(study), "--port", "0", "--no-browser", *arguments]
        self.process = subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )

    def __enter__(self) -> Self:
        line = self.process.stdout.readline()
        self.address = re.search(r"http://127\.0\.0\.1:\d+/", line)[0]
        self.name = self.address.removeprefix("http://").rstrip("/")
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.end(signal.SIGKILL)

    def end(self, number=signal.SIGINT):
        """Send a signal; return the exit code and what stands on standard error."""
        self.process.send_signal(number)
        _, said = self.process.communicate(timeout=PATIENCE)
        return self.process.returncode, said


class Page:
    """What a page does, without a browser: messages to and fro."""

    def __init__(self, explorer):
        self.loop = asyncio.new_event_loop()
        self.number = 0
        origin = {"Origin": explorer.address.rstrip("/")}
        request = HTTPRequest(f"ws://{explorer.name}/socket", headers=origin)
        self.socket = self._wait(websocket_connect, request)
        self.greeting = self.read()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_):
        async def closed():
            self.socket.close()
            await asyncio.sleep(0.05)

        self._wait(closed)
        self.loop.close()

    def _wait(self, start, *arguments):
        async def waited():
            return await asyncio.wait_for(start(*arguments), PATIENCE)

        return self.loop.run_until_complete(waited())

    def read(self):
        """Return the next message; None once the socket is closed."""
        text = self._wait(self.socket.read_message)
        return None if text is None else json.loads(text)

    def send(self, message):
        """Send what a page would, or a text."""
        text = message if isinstance(message, str) else json.dumps(message)
        self._wait(self.socket.write_message, text)

    def asked(self, want="panes", **moved):
        """Ask with sliders moved: `slip_force=300.0`."""
        self.number += 1
        knobs = self.greeting["knobs"]
        values = [moved.get(one["label"].replace(" ", "_"), one["value"]) for one in knobs]
        return {
            "number": self.number,
            "want": want,
            "values": values,
            "dof": moved.get("dof", self.greeting["dofs"][0]),
            "over": moved.get("over", [*self.greeting["overs"], ""][0]),
        }

    def until(self, pane):
        """Return what is told of a pane at the position asked for last, or what is refused."""
        while True:
            told = self.read()
            if "refused" in told or (
                told["number"] == self.number and told["pane"] == pane and "figures" in told
            ):
                return told


def answer(address, **options):
    """Return the response of the server to a request, of whatever code."""

    async def fetch():
        request = HTTPRequest(address, **options)
        return await AsyncHTTPClient(force_instance=True).fetch(request, raise_error=False)

    return asyncio.run(fetch())
