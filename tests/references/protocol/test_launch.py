"""A process that is prepared serves one start, and a killed one costs that start only."""

from pathlib import Path

import pytest

from southwell.references.protocol import launch
from southwell.references.protocol.description import describe
from southwell.references.protocol.registry import UnknownCodeError


@pytest.fixture(autouse=True)
def prepared():
    """One prepared process; none is left."""
    launch.prepare()
    (one,) = launch._prepared
    yield one
    launch._prepared.clear()
    one.close()


def test_it_serves_one_start(prepared: launch._Forker) -> None:
    launch.prepare()
    assert list(launch._prepared) == [prepared]
    for _ in range(2):
        (said,) = describe(["exact-beam"])
        assert said.failure is None
        assert not launch._prepared
        assert prepared.process.returncode is not None  # it ends with what it has started


def test_without_it_the_code_is_asked_again(prepared: launch._Forker) -> None:
    prepared.process.kill()
    prepared.process.wait()
    (said,) = describe(["exact-beam"])
    assert said.failure is None


def test_it_does_not_serve_a_start_in_other_surroundings(
    prepared: launch._Forker, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "elsewhere.py").write_text("CODE = 1\n")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    with pytest.raises(UnknownCodeError, match="not an adapter"):  # and not: no module named elsewhere
        describe(["elsewhere:CODE"])
    assert prepared.process.returncode is not None
