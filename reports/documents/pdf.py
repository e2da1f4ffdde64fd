"""A report as a PDF, laid out by Typst."""

import json
from importlib.resources import files
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import cast

from matplotlib import get_data_path
from matplotlib.ft2font import FT2Font

from ...cases.input import atomic
from ...cases.input.errors import CaseError
from ...references.protocol.interface import extra
from . import colours, document, print_nodes

FONTS = Path(get_data_path(), "fonts", "ttf")
"""The fonts that Matplotlib brings along."""


class PdfError(CaseError):
    """No PDF can be made; the message has the reason and the remedy."""


def require() -> None:
    """Check that Typst is installed, before minutes of work.

    Raises:
        PdfError: if it cannot be imported.
    """
    try:
        import typst  # noqa: F401
    except ImportError as error:
        raise PdfError(
            f"--pdf: Typst cannot be used ({error}): {extra('pdf')}; or give --html and print that page from a browser"
        ) from error


def write(report: Path) -> Path:
    """Write ``report.pdf`` next to ``report.md`` with all sections open; return its path.

    Raises:
        PdfError: if Typst is missing, or cannot read a figure.
        OSError: if a figure cannot be read or the file cannot be written.
    """
    path = report.with_suffix(".pdf")
    atomic.write(path, render(report.read_text(encoding="utf-8"), report.parent))
    return path


def render(text: str, folder: Path) -> bytes:
    """Render the Markdown of a report as a PDF; figures are read from ``folder``.

    The same report gives the same bytes. The fonts are those of Matplotlib; the system's are used for characters that
    DejaVu lacks. Typst receives the report as data, and an empty folder as the only one that it may read.

    Raises:
        PdfError: as for ``write``.
        OSError: if a figure cannot be read.
    """
    require()
    import typst

    read = document.parse(text)
    data = {
        "title": read.title,
        "nodes": print_nodes.nodes(read, folder),
        "width": print_nodes.WIDTH,
        "padding": print_nodes.PADDING,
        "size": print_nodes.SIZE,
        "colours": {
            "ink": colours.INK,
            "faint": colours.FAINT,
            "grey": colours.GREY,
            "head": colours.HEAD,
            "background": colours.BACKGROUND,
            "muted": colours.MUTED,
        },
    }
    encoded = json.dumps(data, ensure_ascii=False)
    fonts = typst.Fonts(not covered(encoded), False, [str(FONTS)])
    layout = files(__package__ or "").joinpath("print.typ").read_bytes()
    with TemporaryDirectory() as empty:
        try:
            compiler = typst.Compiler(layout, empty, fonts, sys_inputs={"report": encoded})
            return cast(bytes, compiler.compile(format="pdf"))
        except typst.TypstError as error:
            raise PdfError(
                f"--pdf: the report in {folder}: Typst: {error.message}; give --html and print that page from a browser"
            ) from error


def covered(text: str) -> bool:
    """Whether DejaVu Sans has a glyph for every character of ``text``."""
    glyphs = FT2Font(str(FONTS / "DejaVuSans.ttf")).get_charmap()
    return {ord(sign) for sign in set(text) if sign.isprintable()} <= set(glyphs)
