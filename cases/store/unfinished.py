"""The file of an unfinished run, ``results.partial.sqlite``: its plan, and every answer as soon as it is computed.

A killed run leaves its file. The next run in the same folder takes from it every answer to the same question (``stored``) and
computes only the rest. The file is removed when the run's results and report are written: a folder with it contains no finished
run.
"""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import portalocker

from ...references.protocol.store import Store
from ..input.errors import CaseError
from ..judge.results import Cell, Level, Planned, Run, Setting
from . import codec
from .results_file import gaps

NAME = "results.partial.sqlite"

ABOUT, ROWS, OTHER = "run", "rows", "other"
"""Labels in the file: what is known of the run before its first answer, answers with rows, and other answers."""


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Context manager that prevents other runs from writing to the folder.

    It uses the system's lock on the folder itself, which leaves no file behind and is released when the process ends.

    Raises:
        CaseError: if another process has the lock.
        OSError: if the folder cannot be opened.
    """
    handle = os.open(folder, os.O_RDONLY)
    try:
        try:
            portalocker.lock(handle, portalocker.LockFlags.EXCLUSIVE | portalocker.LockFlags.NON_BLOCKING)
        except portalocker.LockException as error:
            raise CaseError(
                f"--out {folder}: another run is writing in this folder: wait for it to end, or give another folder"
            ) from error
        yield
    finally:
        os.close(handle)


class Unfinished:
    """The open file of a run. Every method that writes raises ``StoreError`` if that fails.

    Raises:
        OSError: if the file cannot be opened.
    """

    def __init__(self, folder: Path) -> None:
        self.path = folder / NAME
        self.store = Store(self.path)
        self.begun = 0.0

    def begin(self, run: Run) -> None:
        """Write plan, settings, versions and command of a run. Answers stored or taken from now on belong to it."""
        facts = {"plan": run.plan, "settings": run.settings, "versions": run.versions, "command": run.command}
        content = msgspec.json.encode(facts)
        try:
            is_same_run = self.store.get(ABOUT)[0] == content
        except KeyError:
            is_same_run = False
        if not is_same_run:
            self.store.put(ABOUT, ABOUT, content)
        self.begun = self.store.get(ABOUT)[1]

    def get(self, key: str) -> bytes:
        """Return an answer, which now belongs to the run.

        Raises:
            KeyError: if it is not stored.
        """
        content, stored = self.store.get(key)
        if stored < self.begun:
            self.store.touch(key)
        return content

    def put(self, key: str, rows: bool, content: bytes) -> None:
        """Store an answer; ``rows`` if it is that of a column."""
        self.store.put(key, ROWS if rows else OTHER, content)

    def close(self) -> None:
        """Close the file."""
        self.store.close()

    def remove(self) -> None:
        """Remove the file, after the run's results and report are written."""
        self.close()
        self.path.unlink()

    def __enter__(self) -> "Unfinished":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def read(path: Path) -> Run:
    """Read the unfinished run in a file: the rows available so far, in the order of the plan.

    Raises:
        OSError: if the file cannot be read.
        ValueError: if it is not of an unfinished run of this version; the message names the file.
    """
    if not path.exists():
        raise FileNotFoundError(2, "No such file or directory", str(path))
    store = Store(path)
    try:
        content, start_time = store.get(ABOUT)
        facts = msgspec.json.decode(content, type=dict[str, Any])
        plan = msgspec.convert(facts["plan"], tuple[Planned, ...])
        settings = msgspec.convert(facts["settings"], tuple[Setting, ...])
        answers = [codec.decode(rows) for rows in store.values(ROWS, start_time)]
    except KeyError:
        return Run((), unfinished="the run was stopped before its first answer")
    except (TypeError, ValueError) as error:
        raise ValueError(f"{path}: not an unfinished run ({error}): check that this version wrote it") from error
    finally:
        store.close()
    position = {(p.case, p.code): k for k, p in enumerate(plan)}

    def order(row: Cell | Level) -> int:
        return position.get((row.case, row.code), len(position))

    run = Run(
        cells=tuple(sorted((c for cells, _ in answers for c in cells), key=order)),
        levels=tuple(sorted((v for _, levels in answers for v in levels), key=order)),
        versions=facts["versions"],
        command=facts["command"],
        settings=settings,
        plan=plan,
    )
    return replace(run, unfinished=gaps(run) or "the run was stopped before its results were written")
