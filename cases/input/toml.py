"""Conversion of a TOML file to a frozen structure; errors are one line: file, field, value, likely cause, remedy."""

import math
import re
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeVar

import msgspec
from msgspec import inspect

from . import files
from .errors import CaseError, nearest
from .names import RULE

T = TypeVar("T")


def document(path: Path, remedy: str = "correct the path") -> dict[str, Any]:
    """Read the tables of a TOML file; ``remedy`` is the remedy if it does not exist.

    Raises:
        CaseError: if the file does not exist, is not text, not TOML, or nested too deeply.
    """
    text = files.text(path, remedy=remedy)
    try:
        for k, line in enumerate(text.splitlines(), 1):
            if line.count(".") > DEEPEST and max(part.count(".") for part in re.split("[,=]", line)) > DEEPEST:
                raise CaseError(f"{path}: line {k}: more than {DEEPEST} dots in one key or value: correct that line")
        content = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise CaseError(f"{path}: not TOML: {_short(str(error))}: correct that line") from error
    except RecursionError:
        raise _too_deep(path) from None
    except ValueError:  # Python's limit on the digits of an integer
        raise CaseError(f"{path}: integer too large: more than 4,300 digits; check the number") from None
    if _depth(content) > DEEPEST:
        raise _too_deep(path)
    return content


OR_A_NAME = "correct the path, or give the name of a case"
"""The remedy for a missing file where a case may also be named."""

DEEPEST = 32
"""Maximum nesting depth of tables and lists; valid files need at most 6."""


def _too_deep(path: Path) -> CaseError:
    return CaseError(f"{path}: more than {DEEPEST} tables or lists within each other: check that it is the right file")


def _depth(value: Any) -> int:
    """Nesting depth of tables and lists, counted up to one above the limit."""
    layer, depth = [value], 0
    while layer and depth <= DEEPEST:
        nested = [v for v in layer if isinstance(v, (dict, list))]
        layer = [item for v in nested for item in (v.values() if isinstance(v, dict) else v)]
        depth += bool(nested)
    return depth


def _short(value: str) -> str:
    """Text from a file for a message; the middle of a long text is omitted."""
    return value if len(value) <= SHOWN else f"{value[: SHOWN // 2]} … {value[-SHOWN // 2 :]}"


SHOWN = 200
"""Maximum number of characters of a value in a message."""

MAX_NUMBER = 1e30
"""Numbers in a file must be smaller than this, in any unit."""


def finite(value: Any, path: str, field: str = "") -> None:
    """Reject non-finite and implausibly large numbers at any depth.

    Raises:
        CaseError: naming the first such number.
    """
    if isinstance(value, Mapping):
        for key, item in value.items():
            finite(item, path, f"{field}.{key}" if field else key)
    elif isinstance(value, list):
        for k, item in enumerate(value):
            finite(item, path, f"{field}[{k}]")
    elif isinstance(value, float) and not math.isfinite(value):
        raise CaseError(f"{path}: {field}: {value}: not a finite number: fill gaps in the data")
    elif isinstance(value, int | float) and abs(value) > MAX_NUMBER:
        size = f"{value:.3g}" if isinstance(value, float) or abs(value) < 10**300 else "more than 300 digits"
        raise CaseError(f"{path}: {field}: {size}: implausibly large; check the exponent")


def convert(data: Any, kind: type[T], path: str, container: str = "") -> T:
    """Convert ``data`` to a ``kind``; ``container`` is the field that contains it.

    Raises:
        CaseError: naming the invalid field.
    """
    try:
        return msgspec.convert(data, kind)
    except RecursionError:
        raise _too_deep(Path(path)) from None
    except msgspec.ValidationError as error:
        message, _, where = str(error).partition(" - at `")
        if where.startswith("key"):
            table = ".".join(filter(None, (container, where.partition("$")[2].strip("`."))))
            raise CaseError(f"{path}: {table}: a key that is not a name: {RULE}: correct it") from error
        where = where.removeprefix("$")
        raise CaseError(f"{path}: {_explain(message, where.strip('`.'), data, kind, container)}") from error


def _explain(message: str, field: str, raw: Any, kind: type, container: str) -> str:
    full = ".".join(part for part in (container, field) if part).replace(".[", "[")
    key = re.search(r"field `(.+)`", message)
    if key:
        dotted = f"{full}.{key[1]}" if full else key[1]
        if "unknown" in message:
            return f"{dotted}: unknown key: {nearest(key[1], _keys(kind, field, raw))}"
        return f"{dotted}: missing: add it"
    value, node = _walk(kind, field, raw)
    if "matching regex" in message and isinstance(value, str):
        if re.fullmatch(r"[a-z0-9][a-z0-9.-]*", value.lower()):
            return f"{full}: {_short(repr(value))}: capital letters, in a name that is typed: write {value.lower()!r}"
        return f"{full}: {_short(repr(value))}: not a name: {RULE}"
    choices = _choices(node)
    if not choices:  # the tag of a structure belongs to its union, not to the structure's fields
        table, _, _ = field.rpartition(".")
        choices = _choices(_walk(kind, table, raw, full_union=True)[1])
    if isinstance(value, str) and choices and "nvalid" in message:
        return f"{full}: {_short(repr(value))}: not one of its values: {nearest(value, choices)}"
    sentence = message[0].lower() + message[1:].replace("`", "")
    return f"{full}: {_short(repr(value))}: {sentence}: check sign, unit and type"


def _choices(node: Any) -> tuple[str, ...]:
    """Allowed values of a type, or of the tag of its structures."""
    kinds = node.types if isinstance(node, inspect.UnionType) else (node,)
    words = [w for k in kinds if isinstance(k, inspect.LiteralType) for w in k.values]
    tags = [k.tag for k in kinds if isinstance(k, inspect.StructType) and k.tag_field]
    return tuple(str(word) for word in words or tags)


def _keys(kind: type, field: str, raw: Any) -> tuple[str, ...]:
    _, node = _walk(kind, field, raw)
    return tuple(f.encode_name for f in node.fields) if isinstance(node, inspect.StructType) else ()


def _walk(kind: type, field: str, raw: Any, full_union: bool = False) -> tuple[Any, Any]:
    """The value in a field, as given, and its expected type; with ``full_union``, the complete union."""
    node: Any = _plain(inspect.type_info(kind), raw)
    steps = re.findall(r"[^.\[\]]+", field)
    for k, step in enumerate(steps):
        if isinstance(raw, list) and step.isdigit():
            raw, node = raw[int(step)], getattr(node, "item_type", None)
        elif isinstance(raw, Mapping) and step in raw:
            raw = raw[step]
            node = next((f.type for f in getattr(node, "fields", ()) if f.encode_name == step), None)
        node = _plain(node, raw, full_union and k == len(steps) - 1)
    return raw, node


def _plain(node: Any, raw: Any, full_union: bool = False) -> Any:
    """The type without annotations; of a union, the member that the value's tag names, or the only structure."""
    while isinstance(node, inspect.Metadata):
        node = node.type
    if isinstance(node, inspect.UnionType) and not (full_union or isinstance(raw, str)):
        kinds = [k for k in (_plain(t, raw) for t in node.types) if isinstance(k, inspect.StructType)]
        tagged = [k for k in kinds if k.tag_field and isinstance(raw, Mapping) and raw.get(k.tag_field) == k.tag]
        return next(iter(tagged or kinds), None)
    return node
