"""Print the pinned requirements of some extras, one per line: python .ci/pins.py codes more-codes."""

import sys
import tomllib
from pathlib import Path

PROJECT = tomllib.loads((Path(__file__).parents[1] / "pyproject.toml").read_text(encoding="utf-8"))["project"]

if __name__ == "__main__":
    print(*(pin for extra in sys.argv[1:] for pin in PROJECT["optional-dependencies"][extra]), sep="\n")
