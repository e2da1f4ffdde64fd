"""Table 1 of Park et al. (2010): how many printed values the paper's own discretisation reproduces, in one line."""

from ...cases.judge.results import Run

CASE, TABLE = "park-cantilever", "park2010/present"


def line(run: Run) -> str:
    """The line; empty if the run has no value of the table.

    A printed value is reproduced if the source's discretisation rounds to it: the cell's uncertainty is half a unit of the last
    printed digit.
    """
    solved = {(c.omega, c.name): c.value for c in run.cells if c.case == CASE and c.role == "discretisation"}
    table_cells = [c for c in run.cells if (c.case, c.code) == (CASE, TABLE) and c.value]
    pairs = [(c, solved.get((c.omega, c.name))) for c in table_cells]
    if not pairs:
        return ""
    reproduced = sum(
        f is not None and abs(f - (c.value or 0.0)) <= (c.uncertainty or 0.0) * (c.value or 0.0) * (1 + 1e-9)
        for c, f in pairs
    )
    return f"Table 1 of Park et al. (2010): {reproduced} of {len(pairs)} printed values reproduced."
