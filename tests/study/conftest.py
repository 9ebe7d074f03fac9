"""What tests of the command share: the beam's study in a folder of its own, and its results."""

import shutil

import numpy as np
import pytest

import stickslip as ss
from beam_study import EXAMPLE, study_text


@pytest.fixture
def folder(tmp_path, monkeypatch):
    for file in ("mass.mtx", "stiffness.mtx"):
        shutil.copy(EXAMPLE / file, tmp_path)
    (tmp_path / "study.toml").write_text('name = "beam"\n' + study_text())
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    folder = tmp_path_factory.mktemp("results")
    for load in (6.563, 20.313):
        model = ss.reference.snecma_beam(load)
        omega = np.linspace(150, 250, 12)
        ss.forced_response(model, omega, 5).save(folder / f"beam-{load}.nc")
    return folder
