"""Columns of a run that fail, and files of other programs, get a diagnosis from their cells."""

from dataclasses import replace

from southwell.cases.diagnosis.columns import diagnosed, is_due
from southwell.cases.judge.results import Cell, Diagnosed, Run, Verdict
from southwell.core.blade import uniform_blade
from southwell.core.participation import families, numbered, participation
from southwell.core.solve import mesh_sweep
from southwell.reports.verification import diagnoses

BLADE = uniform_blade("beam", 6.0, 0.6, EA=1e7, GJ=1e3, EI_y=1e4, EI_z=1.4e4, mass=1.2, I_y=1e-3, I_z=2e-3)
SPEEDS = (0.0, 10.0, 20.0)


def cell(omega: float, mode: int, name: str, frequency: float, verdict: Verdict = "fail", code: str = "code") -> Cell:
    family, ordinal = name.split()
    return Cell("beam", omega, mode, family, code, "1", "code", frequency, frequency, 0.01, 1e-6, 1e-3, verdict,
                ordinal=int(ordinal))  # fmt: skip


def cells() -> list[Cell]:
    """Cells of a code that takes the hub radius as 0; its modes have the names of the right blade."""
    correct, altered = (list(mesh_sweep(b, SPEEDS, 40, 5)) for b in (BLADE, replace(BLADE, hub_radius=0.0)))
    out = []
    for modes, base in zip(altered, correct, strict=True):
        names = numbered(families(participation(base, BLADE)))
        out += [cell(modes.omega, k + 1, names[k], float(modes.frequencies[k])) for k in range(4)]
    return out


def test_a_failing_column_is_diagnosed_from_its_cells() -> None:
    diagnosis = diagnosed(BLADE, cells())
    assert diagnosis.known
    assert diagnosis.sentence.startswith("agrees with Southwell's own solver without hub radius (0.000")
    assert diagnosis.causes[0].startswith("without hub radius: explains 100 %")
    assert any(line.startswith("flapwise 1: at rest ") for line in diagnosis.modes)


def test_only_failures_and_added_files_are_due() -> None:
    passing = [replace(row, verdict="pass") for row in cells()]
    assert not is_due(passing, added=False)
    assert is_due(passing, added=True)
    assert is_due([*passing[1:], cells()[0]], added=False)
    crashed = replace(cells()[0], value=None, mode=0)
    assert not is_due([crashed], added=True)
    assert not is_due([replace(row, role="measured") for row in cells()], added=True)


def test_the_terminal_and_the_report_show_it() -> None:
    first = Diagnosed(
        "beam",
        "code",
        True,
        "agrees with Southwell's own solver without hub radius (0.0002 % remains)",
        ("a", "b"),
        ("flapwise 1: …",),
    )
    run = Run((), diagnoses=(first,))
    assert diagnoses.lines(run) == ["code: agrees with Southwell's own solver without hub radius (0.0002 % remains)."]
    (row,) = diagnoses.rows(run, "beam")
    assert row["most probable causes"] == "a; b"
    assert diagnoses.rows(run, "other") == []
    both = replace(run, diagnoses=(first, replace(first, case="other")))
    assert diagnoses.lines(both)[0].startswith("code, beam: ")


def test_a_diagnosis_tolerates_a_mode_that_the_solver_names_otherwise() -> None:
    strange = cell(20.0, 5, "torsion 7", 900.0)
    assert diagnosed(BLADE, [*cells(), strange]).sentence.startswith(
        "agrees with Southwell's own solver without hub radius"
    )


def test_a_difference_within_the_rounding_of_its_own_number_needs_no_cause() -> None:
    (modes,) = mesh_sweep(BLADE, SPEEDS[:1], 40, 5)
    names = numbered(families(participation(modes, BLADE)))
    right = modes.frequencies

    def sentence(rounding: float) -> str:
        """The first frequency is printed with fewer digits than the others: 4e-4 too high, ± ``rounding``."""
        first = replace(cell(0.0, 1, names[0], right[0] * (1 + 4e-4)), difference=4e-4, uncertainty=rounding)
        others = [replace(cell(0.0, k + 1, names[k], right[k]), difference=0.0, uncertainty=2e-5) for k in range(1, 4)]
        return diagnosed(BLADE, [first, *others]).sentence

    assert sentence(7e-4) == "all frequencies agree within 0.04 %"
    assert not sentence(1e-4).startswith("all frequencies agree")
