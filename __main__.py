"""``python -m southwell`` is the command line."""

from .reports.cli.app import main

main()
