"""The command line. Bad input gives one line on standard error and status 2, never a traceback.

A command's module is imported when the command runs, so that `southwell --help` loads no numerical library.
"""

import sys
import traceback
from collections.abc import Sequence
from contextlib import AbstractContextManager, ExitStack, nullcontext, redirect_stderr, redirect_stdout
from pathlib import Path

from cyclopts import App, CycloptsError, Group, Parameter, UnusedCliTokensError

from ..shared import streams
from ..shared.log_safe import LogSafe
from ..shared.statuses import BAD_INPUT, INCOMPLETE, INTERNAL, INTERRUPTED, PASSED, listed
from .errors import IncompleteError, UsageError

OUTSIDE, ROOT = "--allow-outside", "--root"
"""Options that every command accepts, at any position."""

ABOUT = (
    "Verify the natural frequencies of rotating blades.",
    "Southwell solves a blade with its own multibody solver and with independent codes, and reports every difference with its "
    "uncertainty and, where known, its cause. For one command: southwell COMMAND --help.",
)

COMMANDS: dict[str, tuple[tuple[str, str, str], ...]] = {
    "Your blade": (
        (
            "campbell",
            "cli.blade.campbell:command",
            "Compute the Campbell diagram of a blade or a turbine and judge its margins.",
        ),
        ("modes", "cli.blade.modes:modes", "Compute the natural frequencies of a blade and name its modes."),
        ("show", "cli.blade.show:command", "Show the mass, sections and axes of a blade, and how its file was read."),
        ("convert", "cli.blade.convert:command", "Write a blade in another format."),
        ("study", "cli.blade.study:command", "Solve sampled variants of blades at many speeds."),
    ),
    "Verification": (
        (
            "verify",
            "cli.verify:command",
            "Solve blades and turbines with every code, compare the results and write a report.",
        ),
        ("report", "cli.report:command", "Rewrite the report of a finished run from its results.jsonl."),
        ("pages", "cli.pages:command", "Write the HTML report, the dashboard and a two-page summary of a run."),
        ("cases", "cli.listings:cases", "List the cases that come with the package."),
        (
            "codes",
            "cli.listings:code_app",
            "List the codes with their versions, what they share with Southwell's own solver, and how to install them.",
        ),
        ("conform", "cli.conform:command", "Run the conformance checks on a code."),
        ("validate", "validation.page:command", "Compare models of measured rotors with their measurements."),
        ("cache", "cli.cache:app", "Show, check or empty the store of answers that verify reuses."),
    ),
    "Other models": (
        ("mechanism", "cli.blade.modes:mechanism", "Compute the steady state and the modes of any mechanism."),
        ("judge", "cli.judge:command", "Judge linearisations of OpenFAST: find their defects and name their modes."),
        ("condense", "cli.blade.condense:command", "Condense finite element matrices of a blade to a multibody model."),
    ),
    "Regression and continuous integration": (
        ("gate", "cli.gate:command", "Compare a run with an earlier one; status 1 if anything got worse."),
        ("history", "cli.history:app", "Record the results of runs by commit."),
        ("dashboard", "cli.dashboard:command", "Write one or several runs as a static web site."),
    ),
}
"""Name, function and summary of each command by group; the summary is also the first line of the command's help."""


def _version() -> str:
    from importlib.metadata import version

    return version("southwell")


def _default(value: object) -> str | None:
    """The default of an option in its help; None, which shows nothing, for switches and options without a value."""
    return None if value in (None, "", ()) or value is False else str(value)


def build(listing: bool = False) -> App:
    """Build the application; with ``listing``, commands are listed but not imported."""
    *groups, last = (Group.create_ordered(name) for name in (*COMMANDS, "Options"))
    built = App(
        name="southwell",
        help="\n\n".join((*ABOUT, f"Exit status: {listed()}.")),
        help_format="plaintext" if listing else "markdown",  # the library for Markdown takes long to load
        help_epilogue=f"Every command also accepts {ROOT} FOLDER (files may refer to files anywhere in FOLDER) and {OUTSIDE} "
        "(files may refer to files in any folder).",
        group_commands=last,
        default_parameter=Parameter(negative=(), show_default=_default),
        version=_version,
        suppress_keyboard_interrupt=False,
    )
    reports = str(__package__).rpartition(".")[0]
    for group, commands in zip(groups, COMMANDS.values(), strict=True):
        for position, (name, target, line) in enumerate(commands):
            built.command(
                f"{reports}.{target}", name=name, group=group, sort_key=position, help=line if listing else None
            )
    built.register_install_completion_command(help="Install completion for bash, zsh or fish, and exit.")
    return built


app = build()


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line; end the process with the command's status, see ``statuses``."""
    words = sys.argv[1:] if arguments is None else list(arguments)
    streams.prepare()
    with (
        redirect_stdout(LogSafe(sys.stdout)),  # pyright: ignore[reportArgumentType]
        redirect_stderr(LogSafe(sys.stderr)),  # pyright: ignore[reportArgumentType]
    ):
        status = _status(words)
        streams.finish()
    sys.exit(status)


def _status(words: list[str]) -> int:
    """Run a command; return its exit status."""
    try:
        remaining_words, allowed = _allowed(words)
        with allowed:
            status = _run(remaining_words)
        sys.stdout.flush()
    except UnusedCliTokensError as error:
        status = _reported(f"{' '.join(error.unused_tokens or ())}: unexpected argument; see --help", BAD_INPUT)
    except (CycloptsError, UsageError) as error:
        status = _reported(error, BAD_INPUT)
    except IncompleteError as error:
        status = _reported(error, INCOMPLETE)
    except KeyboardInterrupt:
        status = _reported("interrupted", INTERRUPTED)
    except OSError as error:
        message = f"{error.filename}: {error.strerror}" if error.filename else f"output: {error.strerror or error}"
        status = _reported(message, BAD_INPUT)
    except Exception as error:
        from ...cases.input.errors import CaseError
        from ...references.protocol.registry import UnknownCodeError

        if isinstance(error, CaseError | UnknownCodeError):
            return _reported(error, BAD_INPUT)
        traceback.print_exc()
        message = f"internal error: {type(error).__name__}: {error}: please report it, with the lines above"
        status = _reported(message, INTERNAL)
    return status


def _run(words: list[str]) -> int:
    application = build(listing=True) if words in ([], *([flag] for flag in app.help_flags)) else app
    runs = bool(words) and words[0] in {name for commands in COMMANDS.values() for name, *_ in commands}
    with _one_thread() if runs else nullcontext():
        return application(words, exit_on_error=False, print_error=False, result_action="return_value") or PASSED


def _reported(message: object, status: int) -> int:
    """Print one line on why the command ended; return the status."""
    from ...cases.input.errors import brief

    print(f"southwell: {brief(str(message))}", file=sys.stderr)
    return status


def _allowed(words: Sequence[str]) -> tuple[list[str], AbstractContextManager[object]]:
    """The words without ``ROOT`` and ``OUTSIDE``, and the context in which files may be read as these options say.

    Raises:
        UsageError: if ``ROOT`` has no value.
        CaseError: if its value is not a folder.
    """
    remaining_words, roots, outside = [], [], False
    remaining = iter(words)
    for word in remaining:
        option, equals, value = word.partition("=")
        if word == OUTSIDE:
            outside = True
        elif option == ROOT:
            root = value if equals else next(remaining, "")
            if not root:
                raise UsageError(f"{ROOT}: missing folder: give the folder that holds all files of the deck")
            roots.append(root)
        else:
            remaining_words.append(word)
    stack = ExitStack()
    if outside or roots:
        from ...cases.input import files

        stack.enter_context(files.outside_allowed(outside))
        for root in roots:
            stack.enter_context(files.root_allowed(Path(root)))
    return remaining_words, stack


def _one_thread() -> AbstractContextManager[object]:
    from ...core.threads import one_thread

    return one_thread()
