"""Descriptions of codes as plain data, which is all that the rest of the program uses.

A code is imported in a separate process and its declarations are validated; if that fails, the description has a
``failure``. The codes of the package share one process; a code that crashes it is described again alone, as are those after it.
"""

import inspect
import json
import re
import sys
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import Annotated, Any

import numpy as np
from msgspec import Meta

from ...core.blade import Blade
from ...core.effects import ALL_EFFECTS, Effects
from . import boundary, registry
from .boundary import NonsenseError
from .fingerprint import Elements
from .interface import (
    DIGITS,
    MOTIONS,
    PRINTABLE,
    BladeAdapter,
    Independence,
    MechanismAdapter,
    Motion,
    SharedWithCore,
    TextLine,
    shares,
)
from .process import Failure, Limits, converse, one_line, raised
from .registry import UnknownCodeError
from .turbines import TurbineAdapter
from .wire import Reply, decode_blade, encode, failed, foreign_exception, serve

PROCESSES = 2
"""Processes used at the same time."""

DESCRIBE_LIMITS = Limits(seconds=120.0)
"""Default limits for describing one code; most of the time is its import."""


NAME = r"[^\W_][\w.+-]*"

LONGEST_NAME = 60


@dataclass(frozen=True)
class Description:
    """A code, as its adapter declares it (see ``interface`` and ``turbines``).

    Attributes:
        asked: the name or import path given to ``describe``; ``worker.answers`` accepts it too.
        name: as declared.
        title, effects, hint, levels, order, finest, motions, digits, bracket, independence, distribution: as declared.
        blades, mechanisms, turbines: whether the code solves them.
        version: None if it is not installed.
        refused: for each blade, the reason why the code does not support it; None if it does, or if the reason is
            invalid (the worker that solves the blade reports that).
        page: its module's docstring.
        failure: what went wrong; None if nothing did. If set, only ``asked`` and ``name`` are valid.
    """

    asked: str
    name: Annotated[str, Meta(max_length=LONGEST_NAME, pattern=f"^{NAME}$")]
    title: TextLine = ""
    effects: Effects = ALL_EFFECTS
    hint: TextLine = ""
    levels: Annotated[tuple[Elements, ...], Meta(max_length=20)] = ()
    order: Annotated[int, Meta(ge=0, le=100)] = 0
    finest: Elements | None = None
    motions: Annotated[tuple[Motion, ...], Meta(min_length=1, max_length=4)] = MOTIONS
    digits: Annotated[int, Meta(ge=1, le=17)] = DIGITS
    bracket: bool = False
    independence: Independence | None = None
    distribution: TextLine = ""
    blades: bool = True
    mechanisms: bool = True
    turbines: bool = False
    version: Annotated[str, Meta(min_length=1, max_length=100, pattern=PRINTABLE)] | None = None
    refused: tuple[str | None, ...] = ()
    page: str = ""
    failure: Failure | None = None

    @property
    def shares(self) -> SharedWithCore:
        """What the code shares with core."""
        return shares(self.independence)


def describe(
    names: Sequence[str], blades: Sequence[Blade] = (), limits: Limits = DESCRIBE_LIMITS
) -> tuple[Description, ...]:
    """Describe codes, in the order of ``names``.

    Args:
        names: as for ``registry.locate``.
        blades: passed to ``unsupported`` of each code that solves blades, for ``refused``.
        limits: for each code.

    Raises:
        UnknownCodeError: if a name is unknown, or there is no code at an import path.
    """
    where = {name: registry.address(name) for name in names}
    encoded = [encode(blade) for blade in blades]
    bundled = {name: at for name, at in where.items() if registry.bundled(at["code"])}
    descriptions = {description.asked: description for description in _asked(bundled, encoded, limits)}
    unanswered = [name for name in where if name not in descriptions or descriptions[name].failure]
    with ThreadPoolExecutor(PROCESSES) as threads:
        descriptions_alone = threads.map(lambda name: _asked({name: where[name]}, encoded, limits)[0], unanswered)
        descriptions |= zip(unanswered, descriptions_alone, strict=True)
    for description in descriptions.values():
        mistyped = ":" in description.asked
        if description.failure and description.failure.kind == "unknown" and mistyped:
            raise UnknownCodeError(description.failure.reason)
    return tuple(descriptions[name] for name in names)


def _asked(where: Mapping[str, registry.Address], blades: Sequence[Any], limits: Limits) -> list[Description]:
    """Describe codes, by name and address, in one process; if a code ends the process, it and all after it fail."""
    if not where:
        return []
    names, request = list(where), {"codes": list(where.values()), "blades": blades}
    lines, failure = converse(__name__, json.dumps(request).encode(), len(names), limits)
    out = []
    for number, (name, line) in enumerate(zip(names, lines, strict=False)):
        try:
            out.append(_described(name, boundary.reply(line, number), len(blades)))
        except NonsenseError as error:
            failure = Failure("nonsense", str(error))
            break
    return out + [_failed(name, failure) for name in names[len(out) :]]


def _failed(asked: str, failure: Failure, name: Any = None) -> Description:
    """A description with a failure only; ``name`` is used if it is valid, ``asked`` otherwise."""
    proper = isinstance(name, str) and len(name) <= LONGEST_NAME and re.fullmatch(NAME, name)
    return Description(asked, name if proper else one_line(asked), failure=failure)


def _described(asked: str, data: dict[str, Any], blades: int) -> Description:
    """The description in a reply; one with a failure if the declarations are invalid."""
    error = data.pop("raised", "")
    try:
        if failure := boundary.failure(data):
            return _failed(asked, failure)
        answer = boundary.convert({**data, "asked": asked, "failure": None}, Description)
        _require(
            answer.blades or answer.mechanisms or answer.turbines, "the code solves no blades, mechanisms or turbines"
        )
        if answer.blades or answer.turbines:
            _require(len(answer.levels) > 0, "levels: (): give at least one refinement")
            _require(bool(np.all(np.diff(answer.levels) > 0)), f"levels: {answer.levels}: not ascending")
        _require(
            len(answer.refused) in (0, blades), f"unsupported(): {len(answer.refused)} answers for {blades} blades"
        )
    except NonsenseError as invalid:
        return _failed(asked, Failure("nonsense", one_line(invalid)), data.get("name"))
    failure = Failure("nonsense", one_line(error)) if error else None
    return replace(answer, refused=tuple(why and one_line(why) for why in answer.refused), failure=failure)


def _require(true: bool, message: str) -> None:
    if not true:
        raise NonsenseError(message)


BLADE_DECLARATIONS = ("levels", "order", "finest", "motions", "digits", "bracket")

TURBINE_DECLARATIONS = ("levels", "order", "finest")


def _facts(code: Any, blades: Sequence[Blade]) -> Reply:
    """The declarations of a code as plain data; exceptions of the code propagate."""
    solves, turbines, origin = isinstance(code, BladeAdapter), isinstance(code, TurbineAdapter), code.independence
    refinement = BLADE_DECLARATIONS if solves else TURBINE_DECLARATIONS if turbines else ()
    facts = {
        "name": code.name,
        "title": code.title,
        "effects": vars(code.effects) if type(code.effects) is Effects else code.effects,
        "hint": code.hint,
        "blades": solves,
        "mechanisms": isinstance(code, MechanismAdapter),
        "turbines": turbines,
        **{name: getattr(code, name) for name in refinement},
        "distribution": code.distribution,
        "independence": vars(origin) if isinstance(origin, Independence) else origin,
        "version": None,
        "page": (inspect.getdoc(sys.modules.get(type(code).__module__)) or "").encode("utf-8", "replace").decode(),
    }
    try:
        facts["version"] = code.version()
    except BaseException as error:  # an exit, too
        facts["raised"] = f"version(): {raised(error)}"
    facts["refused"] = [_refusal(code, blade) for blade in blades] if solves else []
    return {name: _plain(value) for name, value in facts.items()}


def _refusal(code: Any, blade: Blade) -> str | None:
    try:
        why = code.unsupported(blade)
    except BaseException:  # an exit, too
        return None
    return why if isinstance(why, str) else None


def _plain(value: Any) -> Any:
    """A value that JSON can represent; anything else becomes an object that every schema rejects."""
    if value is None or isinstance(value, str | int | float):
        return value
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, dict):
        return {str(key): _plain(item) for key, item in value.items()}
    return {type(value).__name__: one_line(repr(value))}


def _answer(request: Any) -> Iterator[Reply]:
    blades = [decode_blade(blade) for blade in request["blades"]]
    for where in request["codes"]:
        code = registry.loaded(where)
        if isinstance(code, Failure):
            yield failed(code.kind, code.reason)
            continue
        try:
            yield _facts(code, blades)
        except BaseException as error:
            yield foreign_exception(error, "its declarations")


def main() -> None:
    """Answer the one request on standard input."""
    serve(_answer)
