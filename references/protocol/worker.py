"""Foreign codes at arm's length: each runs in a process of its own, under a time limit, and speaks JSON.

The child, ``python -m southwell.references.protocol.worker``, reads one request on its standard input ::

    {"code": "module:attribute", "blade": {…}, "runs": [[omega, elements, count], …]}

and writes one line for each run as soon as it is solved: ``{"modes": {…}}`` or ``{"kind": …, "error": …}``. A crash or
a time limit therefore loses only what was not finished. Whatever the foreign code prints goes to standard error.
"""

import contextlib
import json
import os
import signal
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, TextIO

from ...core.blade import Blade
from ...core.modes import Modes
from .interface import Code, CodeError
from .registry import code as find
from .registry import locate
from .wire import decode_blade, decode_modes, encode

Run = tuple[float, int, int]
"""Rotor speed (rad/s), elements, number of modes."""


@dataclass(frozen=True)
class Failure:
    """Why a run has no modes.

    Attributes:
        kind: ``crashed``, ``timed out``, ``nonsense`` (an answer that cannot be one), ``refused`` (the code says it
            could not answer), ``not installed``.
        reason: one line for a table.
    """

    kind: Literal["crashed", "timed out", "nonsense", "refused", "not installed"]
    reason: str


Answer = Modes | Failure


def answers(name: str, blade: Blade, runs: Sequence[Run], timeout: float) -> list[Answer]:
    """What a code answers to each of ``runs``, in their order.

    Args:
        name: of the code, or its import path (see ``references.codes.locate``).
        blade: the blade to solve.
        runs: what to solve, in this order; put first what matters most.
        timeout: seconds for all of them together.

    Raises:
        UnknownCodeError: if there is no such code.
    """
    request = json.dumps({"code": locate(name), "blade": encode(blade), "runs": [list(run) for run in runs]})
    lines, ended = converse(__name__, request, timeout)
    solved = [_answer(line) for line in lines[: len(runs)]]
    return solved + [ended] * (len(runs) - len(solved))


def converse(module: str, request: str, timeout: float) -> tuple[list[str], Failure]:
    """The lines that ``python -m module`` writes in answer to a request, and why there are no more.

    Args:
        module: what to run, in a process of its own that ends with this call.
        request: its standard input.
        timeout: seconds.
    """
    limits = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    child = subprocess.Popen(
        [sys.executable, "-m", module],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        env={**os.environ, **limits},
        text=True,
        encoding="utf-8",
        errors="replace",
        start_new_session=True,
    )
    ended = None
    try:
        out, err = child.communicate(request, timeout)
    except subprocess.TimeoutExpired:
        ended = Failure("timed out", f"no answer within {timeout:g} s")
        _kill(child)
        out, err = child.communicate()
    except BaseException:
        _kill(child)
        raise
    return out.split("\n")[:-1], ended or _crash(child.returncode, err)


def _kill(child: subprocess.Popen[str]) -> None:
    with contextlib.suppress(ProcessLookupError):
        os.killpg(child.pid, signal.SIGKILL)


def _answer(line: str) -> Answer:
    data = json.loads(line)
    return decode_modes(data["modes"]) if "modes" in data else Failure(data["kind"], data["error"])


def _crash(status: int, err: str) -> Failure:
    last = (err.strip().splitlines() or [""])[-1].strip()
    how = f"signal {signal.Signals(-status).name}" if status < 0 else f"exit status {status}"
    return Failure("crashed", f"the code's process ended with {how}" + (f": {last}" if last else ""))


def _solve(code: Code, blade: Blade, run: Run) -> dict[str, object]:
    omega, elements, count = run
    try:
        modes = code.solve(blade, omega, elements, count)
    except CodeError as error:
        return {"kind": "refused", "error": one_line(error)}
    except Exception as error:  # whatever a foreign code raises is its answer to this run, and no other's
        return {"kind": "nonsense", "error": f"{type(error).__name__}: {one_line(error)}"}
    if not len(modes.frequencies) or (modes.frequencies[1:] < modes.frequencies[:-1]).any():
        return {"kind": "nonsense", "error": f"frequencies {modes.frequencies.tolist()} are not ascending"}
    return {"modes": encode(modes)}


def one_line(error: Exception) -> str:
    """An error's message without line breaks."""
    return " ".join(str(error).split())


def protocol_stream() -> TextIO:
    """Standard output for the protocol alone: whatever a foreign code prints goes to standard error from here on."""
    stream = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)
    return stream


def main() -> None:
    """Answer the one request on standard input."""
    request = json.load(sys.stdin)
    with protocol_stream() as protocol:
        code, blade = find(request["code"]), decode_blade(request["blade"])
        for run in request["runs"]:
            if code.version() is None:
                answer: dict[str, object] = {"kind": "not installed", "error": code.hint}
            else:
                answer = _solve(code, blade, run)
            protocol.write(json.dumps(answer) + "\n")
            protocol.flush()


if __name__ == "__main__":
    main()
