"""Fields of a YAML file with their line numbers."""

from collections import Counter
from dataclasses import dataclass
from typing import Any, cast

import numpy as np
import yaml
from numpy.typing import NDArray
from yaml.composer import ComposerError

from ..errors import CaseError, nearest
from .text import Text, believable, number

Array = NDArray[np.float64]

LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
"""The loader of libyaml, if available: twenty times faster."""

DEEPEST, MOST_NODES = 64, 1_000_000
"""Limits on the nesting depth and on the number of nodes; the largest public turbine has 300,000 nodes."""


@dataclass(frozen=True)
class Field:
    """A node of the file and its path of keys."""

    text: Text
    name: str
    node: yaml.Node

    @property
    def at(self) -> str:
        """Its position, for a message."""
        return _at(self.text, self.node, self.name)

    def find(self, *path: str) -> "Field | None":
        """The field under these keys; None if one of them is missing.

        Raises:
            CaseError: if a node on the path is not a mapping.
        """
        current = self
        for key in path:
            node = current._keys().get(key)
            if node is None:
                return None
            current = Field(self.text, f"{current.name}.{key}".lstrip("."), node)
        return current

    def get(self, *path: str) -> "Field":
        """The field under these keys.

        Raises:
            CaseError: naming the first missing key.
        """
        current = self
        for key in path:
            field = current.find(key)
            if field is None:
                raise CaseError(f"{current.at}: no key {key}: {nearest(key, current._keys())}; add it")
            current = field
        return current

    def number(self) -> float:
        """A finite number.

        Raises:
            CaseError: if it is not a finite number.
        """
        return _number(self.text, self.node, self.name)

    def word(self) -> str:
        """The value as text.

        Raises:
            CaseError: if it is a list or a mapping.
        """
        if not isinstance(self.node, yaml.ScalarNode):
            raise CaseError(f"{self.at}: expected a single value: correct it")
        return str(self.node.value)

    def numbers(self) -> Array:
        """A list of finite numbers, (n,).

        Raises:
            CaseError: naming the line of the first invalid item.
        """
        return np.array([_number(self.text, node, self.name) for node in self._items()])

    def rows(self, width: int) -> Array:
        """A list of lists of ``width`` finite numbers, (n, width).

        Raises:
            CaseError: naming the line of the first invalid row.
        """
        rows = [Field(self.text, f"{self.name}[{k}]", node) for k, node in enumerate(self._items())]
        for row in rows:
            count = len(row._items())
            if count != width:
                raise CaseError(f"{row.at}: {count} numbers instead of {width}: check the row")
        return np.array([row.numbers() for row in rows]).reshape(-1, width)

    def parts(self) -> "list[Field]":
        """The items of a list, each with keys of its own.

        Raises:
            CaseError: if it is not a list.
        """
        return [Field(self.text, f"{self.name}[{k}]", node) for k, node in enumerate(self._items())]

    def item(self, k: int) -> str:
        """Position of item ``k`` of a list, for a message."""
        return _at(self.text, self._items()[k], self.name)

    def names(self) -> tuple[str, ...]:
        """The keys of a mapping.

        Raises:
            CaseError: if it is not a mapping.
        """
        return tuple(self._keys())

    def _items(self) -> list[yaml.Node]:
        if not isinstance(self.node, yaml.SequenceNode):
            raise CaseError(f"{self.at}: expected a list: correct it")
        return self.node.value

    def _keys(self) -> dict[str, yaml.Node]:
        if isinstance(self.node, yaml.ScalarNode) and self.node.tag == "!include":
            raise CaseError(f"{self.at}: is in another file ({self.node.value}): insert its text here")
        if not isinstance(self.node, yaml.MappingNode):
            raise CaseError(f"{self.at}: expected keys with values: check the indentation")
        out = {str(key.value): value for key, value in self.node.value}
        if len(out) < len(self.node.value):
            ((repeated, _),) = Counter(str(key.value) for key, _ in self.node.value).most_common(1)
            raise CaseError(f"{self.at}: key {repeated} is given twice: remove one")
        return out


def fields(text: Text) -> Field:
    """The file's outermost field.

    Raises:
        CaseError: if it is not YAML.
    """
    content = "\n".join(text.lines)
    try:
        _bounded(text, content)
        try:
            node = yaml.compose(content, Loader=LOADER)
        except ComposerError:
            node = yaml.compose(content, Loader=_Reusing)
    except yaml.MarkedYAMLError as error:
        line = f": line {error.problem_mark.line + 1}" if error.problem_mark else ""
        raise CaseError(f"{text.path}{line}: not YAML: {error.problem}: correct it") from error
    except RecursionError:
        raise CaseError(f"{text.path}: not YAML: nested too deeply: check that it is the right file") from None
    except yaml.YAMLError as error:
        raise CaseError(f"{text.path}: not YAML: {' '.join(str(error).split())}: correct it") from error
    if node is None:
        raise CaseError(f"{text.path}: contains only comments: give the blade's file")
    return Field(text, "", cast(yaml.Node, node))


def _bounded(text: Text, content: str) -> None:
    """Reject files that would crash libyaml's recursive composer or exhaust memory.

    Raises:
        CaseError: naming the line.
        yaml.YAMLError: if the file is not YAML.
    """
    depth = 0
    for count, event in enumerate(yaml.parse(content, Loader=LOADER)):
        opens = isinstance(event, (yaml.SequenceStartEvent, yaml.MappingStartEvent))
        depth += opens - isinstance(event, (yaml.SequenceEndEvent, yaml.MappingEndEvent))
        if depth > DEEPEST or count > MOST_NODES:
            excess = f"{DEEPEST} lists or keys within each other" if depth > DEEPEST else f"{MOST_NODES} values"
            raise CaseError(f"{text.at(event.start_mark.line)}: more than {excess}: check that it is the right file")


class _Reusing(yaml.SafeLoader):
    """Loader that allows an anchor to be redefined, as in YAML 1.2 (§ 6.9.2); an alias refers to the latest one."""

    def compose_node(self, parent: yaml.Node | None, index: Any) -> yaml.Node | None:
        """Compose the next node after releasing its anchor."""
        if not self.check_event(yaml.AliasEvent):
            self.anchors.pop(self.peek_event().anchor, None)  # pyright: ignore[reportAttributeAccessIssue]
        return super().compose_node(parent, index)


def _number(text: Text, node: yaml.Node, name: str) -> float:
    scalar = node.value if isinstance(node, yaml.ScalarNode) else "a list or keys"
    value = number(scalar)
    if value is None or not believable(value):
        raise CaseError(f"{_at(text, node, name)}: {scalar!r} is not a finite number: fill gaps in the data")
    return value


def _at(text: Text, node: yaml.Node, name: str) -> str:
    return text.at(node.start_mark.line) + (f": {name}" if name else "")
