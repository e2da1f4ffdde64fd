"""The command line: bad input is one line on standard error and status 2, never a traceback.

A command's module is imported when the command runs: `southwell --help` loads no numerical library.
"""

import os
import sys
from collections.abc import Sequence
from contextlib import AbstractContextManager, nullcontext

from cyclopts import App, CycloptsError, Group, UnusedCliTokensError

from .exit_status import BAD_INPUT, INTERRUPTED, PASSED, UsageError

ONE_BLADE, VERIFY, OTHER, CI, LAST = (
    Group.create_ordered(name)
    for name in ("Your blade", "Verification", "Other models", "Regression and continuous integration", "Options")
)

COMMANDS = (
    (ONE_BLADE, "campbell", "cli.campbell:command", "Compute the Campbell diagram of a blade and judge its margins."),
    (ONE_BLADE, "modes", "cli.modes:modes", "Compute the natural frequencies of a blade and name its modes."),
    (ONE_BLADE, "show", "cli.show:command", "Show the mass, sections and axes of a blade, and how its file was read."),
    (ONE_BLADE, "convert", "cli.convert:command", "Write a blade in another format."),
    (VERIFY, "verify", "cli.verify:command", "Solve blades with every code, compare the results and write a report."),
    (VERIFY, "report", "cli.report:command", "Rewrite the report of a finished run from its results.jsonl."),
    (VERIFY, "cases", "cli.listings:cases", "List the cases that come with the package."),
    (
        VERIFY,
        "codes",
        "cli.listings:code_app",
        "List the codes: version, what they share with core, how to install them.",
    ),
    (VERIFY, "conform", "cli.conform:command", "Run the conformance checks on a code."),
    (
        VERIFY,
        "validate",
        "verification.validation_page:command",
        "Compare the model of a measured rotor with its measurements.",
    ),
    (VERIFY, "bench", "verification.bench:command", "Measure the run time of core and of the other codes."),
    (OTHER, "mechanism", "cli.modes:mechanism", "Compute the steady state and the modes of any mechanism."),
    (OTHER, "condense", "cli.condense:command", "Condense finite element matrices of a blade to a multibody model."),
    (
        OTHER,
        "closed-forms",
        "verification.closed_forms_page:command",
        "Compare core with mechanisms that have closed-form solutions.",
    ),
    (CI, "gate", "cli.gate:command", "Compare a run with an earlier one; status 1 if anything got worse."),
    (CI, "history", "cli.history:app", "Record the results of runs by commit."),
    (CI, "dashboard", "cli.dashboard:command", "Write a static site of one or several runs."),
)
"""Group, name, place and line in the list of commands; the line is also the first of the command's own help."""


def _version() -> str:
    from importlib.metadata import version

    return version("southwell")


def build(listing: bool = False) -> App:
    """The application; with ``listing`` each command has its line in the list but is not imported for it."""
    built = App(
        name="southwell",
        help="""Verify the natural frequencies of rotating blades.

        Southwell solves a blade with its own multibody solver and with independent codes, and reports every difference
        with its uncertainty and, where known, its cause. For one command: southwell COMMAND --help.

        Exit status: 0 passed; 1 a comparison failed or is inconclusive, or a margin is violated with --strict;
        2 invalid input; 130 interrupted.
        """,
        help_format="plaintext" if listing else "markdown",  # the library for Markdown takes long to load
        group_commands=LAST,
        version=_version,
        suppress_keyboard_interrupt=False,
    )
    reports = str(__package__).rpartition(".")[0]
    for place, (group, name, target, line) in enumerate(COMMANDS):
        path = f"{reports}.{target}"
        built.command(path, name=name, group=group, sort_key=place, help=line if listing else None)
    built.register_install_completion_command(help="Install completion for bash, zsh or fish, and exit.")
    return built


app = build()


def main(arguments: Sequence[str] | None = None) -> None:
    """The entry point; ends the process with the command's status."""
    if "" not in sys.path:
        sys.path.append("")  # a code named by its import path may lie in the current folder, as python -m finds it
    words = sys.argv[1:] if arguments is None else list(arguments)
    try:
        chosen = build(listing=True) if words in ([], *([flag] for flag in app.help_flags)) else app
        runs = bool(words) and words[0] in {name for _, name, *_ in COMMANDS}
        with _one_thread() if runs else nullcontext():
            status = chosen(words, exit_on_error=False, print_error=False, result_action="return_value") or PASSED
        sys.stdout.flush()
    except UnusedCliTokensError as error:
        unexpected = " ".join(error.unused_tokens or ())
        print(f"southwell: {unexpected}: unexpected argument; see --help", file=sys.stderr)
        status = BAD_INPUT
    except (CycloptsError, UsageError) as error:
        status = _bad_input(error)
    except KeyboardInterrupt:
        print("southwell: interrupted", file=sys.stderr)
        status = INTERRUPTED
    except BrokenPipeError:  # the reader of a pipe has seen enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        status = PASSED
    except ValueError as error:
        from ...cases.input.errors import CaseError
        from ...references.protocol.registry import UnknownCodeError

        if not isinstance(error, CaseError | UnknownCodeError):
            raise
        status = _bad_input(error)
    sys.exit(status)


def _one_thread() -> AbstractContextManager[object]:
    """Matrices are small: threads would wait for each other."""
    from threadpoolctl import threadpool_limits

    return threadpool_limits(1)


def _bad_input(error: Exception) -> int:
    print(f"southwell: {' '.join(str(error).split())}", file=sys.stderr)
    return BAD_INPUT
