"""``python -m southwell`` is the command line."""

from .reports.cli import main

main()
