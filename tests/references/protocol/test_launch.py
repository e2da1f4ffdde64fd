"""The process that forks serves every start; a killed one costs that start only, and one in other surroundings none."""

from pathlib import Path

import pytest

from southwell.references.protocol import launch
from southwell.references.protocol.description import describe
from southwell.references.protocol.registry import UnknownCodeError


def test_one_forker_serves_every_start() -> None:
    prepared = launch.prepare()
    for _ in range(2):
        (description_,) = describe(["exact-beam"])
        assert description_.failure is None
        assert launch.prepare() is prepared
    assert prepared.process.poll() is None


def test_a_killed_forker_is_replaced() -> None:
    prepared = launch.prepare()
    prepared.process.kill()
    prepared.process.wait()
    (description_,) = describe(["exact-beam"])
    assert description_.failure is None
    assert launch.prepare() is not prepared


def test_a_changed_environment_or_folder_replaces_the_forker(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    prepared = launch.prepare()
    (tmp_path / "elsewhere.py").write_text("CODE = 1\n")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    with pytest.raises(UnknownCodeError, match="not an adapter"):  # and not: no module named elsewhere
        describe(["elsewhere:CODE"])
    assert prepared.process.returncode is not None
