"""The store of answers: several writers, damage, age, and the folders and files that are refused."""

import os
import sqlite3
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from southwell.references.protocol import store
from southwell.references.protocol.store import Store


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / store.NAME


def test_several_writers_lose_nothing(file: Path) -> None:
    def write(k: int) -> None:
        own_answer = Store(file)
        for i in range(50):
            own_answer.put(f"{k}/{i}", "x", b"%d" % i)

    with ThreadPoolExecutor(4) as pool:
        list(pool.map(write, range(4)))
    (answer,) = Store(file).kept()
    assert answer.count == 200


def test_a_new_file_is_opened_by_many_at_once(tmp_path: Path) -> None:
    for n in range(20):
        new = tmp_path / f"{n}.sqlite"
        with ThreadPoolExecutor(8) as pool:
            list(pool.map(lambda _, new=new: Store(new).close(), range(8)))
        assert Store(new).kept() == []


def test_a_damaged_answer_is_found_and_removed(file: Path) -> None:
    kept = Store(file)
    kept.put("a", "x", b"1.0")
    kept.put("b", "x", b"2.0")
    sqlite3.connect(file, isolation_level=None).execute("update answers set value = '3.0' where key = 'a'")
    assert kept.damaged() == ["a"]
    with pytest.raises(KeyError):
        kept.get("a")
    assert kept.damaged() == []
    assert kept.get("b")[0] == b"2.0"


def test_prune_removes_old_answers(file: Path) -> None:
    kept = Store(file)
    kept.put("a", "x", b"1.0")
    (answer,) = kept.kept()
    assert kept.prune(answer.last - 1.0) == 0
    assert kept.prune(answer.last + 1.0) == 1
    assert kept.kept() == []


def test_a_file_that_has_grown_too_large_loses_its_older_half(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    kept = Store(file)
    for k in range(8):
        kept.put(str(k), "x", b"0" * 10_000)
        kept.base.execute("update answers set computed = ? where key = ?", (float(k), str(k)))
    kept.close()
    assert Store(file).kept()[0].count == 8
    monkeypatch.setattr(store, "MAX_BYTES", 50_000)
    (remainder,) = Store(file).kept()
    assert (remainder.count, remainder.first) == (4, 4.0)


def test_an_answer_that_cannot_be_written_is_an_error(file: Path) -> None:
    kept = Store(file)
    kept.base.execute("pragma max_page_count = 4")
    with pytest.raises(store.StoreError, match="full"):
        kept.put("a", "x", b"0" * 100_000)
    assert kept.kept() == []


@pytest.mark.skipif(os.name == "nt", reason="POSIX modes")
def test_a_folder_that_others_can_write_to_has_no_store(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "open").mkdir()
    (tmp_path / "open").chmod(0o777)
    monkeypatch.setenv("SOUTHWELL_CACHE", str(tmp_path / "open"))
    with pytest.raises(OSError, match="only this user"):
        store.users()


def test_a_file_of_another_format_is_refused(file: Path) -> None:
    file.write_text("not a database, " * 100)
    with pytest.raises(OSError, match="not a database"):
        Store(file)
