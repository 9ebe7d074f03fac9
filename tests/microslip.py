"""A small structure and joints without sliders, shared by the tests of such laws."""

from __future__ import annotations

import numpy as np

import stickslip as ss

LAW = {"stiffness": 3e3, "slip_force": 4.0}


def structure(size=2, damping=0.003):
    stiffness = 1.2e4 * np.eye(size) - 2e3 * (np.eye(size, k=1) + np.eye(size, k=-1))
    return ss.Structure(np.eye(size), stiffness, ss.ModalDamping(damping), list("abcd")[:size])


def iwan(*ends, chi=-0.5, beta=0.0, **options):
    return ss.Iwan(*(ends or ("a",)), **LAW | options, chi=chi, beta=beta)


def exponential(*ends, **options):
    return ss.Masing(*(ends or ("a",)), **LAW | options, backbone="exponential")
