"""What tests of figures share: axes, and a response to draw."""

import numpy as np
import pytest
from matplotlib import pyplot as plt
from matplotlib.figure import Figure

import stickslip as ss
from stickslip.reference import snecma_beam


@pytest.fixture
def ax():
    """Axes that pyplot does not know, drawn at the end so that every warning shows."""
    figure = Figure(layout="constrained")
    yield figure.add_subplot()
    figure.canvas.draw()
    assert not plt.get_fignums()


@pytest.fixture(scope="session")
def frf():
    return ss.forced_response(snecma_beam(), np.linspace(150.0, 250.0, 60), harmonics=9)
