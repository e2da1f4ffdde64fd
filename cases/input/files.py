"""Text files as editors and spreadsheets save them: marks of byte order, UTF-16, other separators than a comma.

What is not a text file after all is told from one: an empty file, a binary one, a web page, a pointer in a file's stead.
"""

import codecs
import csv
from pathlib import Path

from .errors import CaseError

ELSEWHERE = (
    ("version https://git-lfs", "Git's pointer to a large file, not the file: fetch it by `git lfs pull`"),
    ("<!doctype html", "a web page, not the file: download the raw file"),
    ("<html", "a web page, not the file: download the raw file"),
)
"""How a file begins that stands where another should: what it is and what to do."""


def text(path: Path, absent: str = "correct the path", older: bool = False) -> str:
    """A file's text: UTF-8, or UTF-16 with its mark.

    Args:
        path: of the file.
        absent: what to do where there is none.
        older: whether bytes that are not UTF-8 are Latin-1, in which every byte is a character.

    Raises:
        CaseError: if it cannot be read, is empty, or no text.
    """
    try:
        raw = path.read_bytes()
    except FileNotFoundError:
        raise CaseError(f"{path}: no such file: {absent}") from None
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise CaseError(f"{path}: cannot be read ({reason}): give a file that can") from error
    marked = raw.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)) and not raw.startswith(codecs.BOM_UTF32_LE)
    if b"\0" in raw and not marked:
        raise CaseError(f"{path}: not a text file: is it the right one? if it is in UTF-16 or UTF-32, save it as UTF-8")
    try:
        found = raw.decode("utf-16" if marked else "utf-8-sig")
    except UnicodeDecodeError as error:
        if not older or marked:
            line = raw.count(b"\n", 0, error.start) + 1
            raise CaseError(f"{path}: line {line}: not UTF-8: another encoding, or no text? save it as UTF-8") from None
        found = raw.decode("latin-1")
    if not found.strip():
        raise CaseError(f"{path}: empty: was it written to the end?")
    for begins, told in ELSEWHERE:
        if found.lstrip()[: len(begins)].lower() == begins:
            raise CaseError(f"{path}: {told}")
    return found


def table(path: Path, absent: str) -> list[tuple[int, list[str]]]:
    """The rows of a CSV file and the lines they are on: ``#`` starts a comment; the header says whether commas, semicolons or
    tabs separate.

    Raises:
        CaseError: as ``text``; and if there are only comments.
    """
    lines = [(k, line.partition("#")[0]) for k, line in enumerate(text(path, absent).splitlines(), 1)]
    lines = [(k, line) for k, line in lines if line.strip()]
    if not lines:
        raise CaseError(f"{path}: only comments: give a header and rows")
    header = lines[0][1]
    separator = next((mark for mark in ",;\t" if mark in header), ",")
    return [(k, [cell.strip() for cell in next(csv.reader([line], delimiter=separator))]) for k, line in lines]
