"""Answers of codes that are taken from the store instead of being computed again.

The process of a code is a pure function of the request it reads. The key of an answer is the digest of a request with this
question alone (the blade, speed, refinement and number of modes, or the mechanism, and where the code is found), of the code's
version, of the source of its adapter and all that this imports from this package, and of the platform. Answers of codes that
are not part of this package, or of unknown version, are not stored, and failures are not.
"""

import json
from collections.abc import Callable
from hashlib import sha256

import numpy as np
from numpy.typing import NDArray

from . import sources, store
from .process import Limits

Array = NDArray[np.float64]


def key(module: str, request: bytes, code: str, version: str) -> str:
    """Key of the answer to a request with one question.

    Args:
        module: the module that reads the request in a separate process.
        request: as sent.
        code: name or import path of the code.
        version: its version.
    """
    parts = (module, request.decode(), code, version, sources.adapter(code), *store.machine())
    return sha256(json.dumps(parts).encode()).hexdigest()


def reusable(code: str, version: str, limits: Limits) -> store.Store | None:
    """The store, if answers of this code may be taken from it."""
    return store.opened() if limits.reuse and version and sources.bundled(code) else None


def get(opened: store.Store, key: str) -> object:
    """A stored answer as plain data; None if there is none."""
    try:
        return json.loads(opened.get(key)[0])
    except (KeyError, ValueError):
        return None


def put(opened: store.Store, key: str, code: str, line: bytes) -> None:
    """Store an answer of a code as its process wrote it."""
    opened.put(key, f"{code}, answers", line)


def array(label: str, module: str, question: tuple[object, ...], make: Callable[[], Array]) -> Array:
    """An array that codes need for many answers: taken from the store if it is there, made and stored otherwise.

    Args:
        label: for the list of the store's contents.
        module: the module that makes it; all that it depends on is part of the key.
        question: what the array is made of, with the version of any other package that makes it; plain data or frozen
            dataclasses of it, which ``repr`` identifies.
        make: makes the array.
    """
    kept = store.opened()
    if kept is None:
        return make()
    parts = (label, sources.digest(frozenset({module})), repr(question), *store.machine())
    name = sha256(json.dumps(parts).encode()).hexdigest()
    if (known := get(kept, name)) is not None:
        return np.array(known)
    made = make()
    kept.put(name, label, json.dumps(made.tolist()).encode())
    return made
