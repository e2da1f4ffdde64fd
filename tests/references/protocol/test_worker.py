"""Questions and answers of a code in a process of its own; ``test_misdeeds`` has its failures."""

from pathlib import Path

import numpy as np
import pytest

from southwell.core.blade import uniform_blade
from southwell.core.modes import Modes
from southwell.references.protocol import registry
from southwell.references.protocol.process import Failure, Limits
from southwell.references.protocol.wire import decode_blade, decode_modes, encode
from southwell.references.protocol.worker import answers

BLADE = uniform_blade("beam", 6.0, 0.3, EA=1e7, GJ=1e3, EI_y=1 / 3, EI_z=1.4e4, mass=1.2)
RUNS = [(0.0, 10, 3), (2.0, 10, 3), (0.5, 20, 3)]


pytestmark = pytest.mark.usefixtures("importable")


def ask(attribute: str, timeout: float = 60.0) -> list[Modes | Failure]:
    return answers(f"misbehaving:{attribute}", BLADE, RUNS, Limits(timeout))


def test_answers_come_back_bit_for_bit_and_in_order() -> None:
    answer = ask("WELL_BEHAVED")
    for run, modes in zip(RUNS, answer, strict=True):
        assert isinstance(modes, Modes)
        assert (modes.omega, modes.elements, len(modes.frequencies)) == run
        np.testing.assert_array_equal(modes.shapes, np.full((3, 21, 4), 1.0 / 3.0 + 2.0j / 7.0))


def test_a_missing_code_gives_its_installation_hint() -> None:
    assert ask("ABSENT") == [Failure("not installed", "not installed: pip install manners")] * 3


def test_a_blade_is_transferred_unchanged_including_rigid_strains() -> None:
    copy = decode_blade(encode(BLADE))
    for name in ("stations", "stiffness", "mass", "twist", "curve", "tip_mass"):
        np.testing.assert_array_equal(getattr(copy, name), getattr(BLADE, name))
    assert np.isinf(copy.stiffness[0, 1, 1])
    assert (copy.name, copy.hub_radius) == ("beam", 0.3)


def test_an_empty_set_of_modes_is_transferred() -> None:
    empty = Modes(1.0, np.zeros(0), np.zeros((0, 21, 4), complex), 5)
    assert decode_modes(encode(empty)).shapes.shape == (0, 21, 4)


def test_other_packages_register_codes_by_entry_point(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Also one that is installed after the codes were first looked up, as from a notebook."""
    monkeypatch.syspath_prepend(str(tmp_path))
    assert "their-code" not in registry.names()
    info = tmp_path / "theirs-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: theirs\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text("[southwell.codes]\ntheir-code = misbehaving:WELL_BEHAVED\n")
    assert "their-code" in registry.names()
    assert registry.code("their-code").title == "Misbehaving"
