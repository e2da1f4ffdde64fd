"""A folder of wheels for pip, instead of an index: releases of a tiny package that scales frequencies."""

import zipfile
from pathlib import Path

import pytest

SUPPORT = Path(__file__).parent

NAME = "tinybeam"


def wheel(folder: Path, release: str, text: str, *requires: str, name: str = NAME) -> Path:
    """Write one release, a module with ``text``."""
    info = f"{name}-{release}.dist-info"
    needs = "".join(f"Requires-Dist: {one}\n" for one in requires)
    files = {
        f"{name}.py": text,
        f"{info}/METADATA": f"Metadata-Version: 2.1\nName: {name}\nVersion: {release}\n{needs}",
        f"{info}/WHEEL": "Wheel-Version: 1.0\nGenerator: tests\nRoot-Is-Purelib: true\nTag: py3-none-any\n",
    }
    path = folder / f"{name}-{release}-py3-none-any.whl"
    with zipfile.ZipFile(path, "w") as file:
        for member, content in files.items():
            file.writestr(member, content)
        file.writestr(f"{info}/RECORD", "".join(f"{member},,\n" for member in (*files, f"{info}/RECORD")))
    return path


def source(folder: Path, release: str) -> None:
    """Write a release without a wheel: pip lists it, and must not build it."""
    (folder / f"{NAME}-{release}.tar.gz").write_bytes(b"")


def use(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, releases: dict[str, str], installed: str) -> Path:
    """Offer releases (text of the module; empty: no wheel) to pip, with one of them installed for codes.

    Returns the folder of the wheels.
    """
    wheels, here = tmp_path / "wheels", tmp_path / "installed"
    wheels.mkdir()
    for release, text in releases.items():
        path = wheel(wheels, release, text) if text else source(wheels, release)
        if path and release == installed:
            zipfile.ZipFile(path).extractall(here)
    monkeypatch.setenv("PIP_NO_INDEX", "1")
    monkeypatch.setenv("PIP_FIND_LINKS", str(wheels))
    monkeypatch.setenv("PIP_CONFIG_FILE", "/dev/null")
    monkeypatch.setenv("SOUTHWELL_CACHE", str(tmp_path / "cache"))
    monkeypatch.setenv("PYTHONPATH", f"{SUPPORT}:{here}")
    return wheels
