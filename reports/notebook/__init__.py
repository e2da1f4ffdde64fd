"""The Python interface for notebooks: blades from files, their modes, Campbell diagrams, and results of other codes.

Takes a blade; returns results with a table view, pandas tables and matplotlib axes.
"""

from .api import campbell, modes, read, root_loads, verify
from .results import CampbellResult, ModesResult, VerifyResult

__all__ = ["CampbellResult", "ModesResult", "VerifyResult", "campbell", "modes", "read", "root_loads", "verify"]
