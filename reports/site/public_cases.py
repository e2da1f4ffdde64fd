"""Run the commands on the page of public cases and write what they print.

``python -m southwell.reports.site.public_cases FOLDER`` rewrites the page. A block after ``<!-- run in NAME: PATTERN -->``
has commands, after ``$``, each followed by those lines of its output that match the pattern. The commands run in a copy of
the folder NAME of FOLDER.
"""

import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "public-cases.md"
EXAMPLES = "examples"
"""A folder of the checkout, which every command can reach as ``../examples``."""

BLOCK = re.compile(r"<!-- run in (?P<folder>\S+): (?P<pattern>.+?) -->\n```text\n(?P<lines>.*?)```\n", re.S)


def refreshed(page: str, public: Path) -> str:
    """The text of the page with the output of this version.

    Raises:
        OSError: if a folder that the page names is not in ``public``.
    """
    with TemporaryDirectory() as temporary:
        shutil.copytree(ROOT / EXAMPLES, Path(temporary) / EXAMPLES)

        def run(block: re.Match[str]) -> str:
            folder = Path(temporary) / block["folder"]
            if not folder.exists():
                shutil.copytree(public / block["folder"], folder)
            parts = [f"$ {c}\n{output(c, folder, block['pattern'])}" for c in commands(block["lines"])]
            return f"<!-- run in {block['folder']}: {block['pattern']} -->\n```text\n{''.join(parts)}```\n"

        return BLOCK.sub(run, page)


def commands(lines: str) -> list[str]:
    """The commands of a block, without their output."""
    return [line[2:] for line in lines.splitlines() if line.startswith("$ ")]


def output(command: str, folder: Path, pattern: str) -> str:
    """The lines that a command prints in a folder and that match the pattern."""
    python = shlex.quote(sys.executable)
    run = f'southwell() {{ {python} -m southwell "$@"; }}; python() {{ {python} "$@"; }}'
    process = subprocess.run(
        ["bash", "-c", f"{run}\n{command}"],
        cwd=folder,
        env=os.environ | {"COLUMNS": "110", "NO_COLOR": "1"},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )
    lines = [line.strip() for line in process.stdout.splitlines()]
    return "".join(f"{line}\n" for line in lines if re.search(pattern, line))


if __name__ == "__main__":
    PAGE.write_text(refreshed(PAGE.read_text(encoding="utf-8"), Path(sys.argv[1])), encoding="utf-8")
