"""Results of motions in time say which contact forces they started with."""

import pytest

import stickslip as ss


def driven():
    return ss.destabilised(*ss.reference.flutter_beam(), ratio=0.15)


def said(result):
    (diagnostic,) = [one for one in result.diagnostics if one.code == "start"]
    return diagnostic


BARE = {"damper": 1e-6, "tip": 1e-6, "mode": 1e-5}


def test_classification_of_displacements_alone_says_that_forces_are_zero():
    motion = ss.classify(driven(), BARE, periods=20)
    assert said(motion).data == {"without_forces": 1}
    assert "The start was given by displacements alone" in said(motion).text
    assert motion.start.contact_force.tolist() == [0.0]


def test_classification_of_a_state_says_its_largest_force():
    model = driven()
    motion = ss.classify(model, ss.State(model, BARE, contact_force=[-24.0]), periods=20)
    assert said(motion).data == {"contact_force": 24.0}


def test_map_counts_starts_without_forces():
    model = driven()
    both = ss.basin_map(
        model, starts=[BARE, ss.State(model, BARE, contact_force=[24.0]), BARE], periods=20
    )
    found = [one.data for one in both.diagnostics if one.code == "start"]
    assert found == [{"without_forces": 2}, {"contact_force": 24.0}]
    assert "Of 3 starts 2 were given" in "".join(both.assumptions)
    axes = ss.basin_map(model, {0: [0.0, 1e-4], "tip": [0.0, 1e-3]}, periods=20)
    assert said(axes).data == {"without_forces": 4}


@pytest.mark.parametrize(
    ("start", "text"),
    [
        (None, "from rest"),
        (BARE, "with velocities and contact forces of zero"),
        ("state", "with contact forces up to 24 N"),
    ],
)
def test_transient_says_its_forces(start, text):
    model = driven()
    if start == "state":
        start = ss.State(model, BARE, contact_force=[24.0])
    run = ss.transient(model, 225.0, periods=2, start=start)
    assert text in said(run).text


def test_a_model_without_contacts_has_no_forces_to_speak_of():
    bare = ss.Model(driven().structure)
    assert "start" not in [one.code for one in ss.classify(bare, BARE, periods=20).diagnostics]
