"""Damaged files: a lost line or a cut never gives another blade without a word, and nothing in a file gives a traceback."""

import random
import shutil
from pathlib import Path

import numpy as np
import pytest

from southwell.cases.input import readers
from southwell.cases.input.errors import CaseError
from southwell.cases.input.readers import Mount, Reading, matrices
from southwell.tests.support.blade_files import assert_same, samples, written

DATA = Path(__file__).parents[3] / "data" / "blades"

SETS: dict[str, tuple[str, ...]] = {
    "elastodyn_main.dat": ("elastodyn_main.dat", "elastodyn_blade.dat"),
    "beamdyn_main.dat": ("beamdyn_main.dat", "beamdyn_blade.dat"),
    "beamdyn_old_main.dat": ("beamdyn_old_main.dat",),
    "bmodes.bmi": ("bmodes.bmi", "bmodes_sections.dat"),
    "hawc2.htc": ("hawc2.htc", "hawc2_st.dat"),
    "windio.yaml": ("windio.yaml",),
}
"""The file that is read, and those that it needs, each to be damaged."""

PAIRS = [(first, damaged) for first, needed in SETS.items() for damaged in needed]

WORDS = (
    "nan",
    "inf",
    "-1",
    "0",
    "x",
    "",
    "1e400",
    '"',
    "1.0D+03",
    "-",
    "99999999",
    "0.5",
    ",",
    "#",
    "-1e9",
    "\t",
    "{",
    "[",
    "!a",
)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    shutil.copytree(DATA, tmp_path / "it")
    written(tmp_path / "it" / "windio.yaml", samples()[1])
    return tmp_path / "it"


def read(path: Path) -> Reading | None:
    """What is read, or None if it is refused, in one line that names a file of the folder."""
    try:
        return readers.reading(path, Mount())
    except CaseError as error:
        message = str(error)
    assert "\n" not in message
    assert message.startswith(str(path.parent))
    return None


def honest(whole: Reading, damaged: Reading) -> bool:
    """Whether the blade is the same, or the notes say what is not."""
    try:
        assert_same(whole.blade, damaged.blade)
    except AssertionError:
        return set(damaged.source.notes) != set(whole.source.notes)
    return True


@pytest.mark.parametrize(("first", "damaged"), PAIRS)
def test_a_file_without_one_line_is_refused_or_gives_the_same_blade(folder: Path, first: str, damaged: str) -> None:
    whole = readers.reading(folder / first)
    lines = (folder / damaged).read_text().splitlines()
    refused = 0
    for k in range(len(lines)):
        (folder / damaged).write_text("\n".join(lines[:k] + lines[k + 1 :]) + "\n")
        content = read(folder / first)
        refused += content is None
        if content is not None:
            assert honest(whole, content), f"without line {k + 1}: {lines[k]}"
    assert refused > 3


@pytest.mark.parametrize(("first", "damaged"), PAIRS)
def test_a_truncated_file_is_refused_or_gives_the_same_blade(folder: Path, first: str, damaged: str) -> None:
    whole = readers.reading(folder / first)
    lines = (folder / damaged).read_text().splitlines()
    for k in range(len(lines)):
        (folder / damaged).write_text("\n".join(lines[:k]) + "\n")
        content = read(folder / first)
        if content is not None:
            assert honest(whole, content), f"cut before line {k + 1}: {lines[k]}"


@pytest.mark.parametrize(("first", "damaged"), PAIRS)
def test_no_word_in_a_file_gives_a_traceback(folder: Path, first: str, damaged: str) -> None:
    random.seed(f"{first} {damaged}")
    text = (folder / damaged).read_text().splitlines()
    refused = 0
    for _ in range(60):
        lines = list(text)
        k = random.randrange(len(lines))
        words = lines[k].split(" ")
        words[random.randrange(len(words))] = random.choice(WORDS)
        lines[k] = " ".join(words)
        (folder / damaged).write_text("\n".join(lines) + "\n")
        refused += read(folder / first) is None
    assert refused > 3


@pytest.mark.filterwarnings("error")
def test_numbers_near_the_smallest_float_hide_no_fault() -> None:
    mass = np.diag([1e-320, 1e-320, 1e-320, 0.0, 0.0, 0.0])
    mass[3, 4] = 1.0
    assert "entries (4, 5) and (5, 4) are 1 and 0" in (matrices.mass_fault(mass) or "")
    stiffness = np.diag([1e-320, 1.0, 1.0, 1.0, 1.0, 1.0])
    stiffness[0, 1] = stiffness[1, 0] = 1e200
    assert "far too small for its row" in (matrices.fault(stiffness) or "")
