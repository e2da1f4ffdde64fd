"""How much the property tests vary: the same examples in continuous integration, others every night."""

import os

import pytest
from hypothesis import settings

from southwell.tests.support.guesses import every_steady_state_again

settings.register_profile("ci", derandomize=True, deadline=None)
settings.register_profile("nightly", derandomize=False, deadline=None, print_blob=True)
settings.load_profile(os.environ.get("SOUTHWELL_HYPOTHESIS", "ci"))


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Mark the property tests; leave out what is for the night, unless it is asked for."""
    for item in items:
        if getattr(getattr(item, "obj", None), "is_hypothesis_test", False):
            item.add_marker("random")
        if item.get_closest_marker("nightly") and "nightly" not in str(config.getoption("-m")):
            item.add_marker(pytest.mark.skip(reason="for the night: pytest -m nightly"))


__all__ = ["every_steady_state_again"]
