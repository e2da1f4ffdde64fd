"""A run of ``southwell verify``: every answer is stored at once, and what was computed is kept if the run stops."""

import shutil
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import BrokenExecutor, Executor, Future
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ...cases.faults import table
from ...cases.input.schema import Case
from ...cases.judge import results
from ...cases.judge.results import Control, Planned, Run
from ...cases.store import unfinished
from ...cases.store.stored import Stored
from ...cases.store.unfinished import Unfinished
from ...cases.verify import matrix
from ...cases.verify.mechanism_case import MechanismCase
from ...cases.verify.user_results import UserResults
from ...references.protocol.description import Description
from ...references.protocol.store import Store
from ..shared import console
from ..shared.statuses import INCOMPLETE, INTERRUPTED
from .arguments import RESULTS

SCRATCH = "results.partial.tmp"
"""Folder in ``--out`` for temporary files of this run and of the codes it runs."""


@dataclass(frozen=True)
class Stopped:
    """Why a run stopped before its end, and the exit status."""

    what: str
    status: int


def solve(
    chosen: Sequence[Case | MechanismCase],
    codes: Sequence[Description],
    files: Sequence[UserResults],
    about: Run,
    kept: Unfinished,
    out: Path,
    pool: Executor,
    stop: Callable[[], None],
    seeded: Sequence[Sequence[str]],
    limits: Mapping[str, Any],
    kept_before: Store | None,
) -> tuple[Run, Stopped | None]:
    """The complete run, written to ``out``; or the part that was computed, and why it stopped.

    Answers go to ``kept`` at once, and to the user's store, ``kept_before``, if it may be used. ``stop`` ends the workers of
    ``pool`` if the run stops; otherwise they are kept, for the figures. ``seeded`` are the faults of each task. That a fault is
    detected is taken from the store only if no version of a code has changed.
    """
    scratch = out / SCRATCH
    shutil.rmtree(scratch, ignore_errors=True)  # left by a killed run
    watch = console.Watch()
    complete = False
    state = tuple(f"{name} {version}" for name, version in sorted(about.versions.items()))
    executor, trials = (Stored(pool, kept_before, kept, also) for also in ((), state))
    tried: list[Future[list[Control]]] = []

    def begin(plan: tuple[Planned, ...]) -> None:
        kept.begin(replace(about, plan=plan))
        tried.extend(trials.submit(table.run, part, kept_before is not None) for part in seeded)

    try:
        scratch.mkdir()
        with watch:
            done = matrix.run(chosen, codes, executor, watch.show, user_results=files, on_plan=begin, **limits)
            found = {control.control: control for future in tried for control in future.result()}
        controls = tuple(found[name] for part in seeded for name in part)
        run = replace(done, controls=controls)
        run = replace(run, versions=about.versions, command=about.command, settings=about.settings)
        if missing := results.gaps(run):
            return replace(run, unfinished=missing), Stopped(missing, INCOMPLETE)
        results.write(out / RESULTS, run)
        complete = True
        if executor.taken or trials.taken:
            print(f"southwell: {_taken((executor, trials))}", file=sys.stderr)
        return run, None
    except KeyboardInterrupt:
        stopped = Stopped("interrupted", INTERRUPTED)
    except BrokenProcessPool:
        why = "a worker process was killed, probably out of memory: use fewer --workers or fewer cases at once"
        stopped = Stopped(why, INCOMPLETE)
    except BrokenExecutor as error:
        stopped = Stopped(str(error), INCOMPLETE)
    except OSError as error:
        stopped = Stopped(said(error), INCOMPLETE)
    finally:
        if not complete:
            stop()
    return replace(unfinished.read(kept.path), unfinished=stopped.what), stopped


def _taken(stored: Sequence[Stored]) -> str:
    times = [when for one in stored for when in one.taken]
    first, last = (time.strftime("%Y-%m-%d %H:%M", time.localtime(when(times))) for when in (min, max))
    return (
        f"{len(times)} of {sum(one.asked for one in stored)} answers are from the store, computed between {first} and {last}; "
        "--fresh computes them again"
    )


def said(error: OSError) -> str:
    """An error of the file system in one line."""
    return f"{error.filename}: {error.strerror}" if error.filename else str(error)
