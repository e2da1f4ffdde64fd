"""Matrix runs of codes by name."""

from collections.abc import Sequence
from concurrent.futures import Executor
from typing import Any

from southwell.cases.judge.results import Run
from southwell.cases.plan.subject import Subject, asked_about
from southwell.cases.verify import matrix
from southwell.references.protocol.description import describe


def solve(subjects: Sequence[Subject], codes: Sequence[str], executor: Executor, *how: Any, **options: Any) -> Run:
    """The run of codes, by name or import path, which are first asked about every blade."""
    return matrix.run(subjects, describe(codes, asked_about(subjects)), executor, *how, **options)
