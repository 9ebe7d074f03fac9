"""A law whose steps ask nobody, as factorisations, whether to go on."""

import threading
import time

import stickslip as ss


class Slow(ss.ContactLaw):
    """A spring whose steps take their time once an analysis runs."""

    pause = 0.0
    pauses = threading.Event()

    def stiffness(self):
        return [[1e3]]

    def step(self, before, after, state):
        if self.pause:
            self.pauses.set()
            time.sleep(self.pause)
        return 1e3 * after, state, ss.Tangents([[1.0]], [[0.0]], [[0.0]], [[0.0]], [[1e3]])
