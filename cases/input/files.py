"""Text files as saved by editors and spreadsheets: byte order marks, UTF-16, separators other than commas.

Files that are not text are recognised: an empty or binary file, a web page, a pointer in place of the file. Files
referenced by another file are read only from the folder of the file that the user named or, in a deck, from the folders
beside it; see ``reading``.
"""

import codecs
import csv
import os
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from contextvars import ContextVar
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ...core.regular_files import read_bytes
from .errors import CaseError

NOT_THE_FILE = (
    ("version https://git-lfs", "Git's pointer to a large file, not the file: fetch it by `git lfs pull`"),
    ("<!doctype html", "a web page, not the file: download the raw file"),
    ("<html", "a web page, not the file: download the raw file"),
)
"""Beginning of a file that is in place of another → what it is and the remedy."""


@dataclass(frozen=True)
class Allowed:
    """Folders from which files may be read.

    Attributes:
        folders: folders with everything below them.
        trees: folders above that of a deck's main file, of which subfolders may be read but not the files in them.
    """

    folders: tuple[Path, ...]
    trees: tuple[Path, ...] = ()


_allowed: ContextVar[Allowed | None] = ContextVar("allowed", default=None)
"""None: any folder."""

_roots: ContextVar[tuple[Path, ...]] = ContextVar("roots", default=())
"""Folders that the user allows in addition, ``--root``."""

_outside: ContextVar[bool] = ContextVar("outside", default=False)


@contextmanager
def _set(variable: ContextVar[Any], value: object) -> Iterator[None]:
    token = variable.set(value)
    try:
        yield
    finally:
        variable.reset(token)


def outside_allowed(allowed: bool = True) -> AbstractContextManager[None]:
    """Context manager that allows files to reference files in any folder (``--allow-outside``)."""
    return _set(_outside, allowed)


def root_allowed(root: Path) -> AbstractContextManager[None]:
    """Context manager that allows files to reference files below ``root`` (``--root``).

    Raises:
        CaseError: if it is not a folder.
    """
    if not os.path.isdir(root):  # also False for an invalid name
        raise CaseError(f"--root {root}: no such folder: give the folder that holds all files of the deck")
    return _set(_roots, (*_roots.get(), _resolved(root)))


def reading(*paths: Path, deck: bool = False) -> AbstractContextManager[None]:
    """Context manager that restricts reading to the folders of the files that the user named.

    HAWC2 resolves paths from the model's folder: the parent of an htc file's folder, if that is called ``htc``. The files of a
    ``deck`` may also reference files in the folders beside theirs, as ``../5MW_Baseline/Blade.dat``: this is how OpenFAST's
    models share files. Hidden folders are excluded, and so are all of them if the folder above is the user's home folder,
    contains it, or is the root of the file system. A nested ``reading``, for a file that another one references, changes
    nothing.
    """
    if _allowed.get():
        return nullcontext()
    folders = [_resolved(path.parent.parent if _resolved(path.parent).name == "htc" else path.parent) for path in paths]
    parents = {folder.parent for folder in folders if deck and not _resolved(Path.home()).is_relative_to(folder.parent)}
    return _set(_allowed, Allowed((*folders, *map(_resolved, paths)), tuple(parents)))  # a named file may be a link


def reading_also(folder: Path) -> AbstractContextManager[None]:
    """Context manager that also allows ``folder``, which the user named other than by a file."""
    current = _allowed.get() or Allowed(())
    return _set(_allowed, replace(current, folders=(*current.folders, _resolved(folder))))


def _resolved(path: Path) -> Path:
    try:
        return path.resolve()
    except (OSError, ValueError, RuntimeError):  # a loop of links or an invalid name: reported when it is read
        return path.absolute()


def inside(path: Path) -> None:
    """Check that a file lies in an allowed folder, after resolving ``..`` and links.

    Raises:
        CaseError: if it does not; the message names the options that allow it.
    """
    allowed, file = _allowed.get(), _resolved(path)
    if allowed is None or _outside.get():
        return
    within = any(file.is_relative_to(folder) for folder in (*allowed.folders, *_roots.get()))
    if not within and not any(_in_subfolder(file, tree) for tree in allowed.trees):
        raise CaseError(
            f"{path}: outside {allowed.folders[0]}: a file may name files in its folder only, or in the folders of its deck: "
            "move it there, give --root FOLDER for a folder that holds the whole deck, or give --allow-outside if you trust "
            "the file that names it"
        )


def _in_subfolder(file: Path, tree: Path) -> bool:
    """Whether a file is in a folder within ``tree``, none of them hidden, and not directly in ``tree``."""
    if not file.is_relative_to(tree):
        return False
    folders = file.relative_to(tree).parts[:-1]
    return bool(folders) and not any(name.startswith(".") for name in folders)


@contextmanager
def readable(path: Path, remedy: str = "correct the path") -> Iterator[None]:
    """Turn an ``OSError`` of reading ``path`` into the error that names the file and the remedy if it does not exist.

    Raises:
        CaseError: if the file lies outside the allowed folders, or cannot be read.
    """
    inside(path)
    try:
        yield
    except FileNotFoundError:
        raise CaseError(f"{path}: no such file: {remedy}") from None
    except OSError as error:
        raise CaseError(f"{path}: cannot be read ({error.strerror}): give a readable file") from error


def text(path: Path, remedy: str = "correct the path", older: bool = False) -> str:
    """Read a text file: UTF-8, or UTF-16 with a byte order mark.

    Args:
        path: path of the file.
        remedy: in the message if the file does not exist.
        older: whether a file that is not UTF-8 is decoded as Latin-1, in which every byte is a character.

    Raises:
        CaseError: if the file cannot be read, is empty or not text, or lies outside the allowed folders.
    """
    with readable(path, remedy):
        raw = read_bytes(path)
    marked = raw.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)) and not raw.startswith(codecs.BOM_UTF32_LE)
    if b"\0" in raw and not marked:
        raise CaseError(
            f"{path}: not a text file: check that it is the right one; if it is in UTF-16 or UTF-32, save it as UTF-8"
        )
    try:
        content = raw.decode("utf-16" if marked else "utf-8-sig")
    except UnicodeDecodeError as error:
        if not older or marked:
            line = raw.count(b"\n", 0, error.start) + 1
            raise CaseError(
                f"{path}: line {line}: not UTF-8: save it as UTF-8, or check that it is a text file"
            ) from None
        content = raw.decode("latin-1")
    if not content.strip():
        raise CaseError(f"{path}: empty: check that it was written to the end")
    for begins, kind in NOT_THE_FILE:
        if content.lstrip()[: len(begins)].lower() == begins:
            raise CaseError(f"{path}: {kind}")
    return content


def table(path: Path, remedy: str) -> list[tuple[int, list[str]]]:
    """Read the rows of a CSV file with their line numbers.

    ``#`` starts a comment; the header determines the separator: commas, semicolons or tabs.

    Raises:
        CaseError: as ``text``, and if there are only comments.
    """
    lines = [(k, line.partition("#")[0]) for k, line in enumerate(text(path, remedy).splitlines(), 1)]
    lines = [(k, line) for k, line in lines if line.strip()]
    if not lines:
        raise CaseError(f"{path}: contains only comments: give a header and rows")
    header = lines[0][1]
    separator = next((mark for mark in ",;\t" if mark in header), ",")
    return [(k, _cells(f"{path}: line {k}", line, separator)) for k, line in lines]


def _cells(where: str, line: str, separator: str) -> list[str]:
    try:
        return [cell.strip() for cell in next(csv.reader([line], delimiter=separator))]
    except csv.Error as error:  # also a field of more than 131,072 characters
        raise CaseError(f"{where}: not CSV: {error}: correct the line, or give another file") from None
