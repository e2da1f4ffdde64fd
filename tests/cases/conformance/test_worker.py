"""Checks asked of a code in its own process: what a check does to it is that check's outcome, and the others go on."""

from pathlib import Path

import pytest

from southwell.cases.conformance.suite import CHECKS
from southwell.cases.conformance.worker import outcomes
from southwell.references.protocol.process import Limits

CODE = """
import os, sys, time
from southwell.references.theories.exact_beam import ExactBeam

class Code(ExactBeam):
    def modes(self, blade, omega, elements, count):
        if count == 8:
            os._exit(0)
        if count == 3:
            sys.exit(0)
        return super().modes(blade, omega, elements, count)

CODE = Code()
"""


@pytest.mark.slow
def test_an_exit_fails_its_check_only(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "leaver.py").write_text(CODE.replace("count == 3", "False"), encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    checks = [c for c in CHECKS if c.name in ("cantilever at rest", "counts", "shapes")]
    first, counts, last = outcomes("leaver:CODE", checks, Limits(60.0))
    assert [o.check for o in (first, counts, last)] == checks
    assert (first.verdict, last.verdict) == ("pass", "pass")
    assert (counts.verdict, counts.reason) == ("fail", "the code's process ended with exit status 0")


def test_a_raised_system_exit_fails_its_check_only(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "raiser.py").write_text(CODE, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    (counts,) = outcomes("raiser:CODE", [c for c in CHECKS if c.name == "counts"], Limits(60.0))
    assert (counts.verdict, counts.reason) == ("fail", "SystemExit: 0")
