"""What tests of several subjects share."""

import os
import signal
import threading

import pytest


@pytest.fixture
def ctrl_c():
    """Press Ctrl-C some seconds later, heeded as in a terminal also where the parent ignores it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    timers = []

    def press(delay):
        timers.append(threading.Timer(delay, os.kill, (os.getpid(), signal.SIGINT)))
        timers[-1].start()

    yield press
    for timer in timers:
        timer.cancel()
        timer.join()
    signal.signal(signal.SIGINT, before)
