"""How the command line starts: fast, with one line per command, and an announcement of what takes long."""

import subprocess
import sys
from pathlib import Path

import pytest

from southwell.reports.cli import app as cli

HEAVY = ("numpy", "scipy", "matplotlib", "pandas")


def python(code: str, folder: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=folder, timeout=120)


@pytest.mark.parametrize("arguments", [[], ["--help"], ["-h"], ["--version"]])
def test_the_list_of_commands_loads_no_numerical_library(arguments: list[str], tmp_path: Path) -> None:
    code = f"""
import sys
from southwell.reports.cli.app import main
try:
    main({arguments!r})
except SystemExit:
    print("loaded:", [m for m in {HEAVY!r} if m in sys.modules])
"""
    assert python(code, tmp_path).stdout.splitlines()[-1] == "loaded: []"


@pytest.mark.slow
def test_importing_the_package_loads_no_numerical_library_and_every_name_is_there(tmp_path: Path) -> None:
    code = f"""
import sys, southwell
print([m for m in {HEAVY!r} if m in sys.modules])
print([n for n in southwell.__all__ if getattr(southwell, n, None) is None])
print(set(southwell.__all__) <= set(dir(southwell)), hasattr(southwell, "nonsense"))
"""
    assert python(code, tmp_path).stdout.split("\n") == ["[]", "[]", "True False", ""]


@pytest.mark.parametrize(
    ("name", "line"), [(name, line) for commands in cli.COMMANDS.values() for name, _, line in commands]
)
def test_a_commands_line_in_the_list_is_the_first_of_its_own_help(name: str, line: str) -> None:
    command = cli.app[name]
    text = command.help or (command.default_command.__doc__ or "")
    assert text.strip().splitlines()[0] == line


def test_every_command_is_listed_in_eighty_columns(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as exit_info:
        cli.main(["--help"])
    out = capsys.readouterr().out
    assert exit_info.value.code == 0
    assert max(map(len, out.splitlines())) <= 80
    assert all(f"│ {name} " in out for commands in cli.COMMANDS.values() for name, *_ in commands)


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_commands_and_options_are_completed(shell: str) -> None:
    script = cli.app.generate_completion(shell=shell)  # type: ignore[arg-type]
    for word in ("campbell", "operating", "witnesses"):
        assert word in script


def test_install_hints_keep_their_brackets(capsys: pytest.CaptureFixture[str]) -> None:
    """Square brackets are markup to rich; a hint without them installs something else."""
    with pytest.raises(SystemExit):
        cli.main(["codes"])
    out = " ".join(capsys.readouterr().out.split())
    assert "✔" in out
    hints = out.count("pip install '.[")
    assert hints == out.count("pip install")
