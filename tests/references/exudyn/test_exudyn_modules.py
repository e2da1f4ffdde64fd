"""Exudyn's two compiled modules, one of which has no range checks, give the same answers, and nothing is printed."""

import subprocess
import sys

import numpy as np
import pytest

from ...support.exudyn_beams import needs_exudyn

pytestmark = needs_exudyn

SOLVE = """
import sys
{first}
from southwell.cases.input import library
from southwell.references.exudyn import ancf, tree
blade = library.load("yoo-shin-chordwise").variants[0].blade
for code in (ancf.CODE, tree.CODE):
    print(*map(repr, code.solve(blade, 12.0, code.levels[0], 6).frequencies.tolist()))
print(*sorted(name for name in sys.modules if name in ("exudyn.exudynCPP", "exudyn.exudynCPPfast")))
"""


def solved(first: str) -> tuple[list[np.ndarray], str]:
    """Frequencies by each of Exudyn's codes, and the compiled module that was used."""
    script = SOLVE.format(first=first)
    process = subprocess.run(
        [sys.executable, "-P", "-c", script], capture_output=True, text=True, check=True, timeout=120
    )
    *frequencies, module = process.stdout.splitlines()
    return [np.array(line.split(), float) for line in frequencies], module


@pytest.mark.slow
def test_the_module_without_range_checks_gives_the_same_frequencies() -> None:
    checked, module = solved("sys.exudynFast = False")
    assert module == "exudyn.exudynCPP"
    fast, module = solved("")
    assert module in ("exudyn.exudynCPPfast", "exudyn.exudynCPP")  # the latter on a processor without AVX2
    assert [len(f) for f in fast] == [6, 6]
    for answer, counterpart in zip(fast, checked, strict=True):
        np.testing.assert_allclose(answer, counterpart, rtol=1e-9)
