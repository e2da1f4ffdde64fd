"""Text files as saved by editors and spreadsheets: byte order marks, UTF-16, separators other than commas.

Files that are not text are recognised: an empty or binary file, a web page, a pointer in place of the file. Files
referenced by another file are read only from the folder of the file that the user named, see ``reading``.
"""

import codecs
import csv
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path

from ...core.regular_files import read_bytes
from .errors import CaseError

NOT_THE_FILE = (
    ("version https://git-lfs", "Git's pointer to a large file, not the file: fetch it by `git lfs pull`"),
    ("<!doctype html", "a web page, not the file: download the raw file"),
    ("<html", "a web page, not the file: download the raw file"),
)
"""Beginning of a file that is in place of another → what it is and the remedy."""

_folders: ContextVar[tuple[Path, ...]] = ContextVar("folders", default=())
"""Folders from which files may be read; empty: any."""

_outside: ContextVar[bool] = ContextVar("outside", default=False)


@contextmanager
def outside_allowed(allowed: bool = True) -> Iterator[None]:
    """Context manager that allows files to reference files in any folder (``--allow-outside``)."""
    token = _outside.set(allowed)
    try:
        yield
    finally:
        _outside.reset(token)


@contextmanager
def reading(*named: Path) -> Iterator[None]:
    """Context manager that restricts reading to the folders of the files that the user named.

    HAWC2 resolves paths from the model's folder: the parent of an htc file's folder, if that is called ``htc``. A nested
    ``reading``, for a file that another one references, changes nothing.
    """
    folders = [path.parent.parent if _resolved(path.parent).name == "htc" else path.parent for path in named]
    with _only(_folders.get() or tuple(map(_resolved, (*folders, *named)))):  # a named file may be a link to any folder
        yield


@contextmanager
def reading_also(folder: Path) -> Iterator[None]:
    """Context manager that also allows ``folder``, which the user named other than by a file."""
    with _only((*_folders.get(), _resolved(folder))):
        yield


@contextmanager
def _only(folders: tuple[Path, ...]) -> Iterator[None]:
    token = _folders.set(folders)
    try:
        yield
    finally:
        _folders.reset(token)


def _resolved(path: Path) -> Path:
    try:
        return path.resolve()
    except (OSError, ValueError, RuntimeError):  # a loop of links or an invalid name: reported when it is read
        return path.absolute()


def inside(path: Path) -> None:
    """Check that a file lies in an allowed folder, after resolving ``..`` and links.

    Raises:
        CaseError: if it does not; the message names the option that allows it.
    """
    folders = _folders.get()
    if folders and not _outside.get() and not any(_resolved(path).is_relative_to(folder) for folder in folders):
        raise CaseError(
            f"{path}: outside {folders[0]}: files that a file names are read from its folder only: "
            "move it there, or give --allow-outside if you trust the file that names it"
        )


def text(path: Path, absent: str = "correct the path", older: bool = False) -> str:
    """Read a text file: UTF-8, or UTF-16 with a byte order mark.

    Args:
        path: path of the file.
        absent: remedy in the message if the file does not exist.
        older: whether a file that is not UTF-8 is decoded as Latin-1, in which every byte is a character.

    Raises:
        CaseError: if the file cannot be read, is empty or not text, or lies outside the allowed folders.
    """
    inside(path)
    try:
        raw = read_bytes(path)
    except FileNotFoundError:
        raise CaseError(f"{path}: no such file: {absent}") from None
    except OSError as error:
        raise CaseError(f"{path}: cannot be read ({error.strerror}): give a file that can") from error
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
    for begins, what in NOT_THE_FILE:
        if found.lstrip()[: len(begins)].lower() == begins:
            raise CaseError(f"{path}: {what}")
    return found


def table(path: Path, absent: str) -> list[tuple[int, list[str]]]:
    """Read the rows of a CSV file with their line numbers.

    ``#`` starts a comment; the header determines the separator: commas, semicolons or tabs.

    Raises:
        CaseError: as ``text``, and if there are only comments.
    """
    lines = [(k, line.partition("#")[0]) for k, line in enumerate(text(path, absent).splitlines(), 1)]
    lines = [(k, line) for k, line in lines if line.strip()]
    if not lines:
        raise CaseError(f"{path}: only comments: give a header and rows")
    header = lines[0][1]
    separator = next((mark for mark in ",;\t" if mark in header), ",")
    return [(k, _cells(f"{path}: line {k}", line, separator)) for k, line in lines]


def _cells(where: str, line: str, separator: str) -> list[str]:
    try:
        return [cell.strip() for cell in next(csv.reader([line], delimiter=separator))]
    except csv.Error as error:  # also a field of more than 131,072 characters
        raise CaseError(f"{where}: not CSV: {error}: is it the right file? correct the line") from None
