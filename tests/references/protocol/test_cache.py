"""Folders that nobody else can write to: created so, and used only then."""

import os
from pathlib import Path

import pytest

from southwell.references.protocol.cache import private_folder

posix = pytest.mark.skipif(os.name == "nt", reason="modes and owners of POSIX")


@posix
def test_a_new_folder_is_private(tmp_path: Path) -> None:
    made = private_folder(tmp_path / "cache", "compiled")
    assert made is not None
    assert made.stat().st_mode & 0o777 == 0o700


@posix
@pytest.mark.parametrize("mode", [0o777, 0o770, 0o702])
def test_a_folder_that_others_can_write_to_is_not_used(tmp_path: Path, mode: int) -> None:
    (tmp_path / "compiled").mkdir()
    (tmp_path / "compiled").chmod(mode)
    assert private_folder(tmp_path, "compiled") is None


@posix
def test_a_folder_that_others_can_replace_is_not_used(tmp_path: Path) -> None:
    place = tmp_path / "place"
    place.mkdir()
    place.chmod(0o777)
    assert private_folder(place, "compiled") is None
    place.chmod(0o1777)  # as /tmp
    assert private_folder(place, "compiled") is not None


@posix
def test_a_link_or_a_folder_of_another_user_is_not_used(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "real").mkdir(mode=0o700)
    (tmp_path / "link").symlink_to(tmp_path / "real")
    assert private_folder(tmp_path, "link") is None
    monkeypatch.setattr(os, "geteuid", lambda: os.getuid() + 1)
    assert private_folder(tmp_path, "real") is None
