"""The command line: bad input is one line on standard error and status 2, never a traceback."""

import sys
import traceback
from collections.abc import Sequence
from contextlib import redirect_stderr, redirect_stdout
from importlib.metadata import version

from cyclopts import App, CycloptsError, UnusedCliTokensError
from numba.core import event
from threadpoolctl import threadpool_limits

from ...cases.input import files
from ...cases.input.errors import CaseError, brief
from ...references.protocol.registry import UnknownCodeError
from ..shared import streams
from ..shared.console import LogSafe
from ..shared.statuses import BAD_INPUT, INCOMPLETE, INTERNAL, INTERRUPTED, PASSED, listed
from .arguments import IncompleteError, UsageError

OUTSIDE = "--allow-outside"
"""An option of every command, wherever it stands."""

app = App(
    name="southwell",
    help=f"""Are these natural frequencies of a rotating blade right?

    One blade through many independent codes, every difference with its uncertainty and its cause.

    Exit status: {listed()}.
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
    """The entry point; ends the process with the command's status, see ``statuses``."""
    given = sys.argv[1:] if arguments is None else list(arguments)
    streams.prepare()
    with (
        redirect_stdout(LogSafe(sys.stdout)),  # pyright: ignore[reportArgumentType]
        redirect_stderr(LogSafe(sys.stderr)),  # pyright: ignore[reportArgumentType]
        files.outside_allowed(OUTSIDE in given),
    ):
        status = _status([word for word in given if word != OUTSIDE])
        streams.finish()
    sys.exit(status)


def _status(arguments: list[str]) -> int:
    """Run a command; its exit status."""
    event.register("numba:compile", _FirstUse())
    try:
        status = _run(arguments)
        sys.stdout.flush()
    except UnusedCliTokensError as error:
        words = " ".join(error.unused_tokens or ())
        status = _told(f"{words}: not understood here: more words than the command takes; see --help", BAD_INPUT)
    except (CycloptsError, CaseError, UnknownCodeError, UsageError) as error:
        status = _told(error, BAD_INPUT)
    except IncompleteError as error:
        status = _told(error, INCOMPLETE)
    except KeyboardInterrupt:
        status = _told("interrupted", INTERRUPTED)
    except OSError as error:
        what = f"{error.filename}: {error.strerror}" if error.filename else f"output: {error.strerror or error}"
        status = _told(what, BAD_INPUT)
    except Exception as error:
        traceback.print_exc()
        status = _told(
            f"internal error: {type(error).__name__}: {error}: please report it, with the lines above", INTERNAL
        )
    return status


def _run(arguments: list[str]) -> int:
    if arguments in ([], *([flag] for flag in app.help_flags)):
        app.resolved_commands()  # loads what is otherwise loaded when asked for, whose help has a line each here
    with threadpool_limits(1):  # matrices are small: threads would wait for each other
        return app(arguments, exit_on_error=False, print_error=False, result_action="return_value") or PASSED


def _told(what: object, status: int) -> int:
    """Say in one line why there is no more; the status."""
    print(f"southwell: {brief(str(what))}", file=sys.stderr)
    return status
