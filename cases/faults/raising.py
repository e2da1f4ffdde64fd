"""Adapters of the exact beam that raise instead of answering."""

from ...core.blade import Blade
from ...references.theories.exact_beam import ExactBeam


class _Version(ExactBeam):
    def version(self) -> str | None:
        raise RuntimeError("no such binary")


class _Unsupported(ExactBeam):
    def unsupported(self, blade: Blade) -> str | None:
        raise RuntimeError("licence server not reached")


VERSION, UNSUPPORTED = _Version(), _Unsupported()
