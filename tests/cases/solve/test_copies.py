"""Southwell's own output in a file is recognised by digits that are not certain."""

from pathlib import Path

import numpy as np

from southwell.cases.input import library
from southwell.cases.plan import user_columns, user_results
from southwell.cases.solve.copies import given_back
from southwell.cases.solve.reference import references
from southwell.core.effects import ALL_EFFECTS
from southwell.core.solve import sweep

CASE = library.load("park-cantilever")
BLADE = CASE.variants[0].blade
SPEEDS = (0.0, 10.0)
PRINTED = [(m.omega, float(f), 1e-16) for m in sweep(BLADE, SPEEDS) for f in m.frequencies[:6]]


def test_all_digits_of_southwell_modes_are_its_own_output() -> None:
    assert given_back(BLADE, PRINTED)


def test_one_other_digit_few_numbers_and_few_digits_prove_nothing() -> None:
    omega, frequency, unit = PRINTED[-1]
    assert not given_back(BLADE, [*PRINTED[:-1], (omega, frequency * (1.0 + 1e-10), unit)])
    assert not given_back(BLADE, PRINTED[:2])
    assert not given_back(BLADE, [(omega, frequency, 1e-7) for omega, frequency, _ in PRINTED])


def test_a_column_of_its_own_output_shares_everything(tmp_path: Path) -> None:
    shares = {}
    for name, factor in (("own", 1.0), ("other", 1.0 + 1e-7)):
        lines = [f"{omega!r}, {frequency * factor!r}, {k % 6 + 1}\n" for k, (omega, frequency, _) in enumerate(PRINTED)]
        path = tmp_path / f"{name}.csv"
        path.write_text("speed [rad/s], frequency [rad/s], mode\n" + "".join(lines))
        (column,) = user_columns.columns(CASE.variants[0], [user_results.read(name, path)], CASE.text.compare)
        solved = references(BLADE, list(SPEEDS), CASE.text.compare, [ALL_EFFECTS])[ALL_EFFECTS]
        cells, _ = column(SPEEDS, solved)
        shares[name] = {cell.shares for cell in cells}
        assert {cell.verdict for cell in cells} == {"pass"}
        assert np.all(["own output" in cell.reason for cell in cells]) == (name == "own")
    assert shares == {"own": {"everything"}, "other": {"nothing"}}
