"""The software that an answer depends on, so that workers with other versions are refused instead of mixed in."""

from dataclasses import dataclass
from functools import lru_cache
from importlib.metadata import PackageNotFoundError, version

from ...references.protocol import sources
from ...references.protocol.registry import UnknownCodeError


@dataclass(frozen=True)
class Software:
    """What a task needs besides this package and its libraries.

    Attributes:
        packages: distributions of foreign codes.
        codes: codes by name or import path.
    """

    packages: tuple[str, ...] = ()
    codes: tuple[str, ...] = ()


@lru_cache
def installed(software: Software) -> tuple[tuple[str, str], ...]:
    """Names and versions (or digests) in this process, in the order of ``software``; empty if not installed."""
    own_package = ("Southwell or its libraries", sources.package()[:12])
    packages = ((name, _version(name)) for name in software.packages)
    codes = ((f"the source of {name}", _source(name)) for name in software.codes)
    return (own_package, *packages, *codes)


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return ""


def _source(code: str) -> str:
    try:
        return sources.adapter(code)[:12]
    except UnknownCodeError:
        return ""
