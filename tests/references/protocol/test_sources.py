"""Digests of sources: what a code imports from this package counts, and nothing that it uses is missed."""

import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from southwell.references.protocol import registry, sources


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A small package in place of this one."""
    for name, text in {
        "core/__init__.py": "",
        "core/a.py": "import numpy\n\ndef f():\n    from . import b\n",
        "core/b.py": "from ..references.one import X\n",
        "core/c.py": "c = 1\n",
        "references/__init__.py": "",
        "references/one/__init__.py": "X = 1\n",
        "references/one/table.toml": "x = 1\n",
        "references/one/other.py": "import southwell.core.c as c\n",
    }.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    monkeypatch.setattr(sources, "ROOT", tmp_path)
    _forget()
    yield tmp_path
    _forget()


def _forget() -> None:
    for function in (sources.digest, sources.imported, sources._file, sources._content, sources._data, sources._folder):
        function.cache_clear()


def depends(package: Path, *modules: str) -> set[str]:
    return {path.relative_to(package).as_posix() for path in sources.files(modules)}


def test_imports_are_followed_into_functions_packages_and_data(package: Path) -> None:
    assert depends(package, "southwell.core.a", "numpy") == {
        "core/__init__.py",
        "core/a.py",
        "core/b.py",
        "references/__init__.py",
        "references/one/__init__.py",
        "references/one/table.toml",
    }
    assert "core/c.py" in depends(package, "southwell.references.one.other")


@pytest.mark.parametrize("name", ["core/a.py", "core/b.py", "references/one/__init__.py", "references/one/table.toml"])
def test_a_change_of_any_of_them_changes_the_digest(package: Path, name: str) -> None:
    asked = frozenset({"southwell.core.a"})
    before = sources.digest(asked)
    with (package / name).open("a") as file:
        file.write("# changed\n")
    _forget()
    assert sources.digest(asked) != before


def test_a_change_elsewhere_does_not(package: Path) -> None:
    asked = frozenset({"southwell.core.a"})
    before = sources.digest(asked)
    (package / "core/c.py").write_text("c = 2\n")
    (package / "references/one/other.py").write_text("\n")
    _forget()
    assert sources.digest(asked) == before


PROGRAM = """
import json, sys
from importlib import import_module
from southwell.references.protocol import registry, worker, mechanism_worker
code = registry.code(sys.argv[1])
code.version()
print(json.dumps(sorted(name for name in sys.modules if name.startswith("southwell."))))
"""


@pytest.mark.slow
@pytest.mark.parametrize("name", registry.names())
def test_every_module_that_a_code_loads_counts(name: str) -> None:
    done = subprocess.run([sys.executable, "-c", PROGRAM, name], capture_output=True, text=True)
    if done.returncode:
        pytest.skip(done.stderr.strip().splitlines()[-1])
    module = registry.locate(name).partition(":")[0]
    counted = set(sources.files(sources._folder(module.rpartition(".")[0]) + sources._folder(sources.PROTOCOL)))
    compiled = {f"southwell.core.compiled.{version}" for version in ("baseline", "avx2")}
    loaded = {sources._file(one) for one in json.loads(done.stdout) if one not in compiled}
    assert len(loaded) > 10
    assert loaded <= counted
    assert sources.ROOT / "core" / "space" / "rigid.hpp" in counted


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
