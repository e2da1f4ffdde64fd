"""Exit statuses of all commands."""

PASSED, FAILED, BAD_INPUT, INCOMPLETE, INTERNAL, INTERRUPTED = 0, 1, 2, 3, 70, 130

MEANING: dict[int, str] = {
    PASSED: "everything requested was done, and all results are within target or explained",
    FAILED: "something fails, is inconclusive, or got worse",
    BAD_INPUT: "bad input, or a file or folder that cannot be read or written",
    INCOMPLETE: "incomplete: the run was stopped before its end, or its results were cut short",
    INTERNAL: "internal error: a defect of this program",
    INTERRUPTED: "interrupted from the keyboard",
}
"""Meaning of each status, as in ``docs/ci.md``."""


def listed() -> str:
    """All statuses in one sentence."""
    return "; ".join(f"{status}: {meaning.partition(':')[0]}" for status, meaning in MEANING.items())
