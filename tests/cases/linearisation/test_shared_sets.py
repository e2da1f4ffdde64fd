"""Linearisations of public turbines: set SOUTHWELL_LINEARISED to a folder with them."""

import os
from pathlib import Path

import numpy as np
import pytest

from southwell.cases.linearisation.judged import Judgement
from southwell.cases.linearisation.judgement import judge
from southwell.cases.linearisation.lin_file import read
from southwell.tests.support.linearised_page import PAGE, session, sessions

FOLDER = os.environ.get("SOUTHWELL_LINEARISED")

pytestmark = pytest.mark.skipif(not FOLDER, reason="set SOUTHWELL_LINEARISED to public linearisations")


def judged(pattern: str) -> Judgement:
    paths = sorted(Path(FOLDER or "").glob(pattern))
    if not paths:
        pytest.skip(f"SOUTHWELL_LINEARISED has no {pattern}")
    return judge(paths)


def test_a_blade_at_rest_needs_no_transformation() -> None:
    """Eigenvalues of the file's own matrix."""
    judgement = judged("nrel5mw/blade-only/*.lin")
    values = np.linalg.eigvals(read(Path(FOLDER or "") / "nrel5mw/blade-only/Main.1.lin").A)
    expected = np.sort(np.abs(values[values.imag > 0])) / (2 * np.pi)
    assert judgement.verdict == "Yes"
    assert [mode.frequency for mode in judgement.sets[0].modes] == pytest.approx(expected.tolist(), rel=1e-9)


def test_three_azimuths_in_operation_are_open() -> None:
    judgement = judged("nrel5mw/rotating/*.lin")
    assert judgement.verdict == "Open"
    assert [mode.name for mode in judgement.sets[0].modes][:3] == [
        "flapwise 1 backward",
        "flapwise 1 collective",
        "flapwise 1 forward",
    ]


def test_frequencies_are_those_of_openfast_toolbox() -> None:
    """Those of its test of reading modes; they include the acceleration of the rotor, 7e-6 rad/s², and differ by 5.4e-8."""
    expected = [
        0.587830219596616,
        0.722482755465059,
        0.841644628629986,
        0.937126199078433,
        1.237130544073060,
        1.837320640593674,
        1.986990893316201,
        2.133747228535351,
        2.256063763227361,
    ]
    modes = judged("nrel5mw/rotating/*.lin").sets[0].modes
    assert [mode.frequency for mode in modes] == pytest.approx(expected, rel=6e-8)
    assert modes[0].damping == pytest.approx(0.6310588187661754, rel=1e-6)
    assert modes[-1].damping == pytest.approx(0.02258501382142458, rel=1e-6)


def test_the_frame_of_beamdyn_is_found() -> None:
    """OpenFAST issue 3394: the correction raises the tower's side-side mode by 1.9 %, from 0.3835 to 0.3907 Hz."""
    judgement = judged("nrel5mw/5MW_Land_BD_Linear.1.lin")
    assert judgement.verdict == "No"
    assert [finding.name for finding in judgement.findings][:2] == ["frame flag", "truncated digits"]
    assert "0.3835 Hz as flagged, 0.3907 Hz corrected" in judgement.findings[0].observation
    assert judgement.findings[0].value == pytest.approx(0.0, abs=1e-3)


def test_a_floating_turbine_has_its_platform_modes() -> None:
    judgement = judged("iea15-semi/*.lin")
    names = [mode.name for mode in judgement.sets[0].modes if mode.structural > 0.5]
    assert names == ["platform surge", "platform pitch", "platform heave", "tower fore-aft 1"]
    assert judgement.verdict == "Open"


@pytest.mark.parametrize("words", [words for words, _ in sessions(PAGE.read_text(encoding="utf-8"))])
def test_sessions_of_the_page_are_as_shown(words: str) -> None:
    """``python -m southwell.tests.support.linearised_page`` writes them."""
    blocks = dict(sessions(PAGE.read_text(encoding="utf-8")))
    assert session(words, Path(FOLDER or "")) == blocks[words]
