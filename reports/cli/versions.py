"""``--against-version``: other releases of the codes of a run, each in a column next to that of the installed release."""

import re
import sys
from collections.abc import Sequence
from dataclasses import replace

from packaging.utils import canonicalize_name
from packaging.version import VERSION_PATTERN, InvalidVersion, Version

from ...cases.input.errors import nearest
from ...core.blade import Blade
from ...references.isolated import ENVIRONMENTS
from ...references.protocol import overlay
from ...references.protocol.description import Description, describe
from ...references.protocol.overlay import ReleaseError
from ...references.protocol.registry import RELEASE, at_release, release_of
from .errors import UsageError

NEWEST = "newest"

VERSION = re.compile(rf"\s*{VERSION_PATTERN}\s*", re.VERBOSE | re.IGNORECASE)


def pinned(texts: Sequence[str], codes: Sequence[Description]) -> list[tuple[str, str]]:
    """Read ``--against-version NAME==VERSION`` as distribution and release, with ``newest`` replaced.

    A distribution whose newest release is the installed one is left out, with a note on standard error.

    Raises:
        UsageError: if one has another form, no code of the run uses the distribution, it is the installed release, or
            the newest is not known.
    """
    return [pin for pin in dict.fromkeys(_pinned(text, codes) for text in texts) if pin]


def _pinned(text: str, codes: Sequence[Description]) -> tuple[str, str] | None:
    name, equals, release = text.partition("==")
    if not (name and equals and release):
        raise UsageError(
            f"--against-version {text}: give a package and a release, as in exudyn==1.13.6 or exudyn==newest"
        )
    mine = _using(name, text, codes)
    distribution, here = mine[0].distribution, mine[0].version
    if release == NEWEST:
        try:
            release = overlay.releases(distribution)[-1]
        except (ReleaseError, IndexError) as error:
            raise UsageError(f"--against-version {text}: its newest release is not known: {error}") from error
        if overlay.same(here, release):
            print(f"southwell: --against-version {text}: {here} is installed and the newest", file=sys.stderr)
            return None
    try:
        release = str(Version(release))
    except InvalidVersion:
        raise UsageError(
            f"--against-version {text}: {release!r} is no version: give one, as in 1.13.6, or newest"
        ) from None
    if overlay.same(here, release):
        raise UsageError(f"--against-version {text}: this release is the installed one: give another")
    if here is not None and not VERSION.fullmatch(here):
        raise UsageError(f"--against-version {text}: {mine[0].name} reports version {here!r}, which cannot be ordered")
    return distribution, release


def _using(name: str, text: str, codes: Sequence[Description]) -> list[Description]:
    """The codes of the run that use a distribution."""
    there = {canonicalize_name(code.distribution) for code in codes if code.distribution}
    if mine := [code for code in codes if _uses(code, name)]:
        return mine
    for code, environment in ENVIRONMENTS.items():
        if canonicalize_name(name) in (code, environment.bare[0].partition("==")[0]):
            why = "runs in an environment of its own, whose files are pinned by hashes"
            raise UsageError(f"--against-version {text}: {code} {why}: other releases of it cannot be compared")
    if by_code := next((c.distribution for c in codes if c.name == name and c.distribution), ""):
        raise UsageError(f"--against-version {text}: {name} is a code: give its package, {by_code}==VERSION")
    advice = nearest(name, sorted(there)) if there else "none of them declares its package"
    raise UsageError(f"--against-version {text}: no code of this run uses the package {name!r}: {advice}")


def _uses(code: Description, name: str) -> bool:
    return bool(code.distribution) and canonicalize_name(code.distribution) == canonicalize_name(name)


def described(
    pins: Sequence[tuple[str, str]], codes: Sequence[Description], blades: Sequence[Blade]
) -> tuple[Description, ...]:
    """Install the releases and describe every code of the run that uses one.

    Raises:
        UsageError: if a release cannot be installed, or a code reports another version than that release.
    """
    using: dict[str, Description] = {}
    for distribution, release in pins:
        try:
            overlay.install(distribution, release)
        except ReleaseError as error:
            advice = f"is there a wheel for this Python? `pip index versions {distribution}` lists the releases"
            raise UsageError(f"--against-version {error}: {advice}") from error
        using |= {at_release(c.asked, distribution, release): c for c in codes if _uses(c, distribution)}
    found = []
    for one in describe(list(using), blades):
        release = release_of(one.asked)
        found.append(replace(one, name=f"{using[one.asked].name}{RELEASE}{release}"))  # even if it cannot be imported
        if not (one.failure or overlay.same(one.version, release)):
            raise UsageError(
                f"--against-version {one.asked.partition(RELEASE)[2]}: {found[-1].name} reports version {one.version}: "
                "version() of the adapter must be that of its `distribution`"
            )
    return tuple(found)
