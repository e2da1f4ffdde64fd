"""Each known defect exists in the installed version; remove one that has been fixed from the list."""

import ast
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path

import pytest

from southwell.references import isolated
from southwell.references.protocol import registry
from southwell.references.solid import calculix

from . import DEFECTS, Defect, shown

FRAMES = ("pybmodes_blade", "frame3dd_cantilever")
"""What several scripts import: a model of the code."""

INSTALLED = {
    "pinocchio": find_spec("pinocchio") is not None,
    "exudyn": find_spec("exudyn") is not None,
    "pybmodes": find_spec("pybmodes") is not None,
    "calculix": calculix.version() is not None,
    "sharpy": isolated.SHARPY.version() is not None,
    "frame3dd": isolated.FRAME3DD.version() is not None,
    "scikit": find_spec("skfem") is not None,
}


@pytest.mark.nightly
@pytest.mark.parametrize("defect", DEFECTS, ids=lambda d: d.script)
def test_the_defect_is_present(defect: Defect) -> None:
    if not INSTALLED[defect.script.partition("_")[0]]:
        hint = f": southwell codes install {defect.environment}" if defect.environment else ""
        pytest.skip(f"not installed{hint}")
    lines = shown(defect).splitlines()
    assert lines[-1] == "defect: present", "fixed: remove it from the list"
    assert "expected" in "".join(lines[1:-1])
    assert any(character.isdigit() for character in lines[0]), "its first line names the version"


@pytest.mark.parametrize("defect", DEFECTS, ids=lambda d: d.script)
def test_its_script_is_self_contained(defect: Defect) -> None:
    """It can be sent upstream, with the file beside it that it names: nothing of this package is imported."""
    tree = ast.parse(defect.path.read_text(encoding="utf-8"))
    imported = {a.name for n in ast.walk(tree) if isinstance(n, ast.Import) for a in n.names}
    imported |= {n.module or "." for n in ast.walk(tree) if isinstance(n, ast.ImportFrom)}
    assert not {name for name in imported if name.partition(".")[0] in ("southwell", "", "core", "references")}
    assert (ast.get_docstring(tree) or "").count("Needs:") == 1


def test_every_script_is_listed_and_every_code_known() -> None:
    scripts = {p.stem for p in DEFECTS[0].path.parent.glob("*.py")} - {"__init__", "test_defects", *FRAMES}
    assert scripts == {d.script for d in DEFECTS}
    assert {code for d in DEFECTS for code in d.codes} <= set(registry.names())


def test_the_page_lists_every_defect() -> None:
    page = (Path(__file__).parents[3] / "docs" / "known-defects.md").read_text(encoding="utf-8")
    rows = [
        [field.strip() for field in line.strip("|").split(" | ")]
        for line in page.splitlines()
        if line.startswith("| `")
    ]
    listed = [[", ".join(f"`{code}`" for code in d.codes), d.what, d.avoided, f"`{d.script}.py`"] for d in DEFECTS]
    assert rows == listed


def test_a_reproducer_that_cannot_run_is_reported() -> None:
    with pytest.raises(RuntimeError, match=r"missing: .*No such file"):
        shown(replace(DEFECTS[0], script="missing"))
    with pytest.raises(RuntimeError, match=r"no answer within 0\.001 s"):
        shown(DEFECTS[0], timeout=0.001)
