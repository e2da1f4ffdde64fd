"""What is installed is what is here: packages, their data, and nothing that belongs to one machine."""

import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tomllib
import zipfile
from importlib.metadata import version
from pathlib import Path

import pytest
import yaml
from packaging.version import Version

import southwell
from southwell.core import compiled

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
SETUPTOOLS = PROJECT["tool"]["setuptools"]

NOT_PACKAGED = {".ci", "tests", "benchmarks", "examples", "docs"}
"""Folders with modules that are not installed."""


FLOWS = ("matrix", "wheels", "publish")
FORMS = ROOT / ".github" / "ISSUE_TEMPLATE"


def tracked() -> list[Path]:
    """Files under version control; in an unpacked source distribution, all files."""
    if not (ROOT / ".git").exists():
        pytest.skip("not a checkout")
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, check=True, text=True).stdout
    return [ROOT / name for name in listed.split("\0") if name and (ROOT / name).is_file()]


def folder(package: str) -> Path:
    return ROOT.joinpath(*package.split(".")[1:])


def data_files() -> set[str]:
    """Paths, from the root, of what ``package-data`` names."""
    globs = SETUPTOOLS["package-data"].items()
    return {str(p.relative_to(ROOT)) for package, names in globs for n in names for p in folder(package).glob(n)}


def test_every_folder_that_is_a_package_is_listed_and_no_other() -> None:
    result = {
        ".".join(("southwell", *path.relative_to(ROOT).parent.parts))
        for path in tracked()
        if path.name == "__init__.py" and path.relative_to(ROOT).parts[0] not in NOT_PACKAGED
    }
    assert set(SETUPTOOLS["packages"]) == result


def test_every_file_beside_the_modules_is_packaged_or_known_not_to_be() -> None:
    floors = {"core", "references", "cases", "reports"}
    beside = {
        str(p.relative_to(ROOT))
        for p in tracked()
        if p.relative_to(ROOT).parts[0] in floors and p.suffix not in {".py", ".md"}
    }
    assert beside - data_files() == {
        "reports/site/readme.jsonl",
    }  # for the README and the site alone


def test_version_and_requirements_are_those_of_the_project_everywhere() -> None:
    """In the citation and in the conda recipe, where Matplotlib without a GUI and PyYAML have other names."""
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert citation["version"] == PROJECT["project"]["version"]
    recipe = (ROOT / "conda" / "meta.yaml").read_text(encoding="utf-8")
    run = recipe[recipe.index("  run:") : recipe.index("test:")]
    result = {line.strip("- ").replace(" ", "") for line in run.splitlines()[1:] if line.strip()}
    names = {"matplotlib": "matplotlib-base", "PyYAML": "pyyaml"}
    needed = {re.sub(r"^[\w-]+", lambda m: names.get(m[0], m[0]), d) for d in PROJECT["project"]["dependencies"]}
    assert result == needed | {"python>=3.11"}


def test_a_release_is_published_only_after_the_matrix_and_the_wheels() -> None:
    flows = {name: yaml.safe_load((ROOT / ".github" / "workflows" / f"{name}.yml").read_text()) for name in FLOWS}
    for name in ("matrix", "wheels"):
        assert "workflow_call" in flows[name][True]  # YAML reads `on` as true
        assert flows["publish"]["jobs"][name]["uses"] == f"./.github/workflows/{name}.yml"
    assert flows["publish"][True] == {"push": {"tags": ["v*"]}}
    job = flows["publish"]["jobs"]["publish"]
    assert job["needs"] == ["matrix", "wheels"]
    assert (job["permissions"], job["environment"]) == ({"id-token": "write"}, "release")
    assert "cp311-* cp312-* cp313-*" in PROJECT["tool"]["cibuildwheel"]["build"]


def test_a_job_that_does_not_use_git_keeps_no_credentials() -> None:
    for path in sorted((ROOT / ".github" / "workflows").glob("*.yml")):
        for name, job in yaml.safe_load(path.read_text(encoding="utf-8"))["jobs"].items():
            steps = job.get("steps", [])
            git = any(re.search(r"\bgit (fetch|-C)", step.get("run", "")) for step in steps)
            for step in (step for step in steps if step.get("uses", "").startswith("actions/checkout@")):
                kept = step.get("with", {}).get("persist-credentials", True)
                assert kept == git, f"{path.name}: {name}"


def test_issue_forms_ask_for_what_a_discrepancy_needs() -> None:
    forms = {p.stem: yaml.safe_load(p.read_text(encoding="utf-8")) for p in FORMS.glob("*.yml") if p.stem != "config"}
    assert set(forms) == {"bug", "frequency-discrepancy"}
    for form in forms.values():
        assert all(field["validations"]["required"] for field in form["body"])
    field_ids = {field["id"] for field in forms["frequency-discrepancy"]["body"]}
    assert field_ids == {"blade", "numbers", "source", "where", "versions"}


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> set[str]:
    """Names of the files in a wheel built from a copy of the checkout, without the network.

    The compiled modules are those of the checkout, which the installation has compiled: they lie where a build has put them.
    """
    needed = Version(re.search(r"setuptools>=(\d+)", PROJECT["build-system"]["requires"][0])[1])  # type: ignore[index]
    if Version(version("setuptools")) < needed:
        pytest.skip(f"setuptools {version('setuptools')} is older than {needed}: pip install -e '.[dev]'")
    source, out = tmp_path_factory.mktemp("source"), tmp_path_factory.mktemp("wheel")
    for path in tracked():
        copy = source / path.relative_to(ROOT)
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(path, copy)
    here = f"lib.{sysconfig.get_platform()}-{sys.implementation.cache_tag}"
    built = source.joinpath("build", here, "southwell", "core", "compiled")
    built.mkdir(parents=True)
    for module in Path(compiled.__file__).parent.glob(f"*{sysconfig.get_config_var('EXT_SUFFIX')}"):
        shutil.copy(module, built)
    command = [sys.executable, "-m", "pip", "wheel", "--no-deps", "--no-build-isolation", "--wheel-dir", str(out), "."]
    process = subprocess.run(
        command, cwd=source, capture_output=True, text=True, env={**os.environ, "PIP_NO_INDEX": "1"}
    )
    assert process.returncode == 0, process.stderr
    (file,) = out.glob("*.whl")
    return set(zipfile.ZipFile(file).namelist())


@pytest.mark.slow
def test_the_wheel_has_every_module_and_every_data_file(wheel: set[str]) -> None:
    modules = {
        f"southwell/{path.relative_to(ROOT)}"
        for path in tracked()
        if path.suffix == ".py" and path.relative_to(ROOT).parts[0] not in NOT_PACKAGED
    }
    assert modules <= wheel
    assert {f"southwell/{name}" for name in data_files()} <= wheel
    assert any(name.startswith("southwell/core/compiled/baseline.") for name in wheel)
    assert any(name.endswith(".jinja") for name in data_files())
    assert any(name.endswith(".csv") for name in data_files())


@pytest.mark.slow
def test_the_wheel_has_neither_tests_nor_anything_else(wheel: set[str]) -> None:
    assert not [name for name in wheel if "/tests/" in name or not name.startswith("southwell")]
    assert any(name.endswith("licenses/LICENSE") for name in wheel)


HOME = re.compile(r"(?<![\w.:/])/(?:home|root|tmp|work|Users|mnt|farm)/\w|[A-Z]:\\\\Users")


def test_no_file_speaks_of_one_machine() -> None:
    result = []
    for path in tracked():
        text = path.read_text(encoding="utf-8", errors="replace")
        result += [f"{path.name}:{k}" for k, line in enumerate(text.splitlines(), 1) if HOME.search(line)]
        if path != ROOT / ".ci" / "run":  # which looks beside the checkout for blades, and does without
            result += [f"{path.name}: ../ outside" for line in text.splitlines() if re.search(r"\.\./sha[r]ed", line)]
    assert not result


def test_the_patterns_of_that_test_find_such_paths() -> None:
    assert HOME.search("see " + "/".join(["", "home", "someone", "x"]))
    assert not HOME.search("https://example.org/home/page")
    assert not HOME.search("kg/m or N/work")


def test_versions_and_entry_point_are_those_of_the_project() -> None:
    assert version("southwell") == PROJECT["project"]["version"]
    assert f"## [{PROJECT['project']['version']}]" in (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    module, _, function = PROJECT["project"]["scripts"]["southwell"].partition(":")
    assert callable(getattr(__import__(module, fromlist=[function]), function))


def test_the_tested_package_is_this_checkout() -> None:
    """Another checkout beside this one, in a folder named ``southwell``, must not be taken for it."""
    assert Path(str(southwell.__file__)).resolve().parent == ROOT
