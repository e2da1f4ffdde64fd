"""What mkdocs does not do by itself: pages made from the package, and formulas as MathML, which browsers draw unaided."""

import re
import shutil
from collections.abc import Sequence
from html import unescape
from pathlib import Path
from typing import Any
from unicodedata import lookup, name

from latex2mathml.converter import convert
from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files

from southwell.reports.site import pages

FORMULA = re.compile(r'<(span|div) class="arithmatex">\\[(\[](.*?)\\[)\]]</\1>', re.S)
NUMBER = re.compile(r"\\tag\{(.*?)\}")
INLINE = re.compile(r"(?<!</span>)(?<=<code>)[^<\s]+(?=</code>)")
CELL = re.compile(r"<td.*?</td>", re.S)
UNIT = re.compile(r"(?<=\d) (?=[%°])|(?<=[±✔≈✘□~]) (?=[<\d+−])")
PACKAGE = re.compile(r"api/southwell\.(core|references|cases|reports)\.")
BOLD = re.compile(r'<m[in] mathvariant="bold(?:-italic)?">(.*?)</m[in]>')

RUN = Path(__file__).parents[1] / "reports" / "out"
"""Where `make verify` leaves its results; the site shows them if they are there."""

SOURCE = Path(__file__).parents[1] / "build" / "source" / "southwell"
"""A copy of the package alone, from which mkdocstrings reads the API: the package's own folder holds .venv as well."""

made: dict[str, str] = {}


def on_startup(**_: Any) -> None:
    """Copy the package before mkdocstrings looks for it."""
    shutil.rmtree(SOURCE, ignore_errors=True)
    SOURCE.mkdir(parents=True)
    root = Path(__file__).parents[1]
    for module in ("__init__.py", "adapter.py"):
        shutil.copy(root / module, SOURCE)
    for floor in ("core", "references", "cases", "reports"):
        shutil.copytree(root / floor, SOURCE / floor, ignore=shutil.ignore_patterns("__pycache__", "out"))


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Make the pages, and put them into the nav under the index of their folder."""
    made.clear()
    made.update(pages.pages(RUN))
    last = [{"The last run": pages.REPORT}] if pages.REPORT in made else []
    config.nav = [*(_extended(entry) for entry in config.nav or []), *last]
    return config


def _extended(entry: Any) -> Any:
    """A part of the nav; where it names a made ``folder/index.md``, the folder's other pages follow."""
    if isinstance(entry, dict):
        return {title: _all(part) if isinstance(part, list) else part for title, part in entry.items()}
    return entry


def _all(part: Sequence[Any]) -> list[Any]:
    out: list[Any] = []
    for entry in part:
        out.append(_extended(entry))
        if isinstance(entry, str) and entry in made and entry.endswith("/index.md"):
            folder = entry.removesuffix("index.md")
            out += _grouped(
                [path for path in made if path.startswith(folder) and path.endswith(".md") and path != entry]
            )
    return out


def _grouped(paths: Sequence[str]) -> list[Any]:
    """The pages of a folder; those of packages, as ``api/southwell.core.tree.md``, in a section for each part."""
    out: list[Any] = [path for path in paths if not PACKAGE.match(path)]
    parts = dict.fromkeys(match[1] for path in paths if (match := PACKAGE.match(path)))
    return [*out, *({part: [path for path in paths if path.startswith(f"api/southwell.{part}.")]} for part in parts)]


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """The pages made, beside those written."""
    for path, content in made.items():
        files.append(File.generated(config, path, content=content))
    return files


def on_page_content(html: str, **_: Any) -> str:
    """LaTeX to MathML; file names break after a slash and numbers in tables stay on the line of their unit; no ``::``."""
    html = FORMULA.sub(_mathml, html).replace("::</p>", ":</p>")
    html = INLINE.sub(lambda m: m[0].replace("/", "/<wbr>"), html)
    return CELL.sub(lambda m: UNIT.sub("\N{NO-BREAK SPACE}", m[0]), html)


def _mathml(match: re.Match[str]) -> str:
    """A formula; its number, if it has one, beside it. Bold letters are those of Unicode: browsers know no others."""
    tag, text = match.groups()
    text = unescape(text).strip()
    number = NUMBER.search(text)
    formula = convert(NUMBER.sub("", text), display="block" if tag == "div" else "inline")
    formula = BOLD.sub(lambda m: f'<mi mathvariant="normal">{_bold(unescape(m[1]))}</mi>', formula)
    return f'<div class="equation">{formula}<span>({number[1]})</span></div>' if number else formula


def _bold(letter: str) -> str:
    """M → 𝐌, φ → 𝛗, by their names."""
    words = [word for word in name(letter).split() if word not in ("LATIN", "GREEK", "LETTER")]
    return lookup(f"MATHEMATICAL BOLD {' '.join(words)}")
