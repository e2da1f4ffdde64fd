"""Run codes in separate processes. ``process`` enforces the limits, ``boundary`` validates the answers.

The process reads one request, with a blade, a turbine or mechanisms ::

    {"code": "module:attribute", "folder": …, "blade": {…}, "runs": [[omega, elements, count], …], "deck": {…}}
    {"code": "module:attribute", "folder": …, "blade": {…}, "fingerprints": [elements, …]}
    {"code": "module:attribute", "folder": …, "turbine": {…}, "runs": [[omega, elements, count], …]}
    {"code": "module:attribute", "folder": …, "turbine": {…}, "fingerprints": [elements, …]}
    {"code": "module:attribute", "folder": …, "mechanisms": [{…}, …], "guess": {…}}

imports the code, checks its version and whether it declines, and writes one line per question as soon as it is solved:
``{"run": 0, "modes": {…}}``, ``{"run": 0, "fingerprint": {…}}`` or ``{"run": 0, "kind": …, "reason": …}``. After a crash or a
limit, finished answers are kept.
"""

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, replace
from math import nan
from typing import TYPE_CHECKING, Any, TypeVar

from ...core.blade import Blade
from ...core.mechanism.description import Mechanism
from ...core.modes import STATIONS, Modes
from . import boundary, registry, sources, store
from .boundary import NonsenseError
from .fingerprint import Fingerprint
from .interface import CodeError, Deck, MechanismModes
from .process import Failure, Limits, converse, one_line
from .turbines import TurbineModes
from .wire import (
    Reply,
    decode_blade,
    decode_mechanism,
    decode_turbine,
    encode,
    encode_mechanism,
    encode_turbine,
    failed,
    foreign_exception,
    serve,
)

if TYPE_CHECKING:
    from ...core.turbine.turbine import Turbine

T = TypeVar("T")

Run = tuple[float, int, int]
"""Rotor speed (rad/s), elements, number of modes."""

Answer = Modes | Failure

MechanismAnswer = MechanismModes | Failure

TurbineAnswer = TurbineModes | Failure

FingerprintAnswer = Fingerprint | Failure | None
"""None: the code reports none."""


def answers(
    name: str, blade: Blade, runs: Sequence[Run], limits: Limits, version: str = "", deck: Deck | None = None
) -> list[Answer]:
    """A code's modes for each run, or a failure, in the order of ``runs``.

    Args:
        name: of the code, or its import path (see ``registry.locate``).
        blade: the blade to solve.
        runs: solved in this order; put the most important first.
        limits: for each run.
        version: of the code, as described; without it no answer is taken from the store.
        deck: files of the blade that the code reads itself; None: it solves ``blade``.

    Raises:
        UnknownCodeError: if the name is unknown.
    """
    fixed = {**registry.address(name), "blade": encode(blade), **({"deck": asdict(deck)} if deck else {})}

    def modes(number: int, data: Any) -> Modes:
        omega, _, count = runs[number]
        return boundary.modes(data, omega, count)

    return _exchange(fixed, "runs", runs, limits, modes, name, version)


def fingerprints(
    name: str, subject: "Blade | Turbine", elements: Sequence[int], limits: Limits, version: str = ""
) -> list[FingerprintAnswer]:
    """The fingerprint of a code's model of a blade or a turbine with each number of elements, or a failure.

    Other arguments and exceptions as for ``answers``.
    """
    encoded = {"blade": encode(subject)} if isinstance(subject, Blade) else {"turbine": encode_turbine(subject)}
    fixed = {**registry.address(name), **encoded}
    return _exchange(
        fixed,
        "fingerprints",
        elements,
        limits,
        lambda _, data: boundary.fingerprint(data),
        name,
        version,
        "fingerprint",
    )


def mechanism_answers(
    name: str, mechanisms: Sequence[Mechanism], guess: Mapping[str, float], limits: Limits, version: str = ""
) -> list[MechanismAnswer]:
    """A code's modes of each mechanism about the steady state near ``guess``, or a failure, in the order of ``mechanisms``.

    Other arguments and exceptions as for ``answers``.
    """
    fixed = {**registry.address(name), "guess": dict(guess)}

    encoded = [encode_mechanism(mechanism) for mechanism in mechanisms]
    return _exchange(
        fixed, "mechanisms", encoded, limits, lambda _, data: boundary.mechanism_modes(data), name, version
    )


def turbine_answers(
    name: str, turbine: "Turbine", runs: Sequence[Run], limits: Limits, version: str = ""
) -> list[TurbineAnswer]:
    """A code's modes of a turbine for each run, or a failure, in the order of ``runs``.

    Other arguments and exceptions as for ``answers``.
    """
    fixed = {**registry.address(name), "turbine": encode_turbine(turbine)}
    stations = len(STATIONS) * (1 + turbine.blades)

    def modes(number: int, data: Any) -> TurbineModes:
        return boundary.turbine_modes(data, runs[number][2], stations)

    return _exchange(fixed, "runs", runs, limits, modes, name, version)


def _exchange(
    fixed: Mapping[str, Any],
    key: str,
    questions: Sequence[Any],
    limits: Limits,
    validate: Callable[[int, Any], T],
    code: str,
    version: str,
    field: str = "modes",
) -> list[T | Failure]:
    """The answers to questions, each validated by ``validate(number, data)``, or failures in their place.

    Answers that are in the user's store are taken from it; the process of the code is asked for the others. Answers of codes
    that are not part of this package or of unknown version are not stored, as no digest covers them; nor are failures.

    Args:
        fixed: what requests have in common.
        key: of the questions in a request.
        questions: plain data.
        limits: for each of them.
        validate: validates an answer.
        code: name or import path of the code.
        version: its version; empty if unknown.
        field: key of the answer in a reply.
    """

    def request(numbers: Sequence[int]) -> bytes:
        return json.dumps({**fixed, key: [questions[k] for k in numbers]}).encode()

    user_store = store.opened() if limits.reuse and version and sources.bundled(code) else None
    keys = [store.key(request([k]), code, version) for k in range(len(questions))] if user_store else []
    out: dict[int, T | Failure] = {}
    for k, digest in enumerate(keys):
        if user_store and (answer := _stored(user_store, digest, validate, k, field)):
            out[k] = answer
    missing = [k for k in range(len(questions)) if k not in out]
    lines, failure = converse(__name__, request(missing), len(missing), limits) if missing else ([], NOTHING)
    for number, (k, line) in enumerate(zip(missing, lines, strict=False)):
        try:
            data = boundary.reply(line, number)
        except NonsenseError as error:
            failure = Failure("nonsense", str(error))
            break
        out[k] = answer = boundary.failure(data) or _validated(validate, k, data.get(field))
        if user_store and not isinstance(answer, Failure):
            with suppress(OSError):  # a full disk, or a damaged file
                user_store.put(keys[k], f"{code}, answers", line)
    return [out.get(k, failure) for k in range(len(questions))]


NOTHING = Failure("internal", "no question was asked")


def _stored(user_store: store.Store, key: str, validate: Callable[[int, Any], T], number: int, field: str) -> T | None:
    """The answer in the store, without the time that it took; None if there is none."""
    with suppress(KeyError, ValueError, TypeError, AttributeError):
        answer = validate(number, json.loads(user_store.get(key)[0]).get(field))
        return replace(answer, seconds=nan) if hasattr(answer, "seconds") else answer  # type: ignore[type-var]
    return None


def _validated(validate: Callable[[int, Any], T], number: int, data: Any) -> T | Failure:
    try:
        return validate(number, data)
    except (ValueError, TypeError) as error:  # from the schema, or from the class it creates
        return Failure("nonsense", one_line(error))


def _declined(code: Any, method: str, question: object) -> Reply | None:
    """A reply if the code is not installed, declines the problem, or raises an exception; None otherwise.

    Args:
        code: any code.
        method: name of the method that returns the reason for declining, e.g. ``unsupported``.
        question: a blade, a turbine or a mechanism.
    """
    try:
        why = getattr(code, method)(question)
    except BaseException as error:  # an exit, too
        return foreign_exception(error, f"{method}()")
    if not (why is None or isinstance(why, str)):
        return failed("nonsense", f"{method}(): {one_line(repr(why))}: neither a reason nor None")
    if why:
        return failed("unsupported", one_line(why))
    try:
        return failed("not installed", f"not installed: {one_line(code.hint)}") if code.version() is None else None
    except BaseException as error:
        return foreign_exception(error, "version()")


def _solved(expected: type, solve: Callable[..., Any], *question: Any) -> Reply:
    """The answer of a method of a code, or a failure; whatever it raises affects this question only."""
    try:
        answer = solve(*question)
        if expected is Fingerprint:
            if answer is None or isinstance(answer, Fingerprint):
                return {"fingerprint": answer and encode(answer)}
        elif isinstance(answer, expected):
            return {"modes": encode(answer)}
        return failed("nonsense", f"{METHODS[expected]}(): {type(answer).__name__}, not {expected.__name__}")
    except CodeError as error:
        return failed("refused", one_line(error))
    except BaseException as error:
        return foreign_exception(error)


METHODS: dict[type, str] = {
    Modes: "modes",
    Fingerprint: "fingerprint",
    TurbineModes: "turbine_modes",
    MechanismModes: "mechanism_modes",
}
"""The method of an adapter that returns each type."""


def _answer(request: Any) -> Iterator[Reply]:
    requests = request.get("runs") or request.get("fingerprints") or request["mechanisms"]
    code = registry.loaded(request)
    if not isinstance(code, Failure) and request.get("deck"):
        try:
            code = code.with_deck(Deck(**request["deck"]))
        except BaseException as error:
            code = Failure("nonsense", foreign_exception(error, "with_deck()")["reason"])
    if isinstance(code, Failure):
        yield from [failed(code.kind, code.reason)] * len(requests)
    elif "mechanisms" in request:
        for mechanism in map(decode_mechanism, requests):
            refusal = _declined(code, "unsupported_mechanism", mechanism)
            yield refusal or _solved(MechanismModes, code.solve_mechanism, mechanism, request["guess"])
    elif "turbine" in request:
        turbine = decode_turbine(request["turbine"])
        refusal = _declined(code, "unsupported_turbine", turbine)
        for question in requests:
            if "fingerprints" in request:
                yield refusal or _solved(Fingerprint, code.turbine_fingerprint, turbine, question)
            else:
                yield refusal or _solved(TurbineModes, code.solve_turbine, turbine, *question)
    else:
        blade = decode_blade(request["blade"])
        refusal = _declined(code, "unsupported", blade)
        for question in requests:
            if "fingerprints" in request:
                yield refusal or _solved(Fingerprint, code.fingerprint, blade, question)
            else:
                yield refusal or _solved(Modes, code.solve, blade, *question)


def main() -> None:
    """Answer the one request on standard input."""
    serve(_answer)
