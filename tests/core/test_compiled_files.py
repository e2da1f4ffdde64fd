"""Compiled code is loaded only from folders that nobody else can write to, and only from undamaged files."""

import os
import pickle
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from southwell.core import compiled, compiled_files, first_use, regular_files

posix = pytest.mark.skipif(os.name == "nt", reason="modes and owners of POSIX")


@posix
def test_a_new_folder_is_private(tmp_path: Path) -> None:
    made = compiled_files.folder(tmp_path / "cache", "compiled")
    assert made is not None
    assert made.stat().st_mode & 0o777 == 0o700


@posix
@pytest.mark.parametrize("mode", [0o777, 0o770, 0o702])
def test_a_folder_that_others_can_write_to_is_not_used(tmp_path: Path, mode: int) -> None:
    (tmp_path / "compiled").mkdir()
    (tmp_path / "compiled").chmod(mode)
    assert compiled_files.folder(tmp_path, "compiled") is None


@posix
def test_a_folder_that_others_can_replace_is_not_used(tmp_path: Path) -> None:
    place = tmp_path / "place"
    place.mkdir()
    place.chmod(0o777)
    assert compiled_files.folder(place, "compiled") is None
    place.chmod(0o1777)  # as /tmp
    assert compiled_files.folder(place, "compiled") is not None


@posix
def test_a_link_or_a_folder_of_another_user_is_not_used(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "real").mkdir(mode=0o700)
    (tmp_path / "link").symlink_to(tmp_path / "real")
    assert compiled_files.folder(tmp_path, "link") is None
    monkeypatch.setattr(os, "geteuid", lambda: os.getuid() + 1)
    assert compiled_files.folder(tmp_path, "real") is None


SCRIPT = """
from southwell.core import compiled, compiled_files
from pathlib import Path
compiled._folder = lambda: Path({folder!r})
exec(compile("def double(x):\\n    return 2.0 * x\\n", {source!r}, "exec"))
f = compiled.compiled(double)
assert f(21.0) == 42.0
print(sum(f.stats.cache_hits.values()))
"""


@pytest.mark.slow
@pytest.mark.parametrize("ending", ["nbi", "nbc"])
@pytest.mark.parametrize("damage", [lambda c: c[: len(c) // 2], lambda c: b"", lambda c: c[:-1] + b"\0"])
def test_a_damaged_file_is_compiled_again(tmp_path: Path, ending: str, damage) -> None:
    (tmp_path / "cache").mkdir(mode=0o700)
    (tmp_path / "source.py").write_text("def double(x):\n    return 2.0 * x\n")
    script = SCRIPT.format(folder=str(tmp_path / "cache"), source=str(tmp_path / "source.py"))

    def hits() -> int:
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return int(done.stdout)

    assert [hits(), hits()] == [0, 1]
    (found,) = (tmp_path / "cache").rglob(f"*.{ending}")
    found.write_bytes(damage(found.read_bytes()))
    assert [hits(), hits()] == [0, 1]


def test_an_unverified_file_is_not_unpickled(tmp_path: Path) -> None:
    class Trap:
        def __reduce__(self):
            return os.mkdir, (str(tmp_path / "sprung"),)

    files = compiled_files.CheckedFiles(str(tmp_path), "f", "stamp")
    (tmp_path / "f.nbi").write_bytes(pickle.dumps(Trap()))
    assert files.load("key") is None
    assert not (tmp_path / "sprung").exists()


def test_compiled_code_is_invalidated_by_a_change(tmp_path: Path) -> None:
    """A compiled function calls one of another file; when that changes, the caller must be compiled again."""
    package = tmp_path / "loops"
    package.mkdir()
    for module in (compiled, compiled_files, first_use, regular_files):
        shutil.copy(str(module.__file__), package)
    (package / "__init__.py").touch()
    (package / "outer.py").write_text(
        "from . import inner\nfrom .compiled import compiled\n\n@compiled\ndef outer(x):\n    return inner.inner(x) + 1.0\n"
    )

    def found(expression: str) -> float:
        (package / "inner.py").write_text(
            f"from .compiled import compiled\n\n@compiled\ndef inner(x):\n    return {expression}\n"
        )
        code = "from loops.outer import outer; print(outer(3.0))"
        run = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True)
        return float(run.stdout)

    assert [found("2.0 * x"), found("5.0 * x")] == [7.0, 16.0]
    assert len(list((package / "__pycache__").glob("compiled-*"))) == 1  # the old one is deleted
