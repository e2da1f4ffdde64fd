"""How much the property tests vary: the same examples in continuous integration, others every night."""

import os

from hypothesis import settings

from southwell.tests.support.guesses import every_steady_state_again

settings.register_profile("ci", derandomize=True, deadline=None)
settings.register_profile("nightly", derandomize=False, deadline=None, print_blob=True)
settings.load_profile(os.environ.get("SOUTHWELL_HYPOTHESIS", "ci"))

__all__ = ["every_steady_state_again"]
