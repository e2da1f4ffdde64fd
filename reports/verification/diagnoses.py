"""Why columns differ from core: one line each for the terminal, and a table for the report."""

from ...cases.judge.results import Run


def lines(run: Run) -> list[str]:
    """One line for each column with a diagnosis."""
    several = len({diagnosis.case for diagnosis in run.diagnoses}) > 1
    return [
        f"{diagnosis.code}{f', {diagnosis.case}' if several else ''}: {diagnosis.sentence}."
        for diagnosis in run.diagnoses
    ]


def rows(run: Run, case: str) -> list[dict[str, str]]:
    """One row for each column of a case with a diagnosis."""
    return [
        {
            "code": diagnosis.code,
            "diagnosis": diagnosis.sentence,
            "most probable causes": "; ".join(diagnosis.causes),
            "ω² = ω₀² + φ Ω²": "; ".join(diagnosis.modes),
        }
        for diagnosis in run.diagnoses
        if diagnosis.case == case
    ]
