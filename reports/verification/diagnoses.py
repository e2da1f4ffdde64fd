"""Why columns differ from core: one line each for the terminal, and a table for the report."""

from ...cases.judge.results import Run


def lines(run: Run) -> list[str]:
    """One line for each column with a diagnosis."""
    several = len({one.case for one in run.diagnoses}) > 1
    return [f"{one.code}{f', {one.case}' if several else ''}: {one.sentence}." for one in run.diagnoses]


def rows(run: Run, case: str) -> list[dict[str, str]]:
    """One row for each column of a case with a diagnosis."""
    return [
        {
            "code": one.code,
            "diagnosis": one.sentence,
            "most probable causes": "; ".join(one.causes),
            "ω² = ω₀² + φ Ω²": "; ".join(one.modes),
        }
        for one in run.diagnoses
        if one.case == case
    ]
