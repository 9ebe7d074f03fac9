"""The server of the explorer: who is answered, what is refused, and how it ends."""

import json
import signal
import socket
import subprocess
import sys
from contextlib import suppress

import pytest

from beam_study import EXAMPLE, script
from small_study import SMALL

pytest.importorskip("tomlkit")
pytest.importorskip("tornado")

from tornado.websocket import WebSocketClosedError

from explorer import Explorer, Page, answer

pytestmark = pytest.mark.slow

SLOW = EXAMPLE.parent / "wedge-damper" / "study.toml"


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    file = tmp_path_factory.mktemp("study") / "small.toml"
    file.write_text(SMALL)
    return file


@pytest.fixture(scope="module")
def explorer(study):
    with Explorer(study) as running:
        yield running


def test_only_this_machine_is_answered(explorer):
    # every address from 127.0.0.0/8 is this machine; one of them is listened to
    port = int(explorer.name.rpartition(":")[2])
    with pytest.raises(ConnectionRefusedError):
        socket.create_connection(("127.0.0.2", port), timeout=10)


@pytest.mark.parametrize("path", ["", "explore.js", "plotly.js", "socket", "nothing"])
@pytest.mark.parametrize("host", ["evil.example", "127.0.0.1", "", "127.0.0.1.evil.example:80"])
def test_another_name_of_the_server_is_refused(explorer, path, host):
    # a foreign page whose own name has been made to mean this machine
    assert answer(explorer.address + path, headers={"Host": host}).code == 403


@pytest.mark.parametrize("origin", ["https://evil.example", "null", "http://127.0.0.1:1"])
def test_another_page_is_refused(explorer, origin):
    given = {"Origin": origin}
    assert answer(explorer.address, headers=given).code == 403
    given |= {"Upgrade": "websocket", "Connection": "Upgrade", "Sec-WebSocket-Version": "13"}
    given["Sec-WebSocket-Key"] = "dGhlIHNhbXBsZSBub25jZQ=="
    assert answer(f"{explorer.address}socket", headers=given).code == 403
    del given["Origin"]
    assert answer(f"{explorer.address}socket", headers=given).code == 403


@pytest.mark.parametrize(
    ("path", "options", "code"),
    [
        ("", {}, 200),
        ("../../../etc/passwd", {}, 404),
        ("%2e%2e/explore.py", {}, 404),
        ("", {"method": "POST", "body": "x"}, 405),
        ("nothing", {"method": "POST", "body": "x" * 1000}, 404),
    ],
)
def test_the_page_and_nothing_else_is_served(explorer, path, options, code):
    response = answer(explorer.address + path, **options)
    assert response.code == code
    assert "default-src 'none'" in response.headers["Content-Security-Policy"]
    assert "Access-Control-Allow-Origin" not in response.headers


def test_the_page_runs_only_what_comes_from_this_server(explorer):
    policy = answer(explorer.address).headers["Content-Security-Policy"]
    scripts = next(one for one in policy.split("; ") if one.startswith("script-src"))
    assert scripts == "script-src 'self'"


def test_two_pages_do_not_disturb_each_other(explorer):
    with Page(explorer) as one, Page(explorer) as two:
        one.send(one.asked(slip_force=1.0))
        two.send(two.asked(slip_force=4.0))
        first, second = one.until("curve"), two.until("curve")
        assert first["tables"] != second["tables"]
        one.send(one.asked(slip_force=4.0))
        assert one.until("curve")["tables"] == second["tables"]


def test_a_huge_message_ends_its_page_and_no_other(explorer):
    with Page(explorer) as good, Page(explorer) as bad:
        with suppress(WebSocketClosedError):
            bad.send(json.dumps({"values": [1.0] * 1_000_000}))
        assert bad.read() is None
        good.send(good.asked())
        assert good.until("curve")["figures"]


def test_too_many_pages_are_refused(study):
    with Explorer(study) as explorer:
        pages = [Page(explorer) for _ in range(9)]
        assert "8 pages are open" in pages[-1].greeting["refused"]
        pages[0].send(pages[0].asked())
        assert pages[0].until("curve")["figures"]
        for page in pages:
            page.__exit__()


def test_a_page_that_goes_leaves_room(study):
    with Explorer(study) as explorer:
        for _ in range(12):
            with Page(explorer) as page:
                assert page.greeting["knobs"]


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_it_ends_with_a_line_while_it_computes(number, code):
    with Explorer(SLOW) as explorer, Page(explorer) as page:
        page.send(page.asked(over="tangential_stiffness"))
        while "share" not in page.read():
            pass
        assert explorer.end(number) == (code, "interrupted: the explorer has ended\n")


def test_what_does_not_end_is_left_behind():
    code = (
        "from stickslip.explore.server import _Pages\n"
        "class Deaf:\n"
        "    def end(self): pass\n"
        "    def ended(self, patience): return False\n"
        "pages = _Pages()\n"
        "pages.open.add(Deaf())\n"
        "pages.end()\n"
        "print('said')"
    )
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert (ended.returncode, ended.stdout, ended.stderr) == (130, "said\n", "")


def test_a_busy_port_is_refused_in_a_line(study):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        result = script("explore", study, "--port", port, "--no-browser")
    assert result.returncode == 2
    assert result.stderr.startswith(f"error: port {port}: Address already in use; give another")
    assert result.stderr.count("\n") == 1


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("missing.toml",), "missing.toml: no such study file"),
        (("small.toml", "--port", "65536"), "--port 65536: give a number from 0 to 65535"),
        (("small.toml", "--port", "http"), "is not a whole number"),
    ],
)
def test_what_cannot_be_explored_is_refused_in_a_line(study, arguments, said):
    result = script("explore", *arguments, "--no-browser", cwd=study.parent)
    assert result.returncode == 2
    assert said in result.stderr
    assert result.stderr.count("\n") == 1
