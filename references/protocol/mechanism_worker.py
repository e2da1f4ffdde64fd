"""Run codes that solve mechanisms in separate processes, with the protocol of ``worker``.

The request contains the code's import path, an initial guess and the mechanisms. The answer is one line per mechanism:
modes or a failure.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import msgspec
import numpy as np

from ...core.mechanism.description import Mechanism
from . import boundary, registry, wire
from .child import Reply, failed, foreign_exception, serve
from .interface import CodeError
from .mechanism_interface import MechanismAdapter, MechanismModes
from .process import Failure, Limits, one_line
from .worker import declined, exchange

Answer = MechanismModes | Failure


@dataclass(frozen=True)
class Request:
    """A request for the modes of each mechanism, near one guess of the steady state."""

    code: str
    folder: str | None
    guess: dict[str, float]
    mechanisms: list[Mechanism]


def answers(
    name: str, mechanisms: Sequence[Mechanism], guess: Mapping[str, float], limits: Limits, version: str = ""
) -> list[Answer]:
    """A code's modes of each mechanism, or a failure, in their order; other arguments as for ``worker.answers``.

    Raises:
        UnknownCodeError: if the name is unknown.
    """
    where = registry.address(name)

    def request(numbers: Sequence[int]) -> bytes:
        return encode(Request(**where, guess=dict(guess), mechanisms=[mechanisms[k] for k in numbers]))

    def modes(_: int, data: Any) -> MechanismModes:
        return boundary.mechanism_modes(data)

    return exchange(__name__, request, len(mechanisms), limits, modes, name, version)


def encode(value: Request) -> bytes:
    """Encode a request as JSON."""
    return msgspec.json.encode(value, enc_hook=_plain)


def decode(data: Any) -> Request:
    """Decode a request from plain data; the inverse of ``encode``."""
    return msgspec.convert(data, Request, dec_hook=lambda _, value: np.array(value, dtype=float))


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    raise TypeError(f"{type(value).__name__} cannot be sent to another process: {value!r}")


def _solve(code: MechanismAdapter, mechanism: Mechanism, guess: Mapping[str, float]) -> Reply:
    if no := declined(code, "unsupported_mechanism", mechanism):
        return no
    try:
        modes = code.solve_mechanism(mechanism, guess)
        if not isinstance(modes, MechanismModes):
            return failed("nonsense", f"mechanism_modes(): {type(modes).__name__}, not MechanismModes")
        return {"modes": wire.encode(modes)}
    except CodeError as error:
        return failed("refused", one_line(error))
    except BaseException as error:  # whatever the code raises affects this mechanism only
        return foreign_exception(error)


def _answer(data: Any) -> Iterator[Reply]:
    request = decode(data)
    code = registry.loaded(data)
    for mechanism in request.mechanisms:
        yield failed(code.kind, code.reason) if isinstance(code, Failure) else _solve(code, mechanism, request.guess)


def main() -> None:
    """Answer the one request on standard input."""
    serve(_answer)
