"""A report as nested data for ``print.typ``, which lays it out: text is never part of Typst's code."""

import re
from collections.abc import Callable, Iterator
from functools import partial
from html import unescape
from pathlib import Path
from typing import Any

from markdown_it.tree import SyntaxTreeNode

from .document import FOLD, Document, figure

Node = dict[str, Any]

WIDTH = (297 - 24) / 25.4 * 72
"""Width of the page between its margins, points."""

SIZE, PADDING = 6.6, 4.5
"""Font size of tables, and empty space of their cells, left and right together, points."""

LONG = 400
"""Rows with more characters than this in a cell may be broken, since they could be higher than a page."""

MAX_WORD = {"regular": 40, "bold": 40, "mono": 110}
"""Longest words in characters; longer ones may be broken anywhere. Half the width of the page; of code, three quarters."""


def nodes(document: Document, folder: Path) -> list[Node]:
    """The blocks of a report; figures are read from ``folder``.

    Raises:
        NotImplementedError: if there is no layout for a token.
        OSError: if a figure cannot be read.
    """
    tree = SyntaxTreeNode(document.tokens)
    ids = {str(node.attrs["id"]) for node in tree.walk() if node.type == "heading"}
    return _blocks(tree, partial(_inline, ids=ids, folder=folder))


Inline = Callable[[SyntaxTreeNode], Node]


def _blocks(parent: SyntaxTreeNode, inline: Inline) -> list[Node]:
    return [block for node in parent.children for block in _block(node, inline)]


def _block(node: SyntaxTreeNode, inline: Inline) -> Iterator[Node]:
    """The block of a token; none of the end of a collapsible section."""
    kind = node.type
    if kind == "heading":
        yield {"kind": kind, "level": int(node.tag[1:]), "id": node.attrs["id"], "body": _text(node, inline)}
    elif kind == "paragraph":
        follows = node.next_sibling is not None and node.next_sibling.type == "table"
        answer = str(node.attrs.get("class", ""))
        yield {
            "kind": "span" if node.hidden else kind,
            "sticky": follows,
            "answer": answer,
            "body": _text(node, inline),
        }
    elif kind in ("bullet_list", "ordered_list"):
        items = [_blocks(item, inline) for item in node.children]
        yield {"kind": kind, "start": node.attrs.get("start", 1), "items": items}
    elif kind in ("fence", "code_block"):
        yield {"kind": "code", "text": _broken(node.content.rstrip("\n"), "mono")}
    elif kind == "table":
        yield _table(node, inline)
    elif kind == "blockquote":
        yield {"kind": kind, "body": _blocks(node, inline)}
    elif kind == "hr":
        yield {"kind": kind}
    elif kind == "html_block" and (fold := FOLD.fullmatch(node.content.rstrip())):
        if fold[1] is not None:
            yield {"kind": "summary", "text": unescape(fold[1])}
    else:
        raise NotImplementedError(f"no layout in print for {kind}: add it to {__name__}")


def _text(parent: SyntaxTreeNode, inline: Inline) -> list[Node]:
    """The contents of a heading, paragraph or table cell."""
    return [inline(child) for outer in parent.children for child in outer.children]


def _inline(node: SyntaxTreeNode, ids: set[str], folder: Path) -> Node:
    kind = node.type
    if kind == "text":
        return {"kind": kind, "text": _broken(node.content, "regular")}
    if kind == "code_inline":
        return {"kind": kind, "text": _broken(node.content, "mono")}
    if kind == "softbreak":
        return {"kind": "text", "text": " "}
    if kind in ("hardbreak", "html_inline"):  # the only HTML is a line break
        return {"kind": "break"}
    if kind == "image":
        svg = figure(str(node.attrs["src"]), folder)
        return {"kind": "em", "body": _children(node, ids, folder)} if svg is None else _figure(node, svg)
    if kind in ("em", "strong", "link"):
        body, to = _children(node, ids, folder), str(node.attrs.get("href", ""))
        if kind == "link" and to.startswith("#"):
            return {"kind": "reference" if to[1:] in ids else "span", "to": to[1:], "body": body}
        return {"kind": kind if to or kind != "link" else "span", "to": to, "body": body}
    raise NotImplementedError(f"no layout in print for {kind}: add it to {__name__}")


def _children(node: SyntaxTreeNode, ids: set[str], folder: Path) -> list[Node]:
    return [_inline(child, ids, folder) for child in node.children]


def _figure(node: SyntaxTreeNode, svg: str) -> Node:
    return {"kind": "figure", "svg": svg, "alt": node.content}


def _table(table: SyntaxTreeNode, inline: Inline) -> Node:
    head, *rows = (row.children for part in table.children for row in part.children)
    cells = [
        {"verdict": cell.attrs.get("class", ""), "long": long, "body": _text(cell, inline)}
        for row in rows
        for long in [any(len(words(cell)) > LONG for cell in row)]
        for cell in row
    ]
    return {"kind": "table", "head": [_text(cell, inline) for cell in head], "cells": cells}


def words(cell: SyntaxTreeNode) -> str:
    """The text of a table cell."""
    return "".join(node.content for node in cell.walk() if not node.children)


def _broken(text: str, face: str) -> str:
    """Text with zero-width spaces in overlong words, such as paths and digests, which would leave the page."""
    return re.sub(rf"(\S{{{MAX_WORD[face]}}})(?=\S)", "\\1\u200b", text)
