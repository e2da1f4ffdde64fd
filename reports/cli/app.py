"""The command line: bad input is one line on standard error and status 2, never a traceback."""

import os
import sys
from collections.abc import Sequence
from contextlib import redirect_stderr, redirect_stdout
from importlib.metadata import version

from cyclopts import App, CycloptsError, UnusedCliTokensError
from numba.core import event
from threadpoolctl import threadpool_limits

from ...cases.input import files
from ...cases.input.errors import CaseError, brief
from ...references.protocol.registry import UnknownCodeError
from ..shared.console import LogSafe
from .arguments import BAD_INPUT, INTERRUPTED, PASSED, UsageError

OUTSIDE = "--allow-outside"
"""An option of every command, wherever it stands."""

app = App(
    name="southwell",
    help="""Are these natural frequencies of a rotating blade right?

    One blade through many independent codes, every difference with its uncertainty and its cause.

    Exit status: 0 all within target or explained, 1 something fails or is inconclusive, 2 bad input, 130 interrupted.
    """,
    help_epilogue=f"{OUTSIDE}: files that a given file names may lie outside its folder (any command).",
    version=lambda: version("southwell"),
    suppress_keyboard_interrupt=False,
)

app.command(f"{__package__}.verify:command", name="verify")
app.command(f"{__package__}.modes:modes", name="modes")
app.command(f"{__package__}.modes:mechanism", name="mechanism")
app.command(f"{__package__}.report:command", name="report")
app.command(f"{__package__}.listings:cases", name="cases")
app.command(f"{__package__}.listings:code_app", name="codes")
app.command(f"{__package__}.campbell:command", name="campbell")
app.command("southwell.reports.verification.bench:command", name="bench")
app.command(f"{__package__}.condense:command", name="condense")
app.command("southwell.reports.verification.closed_forms_page:command", name="closed-forms")
app.command(f"{__package__}.conform:command", name="conform")
app.command(f"{__package__}.show:command", name="show")
app.command(f"{__package__}.convert:command", name="convert")
app.command(f"{__package__}.history:app", name="history")
app.command(f"{__package__}.gate:command", name="gate")
app.command(f"{__package__}.dashboard:command", name="dashboard")


class _FirstUse(event.Listener):
    """Says at a terminal why nothing happens, where code is compiled."""

    told = False

    def on_start(self, event: event.Event) -> None:
        """Once."""
        if not _FirstUse.told and sys.stderr.isatty():
            print("southwell: compiling the solver's loops, once: about half a minute", file=sys.stderr)
        _FirstUse.told = True

    def on_end(self, event: event.Event) -> None:
        """Nothing."""


def main(arguments: Sequence[str] | None = None) -> None:
    """The entry point; ends the process with the command's status."""
    given = sys.argv[1:] if arguments is None else list(arguments)
    with (
        redirect_stdout(LogSafe(sys.stdout)),  # pyright: ignore[reportArgumentType]
        redirect_stderr(LogSafe(sys.stderr)),  # pyright: ignore[reportArgumentType]
        files.outside_allowed(OUTSIDE in given),
    ):
        status = _status([word for word in given if word != OUTSIDE])
    sys.exit(status)


def _status(arguments: list[str]) -> int:
    """Run a command; its exit status."""
    if "" not in sys.path:
        sys.path.append("")  # a code named by its import path may lie in the current folder, as python -m finds it
    event.register("numba:compile", _FirstUse())
    try:
        if arguments in ([], *([flag] for flag in app.help_flags)):
            app.resolved_commands()  # loads what is otherwise loaded when asked for, whose help has a line each here
        with threadpool_limits(1):  # matrices are small: threads would wait for each other
            status = app(arguments, exit_on_error=False, print_error=False, result_action="return_value") or PASSED
        sys.stdout.flush()
    except UnusedCliTokensError as error:
        words = brief(" ".join(error.unused_tokens or ()))
        print(
            f"southwell: {words}: not understood here: more words than the command takes; see --help", file=sys.stderr
        )
        status = BAD_INPUT
    except (CycloptsError, CaseError, UnknownCodeError, UsageError) as error:
        print(f"southwell: {brief(str(error))}", file=sys.stderr)
        status = BAD_INPUT
    except KeyboardInterrupt:
        print("southwell: interrupted", file=sys.stderr)
        status = INTERRUPTED
    except BrokenPipeError:  # the reader of a pipe has seen enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        status = PASSED
    return status
