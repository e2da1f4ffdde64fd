"""What runs when, and where: property tests with the same examples in continuous integration and others every night."""

import os

import pytest
from hypothesis import settings

from southwell.tests.support.guesses import every_steady_state_again
from southwell.tests.support.importable import importable
from southwell.tests.support.keeping import keeping

os.environ.setdefault("SOUTHWELL_FRESH", "1")  # no test takes an answer that an earlier one has stored

settings.register_profile("ci", derandomize=True, deadline=None)
settings.register_profile("nightly", derandomize=False, deadline=None, print_blob=True)
settings.load_profile(os.environ.get("SOUTHWELL_HYPOTHESIS", "ci"))


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Mark the property tests; leave out what is for the night, unless it is asked for."""
    night = "nightly" in str(config.getoption("-m"))
    for item in items:
        if getattr(getattr(item, "obj", None), "is_hypothesis_test", False):
            item.add_marker("random")
    left = [item for item in items if item.get_closest_marker("nightly") and not night]
    if left:
        config.hook.pytest_deselected(items=left)
        items[:] = [item for item in items if item not in set(left)]


__all__ = ["every_steady_state_again", "importable", "keeping"]
