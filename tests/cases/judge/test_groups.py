"""Independence is declared and counted by group; the eigensolver that adapters share is verified by itself."""

from dataclasses import asdict, fields, replace

import numpy as np
import pytest

from southwell.cases.input import library
from southwell.cases.input.errors import CaseError
from southwell.cases.input.schema import decode
from southwell.cases.input.toml import document
from southwell.cases.judge.results import Origin, Run, Setting
from southwell.cases.judge.witnesses import groups, under_confirmed, witnesses
from southwell.references.matrices.quadratic import gyroscopic_modes
from southwell.references.protocol import registry
from southwell.references.protocol.interface import CORE, Independence, shares
from southwell.reports.shared import summary
from southwell.reports.verification import witnesses as reported
from southwell.tests.support.codes import BLADE_CODES

from ...support import samples


def origin(code: str, engine: str, theory: str = "", rotation: str = "", sections: str = "blade") -> Origin:
    declared = Independence(engine, theory or f"{code}'s", rotation or f"{code}'s", sections)
    return Origin("beam", code, **asdict(declared))


def run(*origins: Origin, required: int = 0, **changes) -> Run:
    cells = tuple(samples.cell(code=o.code, shares="nothing", **changes) for o in origins)
    setting = Setting("beam", "", "", "", "rad_s", groups=required, target=1e-3)
    return Run(cells, origins=origins, settings=(setting,))


def count(run: Run) -> list[tuple[str, ...]]:
    return [tuple(w.name for w in group) for group in groups(witnesses(run, "beam"))]


@pytest.mark.parametrize("name", BLADE_CODES)
def test_every_code_declares_all_of_its_origin(name: str) -> None:
    declared = registry.code(name).independence
    assert declared
    assert all(getattr(declared, f.name) for f in fields(declared))
    assert (shares(declared) == "discretisation") == (declared.theory == CORE)


def test_known_overcounts_are_one_group() -> None:
    declared = {name: registry.code(name).independence for name in BLADE_CODES}
    origins = [Origin("beam", name, **asdict(d)) for name, d in declared.items() if d]
    result = count(run(*origins))
    assert ("exudyn-ancf", "exudyn-beam", "exudyn-tree") in result
    assert ("assumed-modes", "exact-beam", "southwell-equation", "yoo-shin") in result
    assert ("sharpy",) in result  # its sections are those of the adapters' reference line, not core's
    together = {name for group in result for name in group}
    assert together.isdisjoint({"pinocchio", "drake", "mujoco"})


def test_what_shares_an_engine_a_theory_or_rotation_terms_counts_once() -> None:
    a, b = origin("a", "A"), origin("b", "B")
    assert len(count(run(a, b))) == 2
    for field in ("engine", "theory", "rotation"):
        assert count(run(a, replace(b, **{field: getattr(a, field)}))) == [("a", "b")]
    assert len(count(run(a, replace(b, sections=a.sections, eigensolver=a.eigensolver)))) == 2


def test_two_codes_that_share_with_a_third_are_one_group() -> None:
    assert count(run(origin("a", "A"), origin("b", "B"), origin("c", "A", "b's"))) == [("a", "b", "c")]


@pytest.mark.parametrize("field", ["engine", "theory", "rotation", "sections"])
def test_codes_that_share_with_the_solver_confirm_the_implementation_only(field: str) -> None:
    derived = run(replace(origin("a", "A"), **{field: CORE}))
    assert count(derived) == []
    assert reported.table(derived)[0]["confirms the implementation only"] == "a"


def test_codes_without_declaration_are_in_no_group() -> None:
    derived = replace(run(origin("a", "A")), origins=())
    assert count(derived) == []
    assert "a (undeclared" in reported.table(derived)[0]["not counted"]


@pytest.mark.parametrize(
    "changes",
    [
        {"verdict": "estimate", "difference": 0.1, "uncertainty": 0.2},
        {"verdict": "known difference", "difference": 0.1},
        {"verdict": "fail", "difference": 0.1},
        {"verdict": "inconclusive", "uncertainty": None},
        {"role": "table", "target": 2e-2},
    ],
)
def test_codes_that_do_not_agree_at_the_target_are_in_no_group(changes: dict) -> None:
    assert count(run(origin("a", "A"), **changes)) == []


def test_too_few_groups_are_status_1_and_a_line() -> None:
    enough = run(origin("a", "A"), origin("b", "B"), required=2)
    assert summary.status(enough) == 0
    assert reported.missing(enough) == []
    few = run(origin("a", "A"), origin("b", "A"), required=2)
    assert [(s.case, s.groups, s.required) for s in under_confirmed(few)] == [("beam", 1, 2)]
    assert summary.status(few) == 1
    assert reported.missing(few)[0].startswith("beam: 1 of 2 required independent groups agree")


@pytest.mark.slow
def test_cases_require_groups_or_give_a_reason() -> None:
    for case in library.load_all()[0].values():
        for variant in case.variants:
            required = case.text.compare.required(variant.name.partition("/")[2])
            assert required >= 1 or case.text.compare.lacking, variant.name


def test_none_required_without_a_reason_is_refused(tmp_path) -> None:
    import southwell.cases.data as data

    folder = next(iter(data.__path__))
    from pathlib import Path

    text = document(Path(folder) / "park-cantilever.toml")
    text["compare"]["groups"] = 0
    with pytest.raises(CaseError, match=r"compare\.groups: 0, and no reason"):
        decode(text, "x.toml", tmp_path)
    text["compare"]["groups"] = {"nowhere": 1}
    with pytest.raises(CaseError, match=r"compare\.groups\.nowhere: no such variant"):
        decode(text, "x.toml", tmp_path)


@pytest.mark.parametrize("speed", [0.0, 0.3, 5.0])
def test_the_adapters_eigensolver_against_the_dense_state_space(speed: float) -> None:
    """``M q̈ + C q̇ + K q = 0`` with C skew: eigenvalues of the companion matrix, by LAPACK, without any of its symmetry."""
    rng = np.random.default_rng(7)
    n = 12
    M, K = (x @ x.T + n * np.eye(n) for x in rng.normal(size=(2, n, n)))
    C = speed * (lambda x: x - x.T)(rng.normal(size=(n, n)))
    frequencies, _ = gyroscopic_modes(M, C, K, n)
    state = np.block([[np.zeros((n, n)), np.eye(n)], [-np.linalg.solve(M, K), -np.linalg.solve(M, C)]])
    values = np.asarray(np.linalg.eigvals(state))
    np.testing.assert_allclose(frequencies, np.sort(values.imag[values.imag > 0])[: len(frequencies)], rtol=1e-9)
