"""The README says what is so: its table is that of a run, its examples work."""

import re
import shlex
import tomllib
from pathlib import Path

import numpy as np
import pytest

from southwell.cases.input import library
from southwell.cases.input.schema import decode
from southwell.cases.judge import results
from southwell.cases.verify import core_solver
from southwell.cases.verify.lumping import CASE, OMEGA
from southwell.core.effects import ALL_EFFECTS, Effects
from southwell.core.solve import modes
from southwell.references.protocol import registry
from southwell.reports.cli import app as cli
from southwell.reports.shared import summary
from southwell.reports.site import readme

from ...support import samples

TEXT = readme.README.read_text(encoding="utf-8")


def blocks(language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", TEXT, re.S)


def test_the_tables_are_those_of_the_rows_beside_them() -> None:
    assert readme.written(TEXT) == TEXT, "run `make readme`"


def test_the_rows_are_of_all_cases_and_codes_there_are(monkeypatch: pytest.MonkeyPatch) -> None:
    """Cases whose blade files are not part of the package may be among them."""
    run = results.read(readme.ROWS)
    all_ = {name: library.load(name) for name in set(library.names()) - set(library.absent())}
    monkeypatch.delenv("SOUTHWELL_BLADES", raising=False)
    elsewhere = set(library.absent())
    ours = {v.name for name, case in all_.items() if name not in elsewhere for v in case.variants}
    theirs = {v.name for name, case in all_.items() if name in elsewhere for v in case.variants} | elsewhere
    assert ours <= set(summary.cases(run)) <= ours | theirs | set(library.mechanisms())
    assert {registry.code(name).name for name in registry.OURS} <= {c.code for c in run.cells}


def cores() -> list[float]:
    """Core's frequencies in the table of the paper's case, ascending."""
    cells = [c for c in results.read(readme.ROWS).cells if c.case == CASE and c.omega == OMEGA]
    return sorted({c.full for c in cells if c.full})


def test_cores_frequencies_in_the_table_are_those_that_core_gives_now() -> None:
    case = library.load(CASE)
    found = core_solver.converged(case.variants[0].blade, OMEGA, case.text.compare, ALL_EFFECTS)
    assert isinstance(found, core_solver.Converged)
    estimates = [s.estimate.value for s in found.settled if s.estimate]
    np.testing.assert_allclose(cores(), estimates, rtol=1e-9, err_msg="run `make verify` and `make readme`")


def test_cores_frequencies_in_the_table_are_those_of_the_exact_beam() -> None:
    """Two spectral solutions of the full extensible beam agree on these to 1e-6 (Kirchhoff; geometrically exact)."""
    exact = [11.710953, 15.400199, 70.419355, 71.126584, 189.81994, 190.083784]
    np.testing.assert_allclose(cores(), exact, rtol=1e-6)


def test_the_papers_own_discretisation_in_the_table_rounds_to_the_printed_digits() -> None:
    cells = [c for c in results.read(readme.ROWS).cells if (c.case, c.omega, c.role) == (CASE, OMEGA, "discretisation")]
    chordwise = [c.frequency for c in cells if c.family == "chordwise"]
    assert [f"{f:.4g}" for f in sorted(f for f in chordwise if f)] == ["11.71", "70.37", "189.7"]
    blade = library.load(CASE).variants[0].blade
    model = Effects(rotary_inertia=False)
    found = modes(blade, OMEGA, 50, 6, mass="half_end", stiffness="body_fixed", effects=model).frequencies
    np.testing.assert_allclose(sorted({c.frequency for c in cells if c.frequency}), found, rtol=1e-9)


def test_condensed_rows_give_the_same_heat_table_as_all_rows() -> None:
    whole = samples.run()
    assert readme.heat(readme.condense(whole)) == readme.heat(whole)
    assert len(readme.condense(whole).cells) < len(whole.cells)


def test_without_markers_there_is_no_place_for_a_table() -> None:
    with pytest.raises(ValueError, match="markers"):
        readme.put("# A README without them", "table")


def test_the_example_of_a_case_is_one() -> None:
    (text,) = (b for b in blocks("toml") if "[blade]" in b)
    case = decode(tomllib.loads(text), "README.md", Path())
    assert case.name == "my-beam"
    assert len(case.variants[0].speeds) == 4


def test_the_entry_point_of_the_readme_is_the_one_that_is_read() -> None:
    assert any(registry.GROUP in b for b in blocks("toml"))


def test_the_commands_of_the_readme_are_commands() -> None:
    lines = [line for b in blocks("console") for line in b.splitlines() if line.startswith("southwell ")]
    assert len(lines) >= 6
    for line in lines:
        command, *_ = cli.app.parse_args(shlex.split(line)[1:], exit_on_error=False, print_error=False)
        assert command.__name__ in (*line.split()[1:3], "command")


def test_targets_of_make_in_the_readme_are_in_the_makefile() -> None:
    makefile = (readme.README.parent / "Makefile").read_text(encoding="utf-8")
    targets = re.findall(r"^make (\w+)", "\n".join(blocks("console")), re.M)
    assert targets
    assert all(re.search(rf"^{t}:", makefile, re.M) for t in targets)
