"""What CI runs: every step's script is sound shell, its ``southwell`` lines parse, and it does here what it is to do there."""

import os
import re
import shlex
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml

from southwell.cases.regression import history
from southwell.cases.store import results_file
from southwell.references.protocol import store
from southwell.reports.cli import app as cli
from southwell.reports.shared import statuses

ROOT = Path(__file__).parents[3]
ACTION = ROOT / "action.yml"
WORKFLOWS = sorted((ROOT / ".github" / "workflows").glob("*.yml"))
GITLAB = ROOT / "docs" / "gitlab-ci.yml"
BASH = shutil.which("bash")
SCRIPTS = [ROOT / ".ci" / name for name in ("every-code", "fuzz", "nightly", "run", "system-packages", "versions")]


def load(path: Path) -> dict[Any, Any]:
    return yaml.safe_load(path.read_text(encoding="utf-8"))


def steps(path: Path) -> Iterator[dict[str, Any]]:
    loaded = load(path)
    for job in [loaded["runs"]] if "runs" in loaded else loaded["jobs"].values():
        yield from job.get("steps", ())  # none if it calls another workflow


def scripts() -> dict[str, str]:
    """Every script, by file and step."""
    every = {p.name: p.read_text(encoding="utf-8") for p in SCRIPTS}
    for path in (ACTION, *WORKFLOWS):
        for step in steps(path):
            if "run" in step:
                every[f"{path.name}: {step.get('name')}"] = step["run"]
    job = load(GITLAB)["southwell"]
    return every | {GITLAB.name: "\n".join([*job["before_script"], *job["script"]])}


@pytest.mark.skipif(BASH is None, reason="no bash")
@pytest.mark.parametrize("script", scripts().values(), ids=scripts())
def test_every_shell_line_parses(script: str) -> None:
    checked = subprocess.run(["bash", "-n"], input=script, capture_output=True, text=True)
    assert (checked.returncode, checked.stderr) == (0, "")


def lines() -> dict[str, str]:
    """Every line that calls southwell, with the options that its script may add to it."""
    by_step = {}
    for name, script in scripts().items():
        more = " ".join(re.findall(r"options\+?=\((.*?)\)", script))
        for k, line in enumerate(
            re.findall(r"(?<![\w./-])southwell (?!\()([a-z].*?)(?: \|\|.*)?$", script, re.MULTILINE)
        ):
            by_step[f"{name}: {k}: {line}"] = line.replace('"${options[@]}"', more)
    return by_step


def test_workflows_contain_shell_lines() -> None:
    commands = {line.split()[0] for line in lines().values()}
    assert {"verify", "gate", "history", "codes", "dashboard"} <= commands


@pytest.mark.parametrize("line", lines().values(), ids=lines())
def test_commands_in_workflows_are_accepted(line: str) -> None:
    words = re.sub(r'"?\$\{\w+\[@\]\}"?|\$(against|CASES)|"\$@"', "", line)
    tokens = shlex.split(re.sub(r"\$\w+", "something", words))
    command, *_ = cli.app.parse_args(tokens, exit_on_error=False, print_error=False)
    assert command.__module__.startswith("southwell.reports.")


def test_no_script_contains_an_expression_of_the_workflow() -> None:
    """What others wrote reaches a script by its environment alone: pasted in by ``${{ }}`` it would be run."""
    assert not [name for name, script in scripts().items() if "${{" in script]


def test_every_action_is_pinned_by_commit() -> None:
    used = [s["uses"] for path in (ACTION, *WORKFLOWS) for s in steps(path) if "uses" in s]
    foreign = [name for name in used if name != "./"]
    assert len(foreign) > 10
    assert all(re.fullmatch(r"[\w-]+(/[\w-]+)+@[0-9a-f]{40}", name) for name in foreign)


def test_the_lowest_versions_are_those_declared() -> None:
    declared = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["dependencies"]
    lines = (ROOT / ".ci" / "lowest.txt").read_text().splitlines()
    lowest = dict(line.split("==") for line in lines if not line.startswith("#"))
    for requirement in declared:
        name, least = requirement.split(">=")
        assert re.sub(r"(\.0)+$", "", lowest.pop(name)) == re.sub(r"(\.0)+$", "", least)
    assert not lowest


def test_the_workflow_uses_the_action_with_inputs_that_it_has() -> None:
    used = [s["with"] for path in WORKFLOWS for s in steps(path) if s.get("uses") == "./"]
    assert used
    assert all(set(w) <= set(load(ACTION)["inputs"]) for w in used)


def test_the_action_keeps_the_store_of_answers_where_southwell_writes_it(monkeypatch: pytest.MonkeyPatch) -> None:
    for variable in ("SOUTHWELL_CACHE", "XDG_CACHE_HOME"):
        monkeypatch.delenv(variable, raising=False)
    kept = [
        s["with"]
        for s in steps(ACTION)
        if s.get("uses", "").startswith(("actions/cache/restore", "actions/cache/save"))
    ]
    assert {Path(step["path"]).expanduser() for step in kept} == {store.path()}
    restored, saved = kept
    assert restored["key"] == saved["key"]
    assert saved["key"].startswith(restored["restore-keys"])


def action(tmp_path: Path, **inputs: str) -> tuple[int, str]:
    """Run the action's scripts that call southwell, as they stand, in their order; status, and what they printed."""
    given = {name: entry["default"] for name, entry in load(ACTION)["inputs"].items()} | inputs
    output = ""
    for step in steps(ACTION):
        if "southwell" in step.get("run", ""):
            variables = {
                k: re.sub(r"\$\{\{ inputs\.(\S+) \}\}", lambda m: given[m[1]], v) for k, v in step["env"].items()
            }
            here = {**os.environ, "GITHUB_STEP_SUMMARY": str(tmp_path / "summary.md"), **variables}
            here["PATH"] = os.pathsep.join([str(Path(sys.executable).parent), here["PATH"]])
            command = ["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", step["run"]]
            process = subprocess.run(command, cwd=tmp_path, env=here, capture_output=True, text=True)
            output += process.stdout + process.stderr
            if process.returncode:
                return process.returncode, output
    return 0, output


CASE = (ROOT / "cases" / "data" / "rotating-cable.toml").read_text(encoding="utf-8")
FEW = {"cases": "mine.toml", "codes": "southwell-equation,scikit-fem", "out": "out"}


@pytest.mark.nightly
@pytest.mark.skipif(BASH is None, reason="no bash")
def test_the_action_passes_then_fails_on_what_got_worse(tmp_path: Path) -> None:
    case = tmp_path / "mine.toml"
    case.write_text(CASE, encoding="utf-8")
    status, output = action(tmp_path, **FEW)
    assert (status, "against no baseline" in output) == (0, True), output
    assert "### Southwell" in (tmp_path / "summary.md").read_text(encoding="utf-8")
    assert (tmp_path / "out" / "junit.xml").exists()

    run = results_file.read(tmp_path / "out" / "results.jsonl")
    history.append(tmp_path / "history.jsonl", history.entry(run, "first"))
    assert action(tmp_path, **FEW, strict="true")[0] == 0  # nothing moves by itself

    case.write_text(re.sub(r"\[compare\]", "[compare]\ntarget = 1e-12", CASE), encoding="utf-8")
    status, output = action(tmp_path, **FEW)
    assert status == 1
    assert "::error file=mine.toml,title=rotating-cable::" in output
    assert "against first" in output


def git(folder: Path, *arguments: str) -> str:
    process = subprocess.run(["git", *arguments], cwd=folder, check=True, capture_output=True, text=True)
    return process.stdout


@pytest.mark.slow
@pytest.mark.skipif(BASH is None or shutil.which("git") is None, reason="no bash, or no git")
@pytest.mark.parametrize(
    ("codes", "conform", "checked"),
    [
        ("exudyn-tree,my_code:CODE,other.mod:SOLVER", "true", ["conform my_code:CODE", "conform other.mod:SOLVER"]),
        ("exudyn-tree", "true", []),
        ("my_code:CODE", "false", []),
    ],
)
def test_the_action_checks_the_conformance_of_own_codes(
    tmp_path: Path, codes: str, conform: str, checked: list[str]
) -> None:
    """The step as it stands, with a command that notes its arguments and fails for the second code."""
    step = next(s for s in steps(ACTION) if "conform" in s.get("run", ""))
    command = tmp_path / "southwell"
    command.write_text('#!/bin/sh\necho "$@" >> called\ntest "$2" != other.mod:SOLVER\n')
    command.chmod(0o755)
    path = os.pathsep.join([str(tmp_path), os.environ["PATH"]])
    process = subprocess.run(
        ["bash", "-eo", "pipefail", "-c", step["run"]],
        cwd=tmp_path,
        env=os.environ | {"PATH": path, "CODES": codes, "CONFORM": conform},
    )
    called = tmp_path / "called"
    assert (called.read_text().splitlines() if called.exists() else []) == checked
    assert process.returncode == (1 if len(checked) == 2 else 0)


def test_the_history_s_branch_is_made_and_added_to(tmp_path: Path) -> None:
    """The two steps that read and write it, as they stand, against a repository beside."""
    by_name = {s.get("name"): s["run"] for s in steps(ROOT / ".github" / "workflows" / "matrix.yml") if "run" in s}
    origin = tmp_path / "origin"
    git(tmp_path, "init", "--quiet", "--bare", "--initial-branch=main", str(origin))
    first = tmp_path / "first"
    git(tmp_path, "clone", "--quiet", str(origin), str(first))
    (first / "file").write_text("1")
    git(first, "add", "file")
    git(first, "-c", "user.name=a", "-c", "user.email=a@b", "commit", "--quiet", "--message", "file")
    git(first, "push", "--quiet", "origin", "HEAD:main")
    here = {**os.environ, "PATH": os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])}

    def step(folder: Path, name: str, **variables: str) -> str:
        command = ["bash", "-eo", "pipefail", "-c", by_name[name]]
        process = subprocess.run(command, cwd=folder, env=here | variables, capture_output=True, text=True)
        assert process.returncode == 0, process.stderr
        return process.stdout

    for k, commit in enumerate(("aaa", "bbb"), 1):
        job = tmp_path / f"job{k}"
        git(tmp_path, "clone", "--quiet", "--depth=1", f"file://{origin}", str(job))
        phrase = step(job, "Fetch the history")
        assert ("no history yet" if k == 1 else "1 earlier runs") in phrase
        (job / "reports" / "out").mkdir(parents=True)
        shutil.copy(ROOT / "reports" / "site" / "readme.jsonl", job / "reports" / "out" / "results.jsonl")
        step(job, "Add the run to the history", GITHUB_SHA=commit)
    assert git(origin, "ls-tree", "--name-only", "history").split() == ["history.jsonl"]
    kept = tmp_path / "kept.jsonl"
    kept.write_text(git(origin, "show", "history:history.jsonl"), encoding="utf-8")
    assert [e.commit for e in history.read(kept).entries] == ["aaa", "bbb"]
    assert git(origin, "ls-tree", "--name-only", "main").split() == ["file"]


@pytest.mark.skipif(BASH is None, reason="no bash")
@pytest.mark.parametrize(("status", "expected"), [(0, 0), (1, 0), (2, 2), (3, 3), (70, 70), (130, 130), (137, 137)])
@pytest.mark.parametrize("name", ["action.yml: Run the matrix", "nightly", "gitlab-ci.yml"])
def test_only_misses_are_left_to_the_gate(name: str, status: int, expected: int, tmp_path: Path) -> None:
    """The line that runs ``verify`` goes on after statuses 0 and 1, and ends the script with any other."""
    (line,) = re.findall(r"^ *(southwell verify .*)$", scripts()[name], re.MULTILINE)
    script = f"southwell() {{ return {status}; }}\nCASES= out=. cases=() options=()\n{line}\necho went on"
    process = subprocess.run(["bash", "-eo", "pipefail", "-c", script], cwd=tmp_path, capture_output=True, text=True)
    assert (process.returncode, process.stdout) == (expected, "" if expected else "went on\n")


def test_the_exit_statuses_are_documented_and_told_by_help() -> None:
    text = (ROOT / "docs" / "ci.md").read_text(encoding="utf-8")
    assert all(f"| {status} | {meaning} |" in text for status, meaning in statuses.MEANING.items())
    assert statuses.listed() in str(cli.app.help)
