"""One error for every file or folder that a command cannot write."""

from collections.abc import Iterator
from contextlib import contextmanager

from .errors import CaseError


@contextmanager
def writable(target: str, kind: str = "folder") -> Iterator[None]:
    """Turn an ``OSError`` into the error that names the option and its value, such as ``--out DIR``.

    Raises:
        CaseError: if ``target`` cannot be written; ``kind``: what to give instead.
    """
    try:
        yield
    except OSError as error:
        raise CaseError(f"{target}: cannot be written ({error.strerror}): give another {kind}") from error
