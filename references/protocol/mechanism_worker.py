"""Foreign codes that take mechanisms, each in a process of its own: as ``worker`` for blades, and with its protocol.

The request holds the code's import path, a guess, and mechanisms; the answer is a line for each: modes, or a failure.
"""

import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, get_args

import msgspec
import numpy as np

from ...core.multibody.mechanism import Mechanism
from .interface import CodeError
from .mechanism_interface import MechanismCode, MechanismModes
from .registry import code as find
from .registry import locate
from .worker import Failure, converse, one_line, protocol_stream

Answer = MechanismModes | Failure


@dataclass(frozen=True)
class Request:
    """What a child is asked: modes of each mechanism, near one guess."""

    code: str
    guess: dict[str, float]
    mechanisms: list[Mechanism]


@dataclass(frozen=True)
class Reply:
    """What it says of one mechanism: either of the two."""

    modes: MechanismModes | None = None
    failure: Failure | None = None


def answers(name: str, mechanisms: Sequence[Mechanism], guess: Mapping[str, float], timeout: float) -> list[Answer]:
    """What a code answers to each of ``mechanisms``, in their order; arguments as for ``worker.answers``.

    Raises:
        UnknownCodeError: if there is no such code.
    """
    request = Request(locate(name), dict(guess), list(mechanisms))
    lines, ended = converse(__name__, encode(request).decode(), timeout)
    replies = [decode(line, Reply) for line in lines[: len(mechanisms)]]
    solved = [r.modes or r.failure or ended for r in replies]
    return solved + [ended] * (len(mechanisms) - len(solved))


def encode(value: Any) -> bytes:
    """A frozen structure as JSON; a complex array ends in an axis of length two."""
    return msgspec.json.encode(value, enc_hook=_plain)


def decode(text: str, kind: type[Any]) -> Any:
    """What ``encode`` was given."""
    return msgspec.json.decode(text, type=kind, dec_hook=_array)


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return (np.stack([value.real, value.imag], axis=-1) if np.iscomplexobj(value) else value).tolist()
    raise TypeError(f"{type(value).__name__} cannot be sent to a worker: {value!r}")


def _array(kind: Any, value: Any) -> Any:
    out = np.array(value, dtype=float)
    return out[..., 0] + 1j * out[..., 1] if np.dtype[np.complex128] in get_args(kind) else out


def _solve(code: MechanismCode, mechanism: Mechanism, guess: Mapping[str, float]) -> Reply:
    if code.version() is None:
        return Reply(failure=Failure("not installed", code.hint))
    try:
        modes = code.solve_mechanism(mechanism, guess)
    except CodeError as error:
        return Reply(failure=Failure("refused", one_line(error)))
    except Exception as error:  # whatever a foreign code raises is its answer to this mechanism, and no other's
        return Reply(failure=Failure("nonsense", f"{type(error).__name__}: {one_line(error)}"))
    return Reply(modes)


def main() -> None:
    """Answer the one request on standard input."""
    request: Request = decode(sys.stdin.read(), Request)
    with protocol_stream() as protocol:
        code: Any = find(request.code)
        for mechanism in request.mechanisms:
            protocol.write(encode(_solve(code, mechanism, request.guess)).decode() + "\n")
            protocol.flush()


if __name__ == "__main__":
    main()
