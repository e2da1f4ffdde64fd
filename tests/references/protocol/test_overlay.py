"""Other releases of a code: installed beside, searched first, and refused in one line if pip cannot have them."""

import sys
from pathlib import Path

import numpy as np
import pytest

from southwell.references.protocol import overlay, registry
from southwell.references.protocol.description import describe
from southwell.references.protocol.overlay import ReleaseError
from southwell.references.protocol.registry import UnknownCodeError, at_release

from ...support import wheelhouse
from ...support.wheelhouse import NAME

pytestmark = pytest.mark.slow

RELEASES = {"1.0": "FACTOR = 1.0", "1.9": "FACTOR = 1.9", "1.10": "FACTOR = 1.1", "1.9.5": ""}


@pytest.fixture(autouse=True)
def wheels(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    return wheelhouse.use(tmp_path, monkeypatch, RELEASES, installed="1.0")


def test_releases_are_in_the_order_of_their_versions() -> None:
    assert overlay.releases(NAME) == ["1.0", "1.9", "1.9.5", "1.10"]
    with pytest.raises(ReleaseError, match="nowhere: pip index: No matching distribution found for nowhere"):
        overlay.releases("nowhere")


def test_a_release_is_installed_once_and_an_incomplete_one_again() -> None:
    folder = overlay.install(NAME, "1.9")
    assert folder == overlay.folder("TinyBeam", "1.9")
    assert (folder / "tinybeam.py").read_text() == RELEASES["1.9"]
    (folder / "tinybeam.py").write_text("FACTOR = 2.0")
    overlay.install(NAME, "1.9")
    assert (folder / "tinybeam.py").read_text() == "FACTOR = 2.0"
    (folder / overlay.READY).unlink()
    overlay.install(NAME, "1.9")
    assert (folder / "tinybeam.py").read_text() == RELEASES["1.9"]


def test_the_libraries_of_core_are_shared(wheels: Path) -> None:
    """NumPy is a dependency, satisfied by the installed one: it is neither fetched nor installed beside."""
    here = np.__version__
    wheelhouse.wheel(wheels, "2.0", "FACTOR = 1.0", "numpy>=1")
    wheelhouse.wheel(wheels, here, "", name="numpy")  # for pip to resolve; it is not to be installed
    folder = overlay.install(NAME, "2.0")
    assert (folder / overlay.READY).read_text() == f"{NAME}==2.0\n"
    assert not list(folder.glob("numpy*"))
    wheelhouse.wheel(wheels, "3.0", "FACTOR = 1.0", "numpy<1")
    with pytest.raises(ReleaseError, match=r"tinybeam==3\.0: pip install: .*numpy<1"):
        overlay.install(NAME, "3.0")


@pytest.mark.parametrize("release", ["1.9.5", "7.0"])
def test_a_release_without_a_wheel_is_refused_in_one_line(release: str) -> None:
    with pytest.raises(ReleaseError, match=f"tinybeam=={release}: pip install: No matching distribution") as refused:
        overlay.install(NAME, release)
    assert "\n" not in str(refused.value)
    assert not overlay.folder(NAME, release).exists()


def test_a_code_at_a_release_uses_it_and_the_code_itself_does_not() -> None:
    overlay.install(NAME, "1.9")
    asked = at_release("tiny:CODE", NAME, "1.9")
    mine, other = describe(["tiny:CODE", asked])
    assert (mine.name, mine.version, mine.distribution) == ("tiny", "1.0", NAME)
    assert (other.name, other.version, other.asked) == ("tiny@1.9", "1.9", asked)
    assert registry.cap(other) == registry.cap(mine)


def test_a_release_that_is_not_there_is_not_the_installed_one() -> None:
    (found,) = describe([at_release("tiny:CODE", NAME, "1.9")])
    assert found.failure
    assert (found.name, found.failure.kind) == ("tiny:CODE@1.9", "not installed")
    for name in ("tiny:CODE@", "scikit-fem@tinybeam", "scikit-fem@tinybeam==x"):
        with pytest.raises(UnknownCodeError, match="--against-version"):
            describe([name])


def test_a_code_that_another_release_breaks_is_described_with_its_failure(wheels: Path) -> None:
    """Its adapter imports what that release does not have; at the installed release it would be a wrong path."""
    (wheels.parent / "installed" / "needy.py").write_text("from tinybeam import FACTOR\nfrom tiny import CODE\n")
    wheelhouse.wheel(wheels, "1.11", "OTHER = 1.0")
    overlay.install(NAME, "1.11")
    mine, other = describe(["needy:CODE", at_release("needy:CODE", NAME, "1.11")])
    assert mine.failure is None
    assert other.failure
    assert "cannot import name 'FACTOR'" in other.failure.reason


def test_path_files_of_a_release_are_used_before_those_of_the_environment(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Packages such as Pinocchio extend the path by a module that the environment has already loaded."""
    folder = tmp_path / "release"
    (folder / "prefix").mkdir(parents=True)
    (folder / "extend_it.py").write_text(f"import sys\nsys.path.append({str(folder / 'prefix')!r})")
    (folder / "extend_it.pth").write_text("import extend_it")
    monkeypatch.setitem(sys.modules, "extend_it", sys)
    monkeypatch.setattr(sys, "path", list(sys.path))
    overlay.search_first(folder)
    assert sys.path[:2] == [str(folder), str(folder / "prefix")]
    monkeypatch.delitem(sys.modules, "extend_it")
