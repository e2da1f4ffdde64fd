"""Reading of a PDF: its words, its links, and what of a report's Markdown is not in it. Skips without Typst or pypdf."""

from io import BytesIO
from pathlib import Path
from typing import Any

import pytest

from southwell.reports.documents import document, pdf

pytest.importorskip("typst")
pypdf = pytest.importorskip("pypdf")


def read(path: Path) -> Any:
    return pypdf.PdfReader(path)


def rendered(text: str, folder: Path) -> Any:
    return pypdf.PdfReader(BytesIO(pdf.render(text, folder)))


def words(reader: Any) -> str:
    """Text of all pages without spaces and page numbers."""
    pages = [page.extract_text() for page in reader.pages]
    return "".join(
        "".join(text.split()).replace(f"{k}/{len(pages)}", "").replace("\u200b", "") for k, text in enumerate(pages, 1)
    )


def missing(text: str, reader: Any) -> list[str]:
    """Headings, paragraphs and table cells of the Markdown whose text is not in the PDF."""
    elsewhere = words(reader)
    inlines = [token for token in document.parse(text).tokens if token.type == "inline"]
    message = [document.words(t) for t in inlines if not any(child.type == "image" for child in t.children or ())]
    assert message
    return [text for text in message if "".join(text.split()) not in elsewhere]


def annotations(reader: Any) -> list[Any]:
    return [a.get_object() for page in reader.pages for a in page.get("/Annots", [])]
