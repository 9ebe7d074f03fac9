"""Entries of study files that are refused, each in one line."""

import pytest

from small_study import ANALYSIS, ONE_CONTACT, SMALL, STRUCTURE
from stickslip import ModelError
from stickslip.study import Study

BAD_ENTRIES = [
    # what is written, what takes its place, what the message says
    ("[structure]", "[structur]", "unknown key 'structur'; did you mean 'structure'?"),
    ("slip_force", "slipforce", "contact 1: unknown key 'slipforce'; did you mean 'slip_force'?"),
    ("amplitude", "amplitud", "force 1: unknown key 'amplitud'; did you mean 'amplitude'?"),
    ("points = 5", "pionts = 5", "analysis: omega: unknown key 'pionts'; did you mean 'points'?"),
    ("stiffness = 1e3", "", "contact 1: 'stiffness' is missing"),
    (ANALYSIS, "", "[analysis] is missing"),
    ("[analysis]", "[[analysis]]", "is not written as a table; begin it with [analysis]"),
    ("[[contact]]", "[contact]", "is not written as a table; begin it with [[contact]]"),
    ("[[force]]", "[force]", "is not written as a table; begin it with [[force]]"),
    ("[structure]", "[[structure]]", "is not written as a table; begin it with [structure]"),
    (
        STRUCTURE + ONE_CONTACT,
        "contact = [3]" + STRUCTURE,
        "contact 1 = 3 is not written as a table",
    ),
    ('law = "jenkins"', 'law = "jenkin"', "contact 1: unknown law 'jenkin'; did you mean"),
    ('law = "jenkins"', "", "contact 1: 'law' is missing; known: 'jenkins'"),
    (
        "harmonics = 3",
        'kind = "forced"',
        "analysis: unknown kind 'forced'; known: 'forced-response'",
    ),
    ("amplitude = 1", 'amplitude = "20 kg"', "force 1: amplitude = '20 kg' is not a force [N]"),
    ("amplitude = 1", 'amplitude = "20,5 N"', "force 1: amplitude = '20,5 N' has a decimal comma"),
    ("amplitude = 1", "amplitude = nan", "force 1: amplitude = nan is not finite"),
    ("amplitude = 1", "amplitude = inf", "force 1: amplitude = inf is not finite"),
    ("amplitude = 1", "amplitude = true", "force 1: amplitude = True is not a force"),
    (
        "amplitude = 1",
        "amplitude = 1\nharmonic = -1",
        "force 1: harmonic: -1 lies below 0",
    ),
    ("amplitude = 1", "amplitude = 1\nharmonic = 1.5", "harmonic: 1.5 is not an integer"),
    (
        "amplitude = 1",
        "amplitude = 1\nharmonic = 0\nphase = 1",
        "force 1: force at 'tip': phase 1 on",
    ),
    ("amplitude = 1", 'amplitude = 1\nphase = "5 %"', "phase = '5 %' is not an angle [rad]"),
    ("slip_force = 2", "slip_force = nan", "contact 1: slip_force = nan is not a number"),
    ("slip_force = 2", "slip_force = -2", "contact 1: slip_force = -2 must not be negative"),
    ("slip_force = 2", 'slip_force = 2\nname = ""', "contact 1: name = '' is empty"),
    ("stiffness = 1e3", "stiffness = -1", "contact 1: stiffness = -1 must not be negative"),
    ("stiffness = 1e3", 'stiffness = "1 kN"', "contact 1: stiffness = '1 kN' is not a stiffness"),
    ('dof = "root"', 'dof = "rot"', "contact 1: unknown dof 'rot'; did you mean 'root'?"),
    ('dof = "root"', "", "contact 1: give either 'dof', for a contact to ground, or 'dofs'"),
    ('dof = "root"', 'dof = "root"\ndofs = ["root", "tip"]', "contact 1: give either 'dof'"),
    ('dof = "root"', 'dofs = ["root"]', "contact 1: dofs"),
    (
        'dof = "root"',
        'dofs = ["tip", "tip"]',
        "contact 1: both ends at dof 'tip'; name another, or write dof = 'tip'",
    ),
    ('dof = "root"', "dof = true", "contact 1: dof = True is not a text"),
    ('dof = "tip"', 'dof = "tpi"', "force 1: unknown dof 'tpi'; did you mean 'tip'?"),
    (
        'dofs = ["root", "tip"]',
        'dofs = ["tip", "tip"]',
        "structure: dofs: 'tip' is given more than",
    ),
    ('dofs = ["root", "tip"]', 'dofs = ["tip"]', "structure: dofs: 1 names for 2 dofs"),
    ('dofs = ["root", "tip"]', 'dofs = "tip"', "structure: dofs = 'tip' is not a list"),
    ("[[2, 0.5], [0.5, 1]]", "3", "structure: mass = 3 is neither a file name, nor {file = ..."),
    ("[[2, 0.5], [0.5, 1]]", "[[2, 0.5], [0.5]]", "structure: mass has rows of different lengths"),
    (
        "[[2, 0.5], [0.5, 1]]",
        "[[2, 0.5], [0.5, nan]]",
        "structure: mass[2][2]: nan is not a finite number",
    ),
    ("[[2, 0.5], [0.5, 1]]", "[[2, 1], [0.5, 1]]", "structure: mass: 1 at ('root', 'tip') but 0.5"),
    ("[[2, 0.5], [0.5, 1]]", "[[2, 3], [3, 1]]", "structure: mass: smallest eigenvalue"),
    ("[[2, 0.5], [0.5, 1]]", "[2, 1]", "structure: mass[1] = 2 is not a list"),
    ("[[2, 0.5], [0.5, 1]]", '"mas.mtx"', "structure: mass = 'mas.mtx': no such file in /"),
    ("[[2, 0.5], [0.5, 1]]", '{fil = "m.mtx"}', "structure: mass: unknown key 'fil'; did you mean"),
    ("dofs = [", "damping = 0.01\ndofs = [", "structure: damping = 0.01 is neither a matrix, nor"),
    ("dofs = [", "damping = {modal = [0.1]}\ndofs = [", "structure: damping: 1 ratios for 2 modes"),
    (
        "dofs = [",
        'damping = {modal = "x"}\ndofs = [',
        "structure: damping.modal = 'x' is not a ratio",
    ),
    (
        "dofs = [",
        "damping = {rayleigh = {mas = 1}}\ndofs = [",
        "damping.rayleigh: unknown key 'mas'",
    ),
    ("from = 1", "from = -1", "analysis: omega.from = -1 must be positive"),
    ("from = 1", "from = 0", "analysis: omega.from = 0 must be positive"),
    ("from = 1", "from = 30", "analysis: omega: 'from' and 'to' are equal"),
    ("from = 1", 'from = "1 1/s"', "omega.from = '1 1/s' is not a frequency [rad/s]"),
    ("points = 5", 'spacing = "log"', "analysis: omega: 'spacing' needs 'points'"),
    ("points = 5", 'points = 5, spacing = "lin"', "unknown choice 'lin'; did you mean 'linear'?"),
    ("points = 5", "points = 1", "analysis: omega.points: 1 lies below 2; give at"),
    ("points = 5", "points = 5.0", "analysis: omega.points: 5.0 is not an integer"),
    ("{from = 1, to = 30, points = 5}", "[]", "analysis: omega = [] has too few entries"),
    ("{from = 1, to = 30, points = 5}", "[3, -1]", "analysis: omega[2] = -1 must be positive"),
    ("{from = 1, to = 30, points = 5}", "7", "analysis: omega = 7 is neither {from = ..., to"),
    ("harmonics = 3", "harmonics = 0", "analysis: harmonics: 0 lies below 1; give at"),
    (
        "harmonics = 3",
        'harmonics = "atuo"',
        "harmonics: unknown choice 'atuo'; did you mean 'auto'",
    ),
    ("harmonics = 3", "harmonics = true", "analysis: harmonics: True is not an integer"),
    ("harmonics = 3", "harmonics = 999", "analysis: harmonics: 999 lies above max_harmonics"),
    ("harmonics = 3", "tolerance = 2", "analysis: tolerance: 2; give a fraction"),
    ("harmonics = 3", "tolerance = 0", "analysis: tolerance: 0; give a fraction from 1e-8"),
    ("harmonics = 3", 'method = "newtn"', "method: unknown choice 'newtn'; did you mean 'newton'?"),
    ("harmonics = 3", 'residual = "centered"', "unknown choice 'centered'; did you mean 'centred'"),
    ("harmonics = 3", 'residual = "3 m"', "analysis: residual = '3 m' is not a force [N]"),
    ("harmonics = 3", 'observe = ["tpi"]', "analysis: observe[1]: unknown dof 'tpi'; did you mean"),
    ("harmonics = 3", "observe = []", "analysis: observe = [] has too few entries"),
    (
        "harmonics = 3",
        "levels = [1, 2, 1]",
        "analysis: levels holds 1 twice, to 10 digits; each level is one",
    ),
    ("harmonics = 3", "levels = [1, -2]", "analysis: levels[2] = -2 must be positive"),
    ("harmonics = 3", 'levels = ["2 N"]', "analysis: levels[1] = '2 N' is not a ratio"),
    ("harmonics = 3", '[output]\ndofs = ["tpi"]', "output: dofs[1]: unknown dof 'tpi'"),
    (
        "harmonics = 3",
        'observe = ["tip"]\n[output]\ndofs = ["root"]',
        "output: dofs[1]: 'root' is not kept; add it to 'observe' in [analysis]",
    ),
    ("harmonics = 3", '[output]\nomega_unit = "hz"', "output: omega_unit: unknown choice 'hz'"),
    (STRUCTURE, 'name = "a/b"' + STRUCTURE, "name = 'a/b' is no file name"),
    ("mass = [[", "mass = [[[", "not valid TOML"),
    ("mass = [[2", "mass = [[" + 5000 * "2", "not readable: a number is too long"),
    ("mass = ", "mass = " + 9000 * "[", "not readable: a number is too long, or lists nest"),
    (
        "[[2, 0.5], [0.5, 1]]",
        '[["2 kg", 0], [0, 1]]',
        "structure: mass[1][1]: '2 kg' is not a number; give numbers alone, in SI units or in "
        "those that 'units' in [structure] names, units = \"t-mm-s\"",
    ),
    (
        "[[2, 0.5], [0.5, 1]]",
        f"[[{10**400}, 0], [0, 1]]",
        "is too large; give a number below 1e308",
    ),
    ("[[2, 0.5], [0.5, 1]]", '"no/mas.mtx"', "/no; there is no folder"),
    ("amplitude = 1", f"amplitude = {10**400}", "is too large; write for instance '20.3 N'"),
    ("amplitude = 1", f"amplitude = 1\nharmonic = {10**400}", "too large; give at most 2147483647"),
    ("harmonics = 3", f"harmonics = {10**10}", "too large; give at most 2147483647"),
    ("harmonics = 3", f"max_harmonics = {10**10}", "too large; give at most 2147483647"),
    ("points = 5", "points = 10_000_001", "points: 10000001 is too large; give at most"),
    ("points = 5", f"points = 0x{5000 * 'f'}", "points: <int> is too large"),
    ("harmonics = 3", "levels = [1, 1.00000000000001]", "levels holds 1 twice, to 10 digits"),
    (
        "dofs = [",
        "damping = {raleigh = {mass = 1}}\ndofs = [",
        "structure: damping: unknown key 'raleigh'; did you mean 'rayleigh'?",
    ),
    (
        "dofs = [",
        "damping = {}\ndofs = [",
        "structure: damping = {} is empty; write {rayleigh = ...} or {modal = ...}",
    ),
    ('dof = "root"', "dofs = []", "contact 1: dofs = [] names 0 dofs; give two, or write dof ="),
    (
        "harmonics = 3",
        "[output]\ndofs = []",
        "output: dofs = [] has too few entries; give at least 1",
    ),
    (
        "harmonics = 3",
        'observe = ["tip", "tip"]',
        "analysis: observe[2]: 'tip' is observe[1] too; name it once",
    ),
    (
        "harmonics = 3",
        '[output]\ndofs = ["tip", "root", "tip"]',
        "output: dofs[3]: 'tip' is dofs[1] too; name it once",
    ),
    (STRUCTURE, 'name = "."' + STRUCTURE, "name = '.' is no file name"),
    (STRUCTURE, 'name = ".. "' + STRUCTURE, "name = '.. ' is no file name"),
    ("harmonics = 3", '[output]\nlength_unit = "µ"', "length_unit: unknown choice 'µ'"),
    ("harmonics = 3", "harmonics = 3\nharmonics = 5", "not valid TOML: Cannot overwrite a value"),
]


@pytest.mark.parametrize(("written", "instead", "message"), BAD_ENTRIES)
def test_a_bad_entry_is_refused_in_one_line(written, instead, message, tmp_path):
    text = SMALL.replace(written, instead, 1)
    assert text != SMALL
    with pytest.raises(ModelError) as caught:
        Study.parse(text, folder=tmp_path, source="study.toml")
    refusal = str(caught.value)
    assert refusal.startswith("study.toml: ")
    assert message in refusal
    assert "\n" not in refusal
    assert "\0" not in refusal
