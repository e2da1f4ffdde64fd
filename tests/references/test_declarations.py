"""What adapters declare about their origins, checked against what their modules import and call."""

import subprocess
import sys
import tomllib
from dataclasses import replace
from pathlib import Path

import grimp
import numpy as np
import pytest

from southwell.references.protocol import registry
from southwell.references.protocol.interface import ADAPTERS, CORE, REFERENCE_LINE, BladeAdapter, CodeError

from ..support.beams import PARK
from ..support.codes import BLADE_CODES

LANGUAGE = {"blade", "blade_checks", "curve", "effects", "modes", "rank", "regular_files", "participation"}
"""Modules of core that describe blades and modes, for every adapter. Others solve or discretise."""

TOOLS = {"compiled", "space", "condense"}
"""Folders of core with rigid-body motions and condensation."""


IMPORTS = grimp.build_graph("southwell", cache_dir=None)


def imports(module: str) -> set[str]:
    """Modules of the package that a module imports."""
    return IMPORTS.find_modules_directly_imported_by(module)


def modules(name: str) -> set[str]:
    """Modules of the package, except those of the protocol and of descriptions of mechanisms, that an adapter imports."""
    result: set[str] = set()
    todo = {registry.locate(name).partition(":")[0]}
    while todo:
        result |= todo
        todo = {
            other
            for module in todo
            for other in imports(module)
            if not other.startswith(("southwell.references.protocol", "southwell.core"))
        } - result
    return result


def imported_of_core(name: str) -> set[str]:
    """Parts of core that the modules of an adapter import: names of its modules and folders."""
    result = {other for module in modules(name) for other in imports(module)}
    return {other.split(".")[2] for other in result if other.startswith("southwell.core.")}


@pytest.mark.parametrize("name", BLADE_CODES)
def test_a_code_that_uses_cores_discretisation_declares_it(name: str) -> None:
    declared = registry.code(name).independence
    discretising = imported_of_core(name) - LANGUAGE - TOOLS
    assert bool(discretising) == (CORE in vars(declared).values()), discretising


@pytest.mark.parametrize("name", BLADE_CODES)
def test_the_reference_line_is_declared_by_the_codes_that_use_it(name: str) -> None:
    uses = "southwell.references.theories.reference_line" in modules(name)
    assert uses == (registry.code(name).independence.sections == REFERENCE_LINE)


@pytest.mark.parametrize("name", BLADE_CODES)
def test_the_adapters_eigensolver_is_declared_by_the_codes_that_use_it(name: str) -> None:
    imported = {other for module in modules(name) for other in imports(module)}
    own = "southwell.references.matrices.quadratic" in imported
    engine = registry.code(name).independence
    assert (engine.eigensolver == "the adapters' own") == own or engine.eigensolver == engine.engine


def test_theories_made_by_adapters_are_declared_as_such() -> None:
    declared = {name: registry.code(name).independence for name in registry.names()}
    assert {name for name, origin in declared.items() if origin and ADAPTERS in origin.theory} == {
        "exudyn-tree", "exudyn-turbine", "pinocchio-turbine", "scikit-fem", "scikit-fem-reissner",
        "scikit-fem-solid",
    }  # fmt: skip


@pytest.mark.parametrize("name", ["scikit-fem", "scikit-fem-reissner"])
def test_scikit_fem_assembles_the_matrices(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    skfem = pytest.importorskip("skfem")
    code = registry.code(name)
    assert isinstance(code, BladeAdapter)

    def refuse(*_: object, **__: object) -> None:
        raise ZeroDivisionError("assembled")

    monkeypatch.setattr(skfem.BilinearForm, "assemble", refuse)
    with pytest.raises(ZeroDivisionError, match="assembled"):
        code.solve(replace(PARK, name=f"assembled by {name}"), 1.0, code.levels[0], 2)


@pytest.mark.parametrize("name", BLADE_CODES)
def test_refinements_are_within_the_codes_own_limits(name: str) -> None:
    code = registry.code(name)
    assert code.levels[-1] <= (code.finest or code.levels[-1]) <= (code.max_elements or np.inf)


@pytest.mark.parametrize("name", [name for name in BLADE_CODES if registry.code(name).max_elements])
def test_a_mesh_above_the_limit_of_a_code_is_an_error(name: str) -> None:
    code = registry.code(name)
    with pytest.raises(CodeError, match=f"elements: {code.max_elements + 1}"):
        code.solve(PARK, 10.0, code.max_elements + 1, 4)


@pytest.mark.slow
def test_no_adapter_imports_its_code_until_it_solves() -> None:
    program = (
        "import sys\nfrom southwell.references.protocol import registry\n"
        "for name in registry.names(): registry.code(name).version()\n"
        "imported = {'exudyn', 'pinocchio', 'skfem', 'pybmodes', 'mujoco', 'pydrake'} & set(sys.modules)\n"
        "assert not imported, imported\n"
    )
    subprocess.run([sys.executable, "-c", program], check=True)


def test_every_code_is_an_entry_point_of_this_package() -> None:
    project = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    own = {name: path for name, path in registry.registered().items() if registry.bundled(path)}
    assert own == project["entry-points"][registry.GROUP]
