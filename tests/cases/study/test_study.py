"""A study's answers, its file, and what happens when it is stopped."""

import tracemalloc
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Future
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest

from southwell.cases.campbell.sweep import sweep
from southwell.cases.input import library
from southwell.cases.input.errors import CaseError
from southwell.cases.run.executors import Serial
from southwell.cases.study.journal import StudyJournal, read
from southwell.cases.study.plan import header
from southwell.cases.study.rows import Row, Task
from southwell.cases.study.run import run
from southwell.cases.study.statistics import outcome, spreads
from southwell.references.protocol import sources

from ...support.studies import solved, stub, study, text

STIFFER = """
name = "stiffer"
blades = ["park-cantilever"]
modes = 4
[speeds]
rad_s = [0.0]
[properties.EI_flap]
distribution = "values"
values = [4.0]
"""


def rows(path: Path) -> list[Row]:
    return list(read(path))


def test_four_times_the_flapwise_stiffness_doubles_the_flapwise_frequencies_at_rest(tmp_path: Path) -> None:
    """ω ∝ √EI of a uniform beam at rest; edgewise frequencies do not change."""
    solved(study(tmp_path, STIFFER), tmp_path / "out.jsonl")
    nominal = {
        r.name: r.frequency for r in next(sweep(library.load("park-cantilever").variants[0].blade, [0.0], None, 4))
    }
    result = {r.name: r.frequency_rad_s for r in rows(tmp_path / "out.jsonl")}
    for name, ratio in (("flapwise 1", 2.0), ("edgewise 1", 1.0)):
        assert result[name] == pytest.approx(ratio * nominal[name], rel=2e-6)  # both solved to 1e-6


def test_every_sample_speed_and_mode_has_a_row(tmp_path: Path) -> None:
    design = study(tmp_path)
    solved(design, tmp_path / "out.jsonl")
    result = rows(tmp_path / "out.jsonl")
    assert sorted((r.sample, r.omega_rad_s, r.mode) for r in result) == [
        (sample, omega, mode) for sample in range(6) for omega in (0.0, 10.0) for mode in (1, 2, 3)
    ]
    assert all(r.frequency_hz == pytest.approx(r.frequency_rad_s / (2 * np.pi)) for r in result)  # type: ignore[operator]
    assert all(r.relative_uncertainty is not None and 0 < r.relative_uncertainty < 0.1 for r in result)


def test_a_speed_without_a_steady_state_costs_its_own_row_only(tmp_path: Path) -> None:
    """An articulated blade has no stable state at rest; the later speeds are those of a study without rest."""
    text = 'name = "hinged"\nblades = ["articulated/hinged"]\nmodes = 3\n[speeds]\nrad_s = {}\n'
    name = next(v.name for v in library.load("articulated").variants)
    text = text.replace("articulated/hinged", name)
    solved(study(tmp_path, text.format("[0.0, 5.0, 10.0]")), tmp_path / "all.jsonl")
    solved(study(tmp_path, text.format("[5.0, 10.0]")), tmp_path / "later.jsonl")
    first, *later = rows(tmp_path / "all.jsonl")
    assert first.reason is not None
    assert "hinge" in first.reason
    assert (first.omega_rad_s, first.mode, first.frequency_hz) == (0.0, None, None)
    assert [(r.mode, r.frequency_rad_s) for r in later] == [
        (r.mode, r.frequency_rad_s) for r in rows(tmp_path / "later.jsonl")
    ]


def test_a_factor_that_is_not_positive_gives_the_reason_at_every_speed(tmp_path: Path) -> None:
    wide = text(samples=8).replace("standard_deviation = 0.05", "standard_deviation = 2.0")
    solved(study(tmp_path, wide), tmp_path / "out.jsonl")
    result = rows(tmp_path / "out.jsonl")
    negative = [r for r in result if r.properties["EI_flap"] <= 0]
    assert {r.sample for r in negative} != set()
    assert all("factor is positive" in (r.reason or "") and r.frequency_hz is None for r in negative)
    assert len(negative) == 2 * len({r.sample for r in negative})
    counts = outcome(result)
    assert (counts.missing, counts.frequencies) == (len(negative), len(result) - len(negative))


def test_a_defect_of_the_solver_costs_rows_and_is_counted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: Any) -> Any:
        raise IndexError("out of range")
        yield

    monkeypatch.setattr("southwell.cases.study.rows.sweep", broken)
    solved(study(tmp_path, samples=2), tmp_path / "out.jsonl")
    assert outcome(rows(tmp_path / "out.jsonl")).internal == 4


class Stopping(Serial):
    """Breaks at one of its tasks."""

    def __init__(self, at: int) -> None:
        self.remaining = at

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        self.remaining -= 1
        if self.remaining < 0:
            future: Future[Any] = Future()
            future.set_exception(BrokenExecutor("killed"))
            return future
        return super().submit(fn, *args, **kwargs)


@pytest.mark.parametrize("at", [0, 1, 4])
def test_a_stopped_study_continues_without_solving_again(at: int, tmp_path: Path) -> None:
    design, samples = study(tmp_path), []

    def counted(task: Task) -> bytes:
        samples.append(task.sample)
        return stub(task)

    with pytest.raises(BrokenExecutor):
        solved(design, tmp_path / "out.jsonl", Stopping(at), answer=counted)
    assert solved(design, tmp_path / "out.jsonl", answer=counted) == solved(
        design, tmp_path / "whole.jsonl", answer=stub
    )
    assert sorted(samples) == list(range(6))


class BrokenFirst(Serial):
    """Loses the first task, and no other."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        if args[0].sample:
            return super().submit(fn, *args, **kwargs)
        future: Future[Any] = Future()
        future.set_exception(BrokenExecutor("killed"))
        return future


def test_answers_that_arrived_before_the_study_stopped_are_kept(tmp_path: Path) -> None:
    design = study(tmp_path)
    with pytest.raises(BrokenExecutor):
        solved(design, tmp_path / "out.jsonl", BrokenFirst(), answer=stub)
    assert {row.sample for row in rows(tmp_path / "out.jsonl")} == {1, 2, 3, 4, 5}


@pytest.mark.parametrize("cut", [1, 60, 400, 2000])
def test_a_truncated_file_continues_as_if_it_had_not_been(cut: int, tmp_path: Path) -> None:
    design, path = study(tmp_path), tmp_path / "out.jsonl"
    whole = solved(design, path, answer=stub)
    path.write_bytes(path.read_bytes()[:-cut])
    assert solved(design, path, answer=stub) == whole


def test_a_truncated_header_is_written_again(tmp_path: Path) -> None:
    design, path = study(tmp_path), tmp_path / "out.jsonl"
    whole = solved(design, path, answer=stub)
    path.write_bytes(path.read_bytes()[:40])
    assert solved(design, path, answer=stub) == whole


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"seed": 2}, "of another study"),
        ({"samples": 7}, "of another study"),
        ({"modes": 4}, "of another study"),
        ({"blade": "tip-mass"}, "of another study"),
    ],
)
def test_the_file_of_another_study_is_refused_and_unchanged(
    change: dict[str, Any], message: str, tmp_path: Path
) -> None:
    path = tmp_path / "out.jsonl"
    solved(study(tmp_path), path, answer=stub)
    before = path.read_bytes()
    with pytest.raises(CaseError, match=message):
        solved(study(tmp_path, **change), path, answer=stub)
    assert path.read_bytes() == before


@pytest.mark.parametrize(("before", "after"), [("0.05", "0.06"), ("elements = 8", "elements = 9"), ("10.0", "10.5")])
def test_the_file_of_a_changed_study_is_refused(before: str, after: str, tmp_path: Path) -> None:
    path = tmp_path / "out.jsonl"
    solved(study(tmp_path), path, answer=stub)
    with pytest.raises(CaseError, match="of another study: the study file or a blade has changed"):
        solved(study(tmp_path, text().replace(before, after)), path, answer=stub)


def test_the_file_of_another_version_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    design = study(tmp_path)
    solved(design, tmp_path / "out.jsonl", answer=stub)
    monkeypatch.setattr(sources, "package", lambda: "other")
    with pytest.raises(CaseError, match="another version of Southwell or its libraries"):
        solved(design, tmp_path / "out.jsonl", answer=stub)


@pytest.mark.parametrize("content", [b"notes\n", b"notes without an end", b'{"study": 1}\n', b"\0" * 100])
def test_another_kind_of_file_is_refused_and_unchanged(content: bytes, tmp_path: Path) -> None:
    path = tmp_path / "out.jsonl"
    path.write_bytes(content)
    with pytest.raises(CaseError, match="not the file of a study"):
        solved(study(tmp_path), path, answer=stub)
    assert path.read_bytes() == content


def test_a_damaged_or_repeated_line_is_refused_by_its_number(tmp_path: Path) -> None:
    design, path = study(tmp_path), tmp_path / "out.jsonl"
    solved(design, path, answer=stub)
    content = path.read_bytes().splitlines(keepends=True)
    path.write_bytes(b"".join([*content[:3], b"noise\n", *content[4:]]))
    with pytest.raises(CaseError, match="line 4: not a row"):
        solved(design, path, answer=stub)
    path.write_bytes(b"".join([*content[:3], *content[4:]]))
    with pytest.raises(CaseError, match=r"line 4: sample 0 .* gap"):
        solved(design, path, answer=stub)
    path.write_bytes(b"".join([*content, *content[1:7]]))
    with pytest.raises(CaseError, match=rf"line {len(content) + 1}: sample 0 .* twice"):
        solved(design, path, answer=stub)


def test_two_processes_cannot_write_to_one_file(tmp_path: Path) -> None:
    head = header(study(tmp_path))
    with (
        StudyJournal(tmp_path / "out.jsonl", head),
        pytest.raises(CaseError, match="another study is writing"),
        StudyJournal(tmp_path / "out.jsonl", head),
    ):
        pass


class Counting(Serial):
    """Counts the tasks."""

    submitted = 0

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        self.submitted += 1
        return super().submit(fn, *args, **kwargs)


def test_no_more_tasks_than_the_window_are_ahead(tmp_path: Path) -> None:
    executor, ahead = Counting(), []
    design = study(tmp_path, samples=50)
    with StudyJournal(tmp_path / "out.jsonl", header(design)) as journal:
        run(design, executor, journal, lambda done: ahead.append(executor.submitted - done), stub, window=7)
    assert executor.submitted == 50
    assert max(ahead) < 7  # reported after an answer is written and before the next task is submitted
    assert sum(k == 6 for k in ahead) > 30


def peak(folder: Path, samples: int) -> int:
    """Largest memory, bytes, of a run with six answers per sample, and of opening its file again."""
    design = study(folder, samples=samples)
    tracemalloc.start()
    try:
        for _ in range(2):
            with StudyJournal(folder / "out.jsonl", header(design)) as journal:
                run(design, Serial(), journal, answer=stub, window=16)
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def test_memory_does_not_grow_with_the_number_of_answers(tmp_path: Path) -> None:
    """Ten times the answers may take the memory of their sample (8 bytes a value, and a few copies while it is drawn)
    and of one byte per task, but not that of their rows, which is larger by far."""
    few, many = tmp_path / "few", tmp_path / "many"
    few.mkdir()
    many.mkdir()
    peak(few, 16)  # imports and caches
    (few / "out.jsonl").unlink()
    growth = peak(many, 2000) - peak(few, 200)
    size = (many / "out.jsonl").stat().st_size
    allowed = 1800 * (2 * 8 * 8 + 1)
    assert allowed < size / 10  # else the test would not see rows being kept
    assert growth < allowed


def test_statistics_are_those_of_the_rows() -> None:
    results = [
        Row(blade="b", sample=k, properties={}, omega_rad_s=1.0, mode=1, name=name, frequency_rad_s=value)
        for k, (name, value) in enumerate([("flapwise 1", 1.0), ("edgewise 1", 2.0), ("flapwise 1", 6.0)])
    ]
    failed = Row(blade="b", sample=3, properties={}, omega_rad_s=1.0, reason="unstable")
    (spread,) = spreads([*results, failed]).to_dict("records")
    assert (spread["name"], spread["samples"], spread["mean"]) == ("flapwise 1", 3, 3.0)
    assert spread["deviation"] == pytest.approx(np.sqrt(7.0))
    assert (spread["low"], spread["high"]) == (pytest.approx(1.1), pytest.approx(5.6))  # between the ordered values


def test_an_invalid_row_is_not_read(tmp_path: Path) -> None:
    path = tmp_path / "out.jsonl"
    path.write_text('{}\n{"blade": 3}\n')
    with pytest.raises(msgspec.ValidationError):
        list(read(path))
