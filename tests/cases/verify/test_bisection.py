"""Another release of a code in a whole run, and the search for the first release that differs, on wheels made here."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import pytest

from southwell.cases.input.schema import Case, read
from southwell.cases.judge.releases import Bisection, comparisons
from southwell.cases.judge.results import Run, gaps
from southwell.cases.judge.witnesses import groups, witnesses
from southwell.cases.verify import bisection, cached, columns, matrix
from southwell.references.protocol import overlay
from southwell.references.protocol.description import Description, describe
from southwell.references.protocol.process import Failure, Limits
from southwell.references.protocol.registry import at_release
from southwell.reports.shared import summary

from ...support import killing, samples, wheelhouse
from ...support.wheelhouse import NAME

SAME, MOVED, BROKEN = "FACTOR = 1.0", "FACTOR = 1.0004", "raise ImportError('gone')"


@pytest.fixture
def case(tmp_path: Path) -> Case:
    path = tmp_path / "stub.toml"
    path.write_text(killing.CASE.partition("[variants")[0], encoding="utf-8")
    return read(path)


def solved(case: Case, other: str) -> tuple[Run, tuple[Bisection, ...], list[str]]:
    """A run of the tiny code with another release, the bisections, and what was said meanwhile."""
    overlay.install(NAME, other)
    codes = describe(["tiny:CODE", at_release("tiny:CODE", NAME, other)], [v.blade for v in case.variants])
    said: list[str] = []
    with ThreadPoolExecutor(2) as executor:
        run = matrix.run([case], codes, executor, parts=False)
        found = bisection.bisections(run, [case], codes, executor, lambda _: Limits(60.0), said.append)
    return run, found, said


@pytest.mark.slow
def test_bisection_names_the_first_release_that_moves_a_frequency(
    case: Case, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A release without a wheel is skipped and named; 1.10 comes after 1.9. A move alone does not fail the run."""
    releases = dict.fromkeys(("1.0", "1.2", "1.9"), SAME) | dict.fromkeys(("1.10", "1.11", "1.12"), MOVED)
    wheelhouse.use(tmp_path, monkeypatch, {**releases, "1.9.5": ""}, installed="1.0")
    run, (found,), said = solved(case, "1.12")
    (one,) = comparisons(run)
    assert (one.code, one.other, len(one.compared), len(one.moved)) == ("tiny", "tiny@1.12", 4, 4)
    assert (found.older, found.before, found.first) == ("1.0", "1.9", "1.10")
    assert found.change == pytest.approx(4e-4, rel=1e-3)
    assert {release: "No matching distribution" in why for release, why in found.skipped.items()} == {"1.9.5": True}
    assert len(said) == 2 * (found.tried + 1)
    assert "bisection: tiny, tinybeam 1.10: moved, +4.0e-04 from 1.0" in said
    assert found.tried < len(releases) - 2
    assert (gaps(run), summary.status(run)) == ("", 0)
    assert {c.version for c in run.cells if c.code == "tiny@1.12"} == {"1.12"}
    confirmed = groups(witnesses(run, case.variants[0].name))
    assert [[w.name for w in group] for group in confirmed] == [["tiny"]]


@pytest.mark.slow
def test_a_release_that_moves_nothing_is_reported_so(
    case: Case, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    wheelhouse.use(tmp_path, monkeypatch, {"1.0": SAME, "1.1": MOVED, "1.2": SAME}, installed="1.0")
    run, found, said = solved(case, "1.2")
    (one,) = comparisons(run)
    assert (len(one.compared), one.moved, found, said) == (4, (), (), [])
    assert one.largest
    assert one.largest.relative == 0.0


def test_without_an_installed_release_or_an_importable_other_one_there_is_still_a_result(
    case: Case, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The code at the other release fails before it can say its version."""
    wheelhouse.use(tmp_path, monkeypatch, {"1.0": SAME}, installed="1.0")
    found = Description("a", "a", distribution=NAME, version="1.0", refused=(None,))
    lost = replace(found, asked=f"a@{NAME}==1.1", name="a@1.1", version=None, failure=Failure("nonsense", "import"))
    name = case.variants[0].name
    mine = samples.cell(case=name, code="a", version="1.0")
    silent = samples.empty("fail", "import", case=name, code="a@1.1", version="")
    run, answering = Run((mine, silent)), replace(mine, code="a@1.1", version="1.1")
    said: list[str] = []
    with ThreadPoolExecutor(1) as executor:

        def ask(run: Run, *codes: Description) -> tuple[Bisection, ...]:
            return bisection.bisections(run, [case], codes, executor, lambda _: Limits(), said.append)

        (one,) = ask(run, found, lost)
        assert (one.before, one.first, one.answers, one.reason) == ("1.0", "1.1", False, "import")
        absent = replace(mine, frequency=None, mode=0, verdict="not run")
        assert ask(Run((absent, answering)), replace(found, version=None), replace(lost, version="1.1")) == ()


@pytest.mark.slow
def test_bisection_names_the_first_release_that_does_not_answer(
    case: Case, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Here the installed release is the newest; the other way round, it is the first that does not answer."""
    releases = {"1.0": BROKEN, "1.1": BROKEN, "1.2": SAME, "1.3": SAME}
    wheelhouse.use(tmp_path, monkeypatch, releases, installed="1.3")
    run, (found,), _ = solved(case, "1.0")
    assert (found.before, found.first, found.answers, found.change) == ("1.1", "1.2", True, None)
    assert "ImportError: gone" in found.reason
    assert summary.status(run) == 1  # of the cells that fail, as with any code


def test_answers_of_a_release_are_stored_under_a_key_of_its_own(case: Case) -> None:
    """Even if the adapter reported the same version for both."""
    mine = Description(
        "exact-beam", "exact-beam", shares="nothing", levels=(4, 8), order=2, version="1.0", refused=(None,)
    )
    other = replace(mine, asked="exact-beam@tinybeam==2.0")
    keys = set()
    for code in (mine, other, replace(other, asked="exact-beam@tinybeam==2.1")):
        made = columns.columns(case, case.variants[0], [code], Limits())
        keys.add(cached.question(next(c for c in made if c.head.code == "exact-beam"), [0.0]))
    assert len(keys) == 3
