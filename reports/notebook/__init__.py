"""The Python interface for notebooks: a blade from a file, its modes, its Campbell diagram, and what other codes find.

A blade comes in; results come out that show themselves as tables, and give pandas tables and matplotlib axes.
"""

from .api import campbell, modes, read, verify
from .results import CampbellResult, ModesResult, VerifyResult

__all__ = ["CampbellResult", "ModesResult", "VerifyResult", "campbell", "modes", "read", "verify"]
