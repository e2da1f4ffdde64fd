"""The notebook of the documentation as a page: its cells are run, and each is followed by what it shows."""

import ast
import json
import re
from collections.abc import Iterator
from contextlib import chdir, redirect_stdout
from io import StringIO
from pathlib import Path
from typing import Any
from unittest.mock import patch

import matplotlib.pyplot as plt
from matplotlib.axes import Axes

from ..campbell import interactive
from ..shared import style

STYLE = re.compile(r"<style.*?</style>", re.S)
"""Style that pandas gives to each of its tables; the site has its own."""

FIGURE = "figures/{}-{}.svg"
"""Path of a figure on the site, from the notebook's name and the number of the figure."""


def page(path: Path) -> dict[str, str]:
    """The page ``NAME.md`` of a notebook and its figures, by their paths on the site.

    The cells run one after the other in the notebook's folder, with figures by Matplotlib.
    """
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    names: dict[str, Any] = {"__name__": "__main__"}
    figures: dict[str, str] = {}
    parts: list[str] = []
    backend = plt.get_backend()
    plt.switch_backend("agg")
    try:
        with chdir(path.parent), patch.object(interactive, "installed", return_value=False):
            for cell in cells:
                source = "".join(cell["source"])
                if cell["cell_type"] == "markdown":
                    parts.append(source)
                    continue
                parts += [f"```python\n{source}\n```", *_shown(source, names)]
                for text in _figures():
                    name = FIGURE.format(path.stem, len(figures) + 1)
                    figures[name] = text
                    parts.append(f"![figure {len(figures)}]({name})")
    finally:
        plt.close("all")
        plt.switch_backend(backend)
    parts.insert(1, f"This page is the notebook [{path.name}]({path.name}), run when the site was built.")
    return {f"{path.stem}.md": "\n\n".join(parts) + "\n"} | figures


def _shown(source: str, names: dict[str, Any]) -> Iterator[str]:
    """Run a cell; what it prints, and the HTML or text of its last expression unless a semicolon ends it."""
    body, expression = ast.parse(source).body, None
    if body and isinstance(last := body[-1], ast.Expr) and not source.rstrip().endswith(";"):
        body, expression = body[:-1], last.value
    buffer = StringIO()
    with redirect_stdout(buffer):
        exec(compile(ast.Module(body, []), "<cell>", "exec"), names)
        value = None if expression is None else eval(compile(ast.Expression(expression), "<cell>", "eval"), names)
    if buffer.getvalue():
        yield f"```text\n{buffer.getvalue()}```"
    if value is not None and not isinstance(value, Axes):
        html = getattr(value, "_repr_html_", None)
        yield f'<div class="output">{STYLE.sub("", html())}</div>' if html else f"```text\n{value!r}\n```"


def _figures() -> Iterator[str]:
    """The SVG of each open figure, which is closed."""
    for number in plt.get_fignums():
        yield style.svg(plt.figure(number))
        plt.close(number)
