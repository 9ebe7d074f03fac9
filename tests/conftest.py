"""What tests of several subjects share."""

import os
import signal
import sys
import threading

os.environ["MPLBACKEND"] = "agg"  # no test opens a window, nor does a command that it runs
# Tests run on every core: threads of small products would wait for each other.
os.environ["OPENBLAS_NUM_THREADS"] = "1"

# Heeded as in a terminal also where the parent ignores it: by tests, and by commands that they run.
signal.signal(signal.SIGINT, signal.default_int_handler)

import hypothesis
import numpy as np
import pytest

# A busy machine is no failure.
hypothesis.settings.register_profile("untimed", deadline=None)
hypothesis.settings.load_profile("untimed")


@pytest.fixture(autouse=True)
def nothing_stays():
    """Close the figures of a test, and print as NumPy does: pyyeti changes it for all."""
    with np.printoptions(legacy=False):
        yield
    if pyplot := sys.modules.get("matplotlib.pyplot"):
        pyplot.close("all")


@pytest.fixture
def ctrl_c():
    """Press Ctrl-C some seconds later."""
    timers = []

    def press(delay):
        timers.append(threading.Timer(delay, os.kill, (os.getpid(), signal.SIGINT)))
        timers[-1].start()

    yield press
    for timer in timers:
        timer.cancel()
        timer.join()
