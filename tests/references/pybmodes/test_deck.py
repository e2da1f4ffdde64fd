"""pyBModes given the deck: it agrees with core through two readers, and contradicts a mistake in Southwell's."""

import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from southwell.cases.input.readers import BladeFile, Mount, reading
from southwell.cases.plan.deck_columns import PATH, deck
from southwell.core import solve
from southwell.core.blade import Blade
from southwell.references.protocol.interface import CodeError, Deck
from southwell.references.protocol.process import Limits
from southwell.references.protocol.worker import answers
from southwell.references.pybmodes.deck import CODE

from ...support import decks

pytestmark = pytest.mark.skipif(CODE.version() is None, reason=f"not installed: {CODE.hint}")

EXAMPLE = Path(__file__).parents[3] / "examples" / "nrel-5mw-blade.dat"
NREL = Mount(length=61.5, hub_radius=1.5)


def read(path: Path, mount: Mount) -> tuple[Blade, Deck]:
    result = reading(path, mount)
    return result.blade, deck(BladeFile(path, result.blade, result.source, mount))


def extrapolated(deck: Deck, blade: Blade, omega: float) -> NDArray[Any]:
    """Frequencies without the error of second order."""
    coarse, fine = (CODE.with_deck(deck).solve(blade, omega, n, 3).frequencies for n in (20, 40))
    return fine + (fine - coarse) / 3.0


def core(blade: Blade, omega: float) -> NDArray[Any]:
    return solve.modes(blade, omega, count=3, effects=CODE.effects).frequencies


@pytest.mark.parametrize(
    ("mount", "omega"), [(NREL, 1.2), (replace(NREL, hub_radius=3.0, multipliers=(1.0, 1.1, 0.9)), 0.5)]
)
def test_the_example_has_the_same_frequencies_through_both_readers(mount: Mount, omega: float) -> None:
    blade, given = read(EXAMPLE, mount)
    assert extrapolated(given, blade, omega) == pytest.approx(core(blade, omega), rel=5e-5)


def test_a_main_file_gives_length_hub_and_tip_mass(tmp_path: Path) -> None:
    decks.openfast(tmp_path)
    blade, given = read(tmp_path / "elastodyn_main.dat", Mount())
    assert "tip_mass" in str(CODE.unsupported(blade))
    light = replace(blade, tip_mass=np.zeros((6, 6)))
    assert extrapolated(given, light, 0.0) == pytest.approx(core(blade, 0.0), rel=5e-4)


def test_bmodes_files_are_read_by_pybmodes(tmp_path: Path) -> None:
    path = decks.bmodes(tmp_path)
    blade, given = read(path, Mount())
    assert "pitch" in str(CODE.unsupported(blade))
    assert given.format == "BModes"
    assert len(given.files) == 2


def test_properties_that_pybmodes_ignores_are_declined() -> None:
    blade, _ = read(EXAMPLE, replace(NREL, pitch=0.1))
    assert "pitch" in str(CODE.unsupported(blade))
    with pytest.raises(CodeError, match="no deck is given"):
        CODE.modes(blade, 0.0, 20, 3)


def test_a_changed_file_has_another_digest(tmp_path: Path) -> None:
    path = tmp_path / "blade.dat"
    shutil.copyfile(EXAMPLE, path)
    first = read(path, NREL)[1].digest
    path.write_text(path.read_text("utf-8").replace("1.04536", "1.00000"), "utf-8")
    assert read(path, NREL)[1].digest != first


def test_the_code_runs_in_its_own_process_and_a_deck_that_it_cannot_read_is_a_failure(tmp_path: Path) -> None:
    blade, given = read(EXAMPLE, NREL)
    (here,) = answers(PATH, blade, [(0.0, 20, 3)], Limits(), deck=given)
    assert here.frequencies == pytest.approx(CODE.with_deck(given).solve(blade, 0.0, 20, 3).frequencies)  # type: ignore[union-attr]
    (tmp_path / "empty.dat").write_text("nothing\n")
    (failure,) = answers(
        PATH, blade, [(0.0, 20, 3)], Limits(), deck=replace(given, files=(str(tmp_path / "empty.dat"),))
    )
    assert "ValueError" in failure.reason or "Error" in failure.reason  # type: ignore[union-attr]
