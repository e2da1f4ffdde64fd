"""Small studies, a synchronous executor, and stubs in place of the solver."""

import os
import signal
import time
from concurrent.futures import Executor
from pathlib import Path
from typing import Any

from southwell.cases.run.executors import Serial
from southwell.cases.study.journal import StudyJournal
from southwell.cases.study.plan import header, tasks
from southwell.cases.study.rows import Row, Task, encoded
from southwell.cases.study.run import run
from southwell.cases.study.schema import Study, read

TEXT = """
name = "small"
blades = ["{blade}"]
modes = {modes}
samples = {samples}
seed = {seed}
elements = 8
[speeds]
rad_s = [0.0, 10.0]
[properties.EI_flap]
distribution = "normal"
standard_deviation = 0.05
[properties.mass]
distribution = "uniform"
low = 0.9
high = 1.1
"""


def text(samples: int = 6, modes: int = 3, seed: int = 1, blade: str = "park-cantilever") -> str:
    """A study file with two speeds and two properties."""
    return TEXT.format(samples=samples, modes=modes, seed=seed, blade=blade)


def study(folder: Path, given: str | None = None, **options: Any) -> Study:
    """The study of a file in ``folder``."""
    path = folder / "study.toml"
    path.write_text(given or text(**options))
    return read(path)[0]


def solved(definition: Study, path: Path, executor: Executor | None = None, **options: Any) -> list[bytes]:
    """The lines of a study's file after a run, the header and sorted rows."""
    with StudyJournal(path, header(definition)) as journal:
        run(definition, executor or Serial(), journal, **options)
    return lines(path)


def lines(path: Path) -> list[bytes]:
    """The header, and the rows in the order of their bytes."""
    first, *rows = path.read_bytes().splitlines()
    return [first, *sorted(rows)]


def stub(task: Task) -> bytes:
    """Rows of the right form without a solution."""
    properties = {change.name: change.value for change in task.changes}
    return encoded(
        [
            Row(
                blade=task.blade.name, sample=task.sample, properties=properties, omega_rad_s=omega, mode=k + 1, name=""
            )
            for omega in task.speeds
            for k in range(task.text.modes)
        ]
    )


def sleeping(task: Task) -> bytes:
    """A stub that takes a tenth of a second."""
    time.sleep(0.1)
    return stub(task)


def deadly(task: Task) -> bytes:
    """A task that kills every worker that it is given to."""
    os.kill(os.getpid(), signal.SIGKILL)
    return b""


def tasks_of(definition: Study) -> list[Task]:
    """All tasks of a study."""
    return [task for _, task in tasks(definition, range(header(definition).tasks))]
