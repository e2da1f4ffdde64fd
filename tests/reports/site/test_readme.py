"""The README and the page of results: their tables are those of a run, their command and its output are real."""

import re
import shlex
from pathlib import Path

import numpy as np
import pytest

from southwell.cases.input import library
from southwell.cases.solve import core_solver
from southwell.cases.store import results_file
from southwell.core.effects import ALL_EFFECTS, Effects
from southwell.core.solve import modes
from southwell.references.protocol import registry
from southwell.reports.cli import app as cli
from southwell.reports.shared import summary
from southwell.reports.site import readme
from southwell.reports.site.readme import CASE, OMEGA
from southwell.tests.support.codes import BLADE_CODES

from ...support import samples

TEXT = readme.README.read_text(encoding="utf-8")


def blocks(language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", TEXT, re.S)


def test_the_table_is_that_of_the_rows_beside_it() -> None:
    assert readme.written(TEXT) == TEXT, "run `make readme`"


def test_the_rows_are_of_a_complete_run() -> None:
    assert not results_file.read(readme.ROWS).unfinished


def test_the_table_has_five_rows_whose_numbers_are_those_of_codes_that_pass_throughout() -> None:
    run = results_file.read(readme.ROWS)
    rows = [line.strip("| ").split(" | ") for line in readme.five(run).splitlines()[2:]]
    assert len(rows) == len(readme.SHOWN) == 5
    for (_, codes, largest, others, _), case in zip(rows, readme.SHOWN, strict=True):
        own = [c for c in run.cells if c.case == case and c.code in codes.split(", ") and c.role == "code"]
        assert {c.verdict for c in own} == {"pass"}
        assert {c.shares for c in own} == {"nothing"}
        worst = max(own, key=lambda c: abs(c.difference or 0.0))
        assert largest == summary.plus_minus(worst)
        foreign = [c for c in run.cells if c.case == case and c.shares == "nothing" and c.role == "code"]
        answered = {c.code for c in foreign if c.verdict not in ("not run", "not applicable")}
        reported = set() if others == "–" else {entry.partition(" (")[0] for entry in others.split(", ")}
        assert {readme.plain(c.code) for c in own} | reported == {readme.plain(code) for code in answered}
        assert not {c.code for c in own} & reported


@pytest.mark.slow
def test_the_output_of_the_command_is_what_it_prints(tmp_path: Path) -> None:
    """As southwell is run here; the figure is the one it draws. Uncertainties below 1e-8 are rounding: processors differ."""
    output = readme.example(tmp_path)
    second, before = (
        re.sub(r"\b\de-(09|1\d)\b", "tiny ", text)
        for text in (readme.put(TEXT, readme.console(output), "command"), TEXT)
    )
    assert second == before, "run `make readme`"
    assert (tmp_path / readme.FIGURE.name).is_file()
    assert readme.FIGURE.relative_to(readme.ROOT).as_posix() in TEXT
    assert readme.FIGURE.is_file()


def test_one_screen_comes_before_what_may_be_skipped() -> None:
    """Sentence, figure, installation, command with its output and results: before the links, in sixty lines of text."""
    head, links, _ = TEXT.partition("## Where to go on")
    assert links
    assert len(head.splitlines()) <= 60
    places = [head.index(part) for part in ("computes the natural", "![", "pip install", "$ southwell", "| blade |")]
    assert places == sorted(places)
    for path in re.findall(r"\]\((?!https?:)([^)#]+)\)", TEXT):
        assert (readme.ROOT / path).is_file(), path


def test_the_page_of_results_has_every_case() -> None:
    page = readme.results_page()
    assert all(f"| {case} |" in page for case in summary.cases(results_file.read(readme.ROWS)))


def test_the_rows_are_of_all_cases_and_codes_there_are(monkeypatch: pytest.MonkeyPatch) -> None:
    """Cases whose blade files are not part of the package may be among them."""
    run = results_file.read(readme.ROWS)
    all_, _ = library.load_all()
    monkeypatch.delenv("SOUTHWELL_BLADES", raising=False)
    _, absent = library.load_all()
    actual = {v.name for name, case in all_.items() if name not in absent for v in case.variants}
    expected = {v.name for name, case in all_.items() if name in absent for v in case.variants} | set(absent)
    assert actual <= set(summary.cases(run)) <= actual | expected | {*library.mechanisms(), *library.turbines()}
    anywhere = set(BLADE_CODES) - set(readme.ISOLATED)
    assert {registry.code(name).name for name in anywhere} <= {c.code for c in run.cells}


def cores() -> list[float]:
    """Core's frequencies in the table of the paper's case, ascending."""
    cells = [c for c in results_file.read(readme.ROWS).cells if c.case == CASE and c.omega == OMEGA]
    return sorted({c.full for c in cells if c.full})


def test_cores_frequencies_in_the_table_are_those_that_core_gives_now() -> None:
    case = library.load(CASE)
    (converged,) = core_solver.converged(case.variants[0].blade, [OMEGA], case.text.compare, ALL_EFFECTS)
    assert isinstance(converged, core_solver.Converged)
    estimates = [s.estimate.value for s in converged.modes if s.estimate]
    np.testing.assert_allclose(cores(), estimates, rtol=1e-9, err_msg="run `make verify` and `make readme`")


def test_cores_frequencies_in_the_table_are_those_of_the_exact_beam() -> None:
    """Two spectral solutions of the full extensible beam agree on these to 1e-6 (Kirchhoff; geometrically exact)."""
    exact = [11.710953, 15.400199, 70.419355, 71.126584, 189.81994, 190.083784]
    np.testing.assert_allclose(cores(), exact, rtol=1e-6)


def test_the_papers_own_discretisation_in_the_table_rounds_to_the_printed_digits() -> None:
    cells = [
        c for c in results_file.read(readme.ROWS).cells if (c.case, c.omega, c.role) == (CASE, OMEGA, "discretisation")
    ]
    edgewise = [c.value for c in cells if c.family == "edgewise"]
    assert [f"{f:.4g}" for f in sorted(f for f in edgewise if f)] == ["11.71", "70.37", "189.7"]
    blade = library.load(CASE).variants[0].blade
    model = Effects(rotary_inertia=False)
    frequencies = modes(blade, OMEGA, 50, 6, mass="half_end", stiffness="body_fixed", effects=model).frequencies
    np.testing.assert_allclose(sorted({c.value for c in cells if c.value}), frequencies, rtol=1e-9)


def test_condensed_rows_give_the_same_heat_table_as_all_rows() -> None:
    whole = samples.run()
    assert readme.heat(readme.condense(whole)) == readme.heat(whole)
    assert len(readme.condense(whole).cells) < len(whole.cells)


def test_without_markers_there_is_no_place_for_a_table() -> None:
    with pytest.raises(ValueError, match="markers"):
        readme.put("# A README without them", "table", "results")


def test_the_commands_of_the_readme_are_commands() -> None:
    lines = [line[2:] for b in blocks("console") for line in b.splitlines() if line.startswith("$ southwell ")]
    assert lines == [readme.COMMAND]
    command, *_ = cli.app.parse_args(shlex.split(readme.COMMAND)[1:], exit_on_error=False, print_error=False)
    assert command.__module__.endswith("cli.blade.campbell")


def test_targets_of_make_in_the_readme_are_in_the_makefile() -> None:
    makefile = (readme.README.parent / "Makefile").read_text(encoding="utf-8")
    targets = re.findall(r"`make (\w+)`", TEXT.replace("written by `make readme`", ""))
    assert targets
    assert all(re.search(rf"^{t}:", makefile, re.M) for t in targets)
