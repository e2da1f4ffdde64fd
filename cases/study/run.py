"""The run of a study: its tasks on any executor, each answer written once, as soon as it arrives."""

from collections.abc import Callable
from concurrent.futures import Executor, Future
from itertools import islice
from queue import SimpleQueue

from .journal import StudyJournal
from .plan import tasks
from .rows import Task, solve
from .schema import Study

WINDOW = 1024
"""Largest number of tasks that are submitted and not yet written; it bounds memory, and the number of useful workers."""


def run(
    study: Study,
    executor: Executor,
    journal: StudyJournal,
    on_progress: Callable[[int], None] = lambda count_done: None,
    answer: Callable[[Task], bytes] = solve,
    window: int = WINDOW,
) -> None:
    """Solve every task that the journal does not contain, and append its rows.

    Args:
        study: the study.
        executor: where tasks run.
        journal: the file, open.
        on_progress: called with the number of finished tasks, at the start and after each task.
        answer: solves a task; returns its rows as lines.
        window: largest number of tasks in progress.

    Raises:
        JournalError: if rows cannot be written.
        BrokenExecutor: if workers are lost. Answers that have arrived are in the journal in every case.
    """
    count_done = sum(journal.done)
    on_progress(count_done)
    todo = tasks(study, (k for k, finished in enumerate(bytes(journal.done)) if not finished))
    pending: dict[Future[bytes], int] = {}
    completed: SimpleQueue[Future[bytes]] = SimpleQueue()

    def submit(limit: int) -> None:
        for number, task in islice(todo, limit):
            future = executor.submit(answer, task)
            pending[future] = number
            future.add_done_callback(completed.put)

    try:
        submit(window)
        while pending:
            future = completed.get()
            lines = future.result()
            journal.put(pending.pop(future), lines)
            count_done += 1
            on_progress(count_done)
            submit(1)
    finally:
        for future in pending:
            future.cancel()
        for future, number in pending.items():  # answers that arrived while another one failed
            if future.done() and not future.cancelled() and not future.exception():
                journal.put(number, future.result())
