"""Digests of sources: every file that determines answers counts, and the package of a code from elsewhere."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from southwell.references.protocol import sources


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A small package in place of this one."""
    for name in ("core/a.py", "core/b.hpp", "references/table.toml", "cases/data/c.csv", "reports/d.py"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("x = 1\n")
    monkeypatch.setattr(sources, "ROOT", tmp_path)
    sources.package.cache_clear()
    yield tmp_path
    sources.package.cache_clear()


def digest() -> str:
    sources.package.cache_clear()
    return sources.package()


@pytest.mark.parametrize(
    "name", ["core/a.py", "core/b.hpp", "references/table.toml", "cases/data/c.csv", "reports/d.py"]
)
def test_a_change_of_any_file_changes_the_digest(package: Path, name: str) -> None:
    before = digest()
    with (package / name).open("a") as file:
        file.write("# changed\n")
    assert digest() != before


def test_a_file_that_moves_or_appears_changes_the_digest(package: Path) -> None:
    digests = {digest()}
    (package / "core/a.py").rename(package / "core/c.py")
    digests.add(digest())
    (package / "core/new.py").write_text("")
    digests.add(digest())
    assert len(digests) == 3


def test_a_library_s_version_changes_the_digest(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    before = digest()
    monkeypatch.setattr(sources, "version", lambda name: "0.0")
    assert digest() != before


def test_files_written_by_a_run_do_not_change_the_digest(package: Path) -> None:
    before = digest()
    (package / "reports/out").mkdir()
    (package / "reports/out/report.md").write_text("# Report\n")
    (package / "reports/out/results.jsonl").write_text("{}\n")
    assert digest() == before


def test_codes_of_others_have_the_digest_of_their_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "theirs").mkdir()
    (tmp_path / "theirs" / "__init__.py").write_text("")
    (tmp_path / "theirs" / "deep.py").write_text("x = 1\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    before = sources.adapter("theirs:CODE")
    (tmp_path / "theirs" / "deep.py").write_text("x = 2\n")
    assert sources.adapter("theirs:CODE") != before
    assert not sources.bundled("theirs:CODE")
    assert sources.bundled("exact-beam")
    assert sources.adapter("exact-beam") == sources.package()
