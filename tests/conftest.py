"""What runs when, and where: property tests with the same examples in continuous integration and others every night."""

import os
from collections import Counter
from collections.abc import Iterator

import pytest
from hypothesis import settings

from southwell.references.protocol import launch
from southwell.tests.support.guesses import every_steady_state_again
from southwell.tests.support.importable import importable

os.environ.setdefault("SOUTHWELL_FRESH", "1")  # no test takes an answer that an earlier one has stored

settings.register_profile("ci", derandomize=True, deadline=None)
settings.register_profile("nightly", derandomize=False, deadline=None, print_blob=True)
settings.load_profile(os.environ.get("SOUTHWELL_HYPOTHESIS", "ci"))


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Mark the property tests; leave out what is for the night, unless it is asked for; begin with files of slow tests.

    A long file that is begun last would leave the other processor idle.
    """
    night = "nightly" in str(config.getoption("-m"))
    for item in items:
        if getattr(getattr(item, "obj", None), "is_hypothesis_test", False):
            item.add_marker("random")
    remainder = [item for item in items if item.get_closest_marker("nightly") and not night]
    if remainder:
        config.hook.pytest_deselected(items=remainder)
        items[:] = [item for item in items if item not in set(remainder)]
    slow = Counter(item.path for item in items if item.get_closest_marker("slow"))
    items.sort(key=lambda item: -slow[item.path])


@pytest.fixture(scope="session", autouse=True)
def launching() -> Iterator[None]:
    """Keep the process that forks those of codes from one test to the next: starting one takes a second.

    pytest puts the name of each test into the environment, which for the package is another environment.
    """
    environment_and_folder = launch._surroundings

    def without_the_test() -> tuple[dict[str, str], str]:
        environment, folder = environment_and_folder()
        environment.pop("PYTEST_CURRENT_TEST", None)
        return environment, folder

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(launch, "_surroundings", without_the_test)
        yield


__all__ = ["every_steady_state_again", "importable"]
