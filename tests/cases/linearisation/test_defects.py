"""Defects planted into healthy sets are found by name; healthy sets have none."""

from collections.abc import Sequence
from pathlib import Path

import pytest

from southwell.cases.linearisation.findings import DEFECT, LIMIT
from southwell.cases.linearisation.judgement import judge_set
from southwell.cases.linearisation.lin_file import parsed
from southwell.cases.linearisation.sets import azimuth_set
from southwell.tests.support.linearised_defects import DEFECTS, HEALTHY, Defect, healthy
from southwell.tests.support.linearised_machines import Lin, without


def findings(lins: Sequence[Lin]) -> dict[str, str]:
    """Level of each finding by name."""
    each = azimuth_set("case", [parsed(Path(f"case.{k + 1}.lin"), lin.text()) for k, lin in enumerate(lins)])
    return {finding.name: finding.level for finding in judge_set(each).findings}


@pytest.mark.parametrize("name", HEALTHY)
def test_a_healthy_set_has_no_finding(name: str) -> None:
    assert not {DEFECT, LIMIT} & set(findings(HEALTHY[name]()).values())


@pytest.mark.parametrize("defect", DEFECTS, ids=lambda defect: defect.title)
def test_a_planted_defect_is_found_by_its_name_alone(defect: Defect) -> None:
    found = findings(defect.plant())
    assert set(defect.names) & set(found)
    assert {name for name, level in found.items() if level == DEFECT} <= set(defect.names)


def test_limits_of_the_evidence() -> None:
    assert findings(healthy(n=1))["one azimuth"] == LIMIT
    assert findings(healthy(n=3))["few azimuths"] == LIMIT
    assert findings([*healthy(n=4), healthy(n=4)[1]])["repeated azimuths"] == DEFECT


def test_a_displacement_without_its_rate_is_found() -> None:
    assert (
        findings([without(lin, "First time derivative of Nacelle yaw") for lin in healthy(n=3)])["missing state"]
        == DEFECT
    )


def test_the_page_has_every_planted_defect() -> None:
    page = Path(__file__).parents[3].joinpath("docs", "linearisations.md").read_text(encoding="utf-8")
    rows = [line.split(" | ")[:2] for line in page.splitlines() if line.startswith("| ")]
    assert [["| " + defect.title, defect.names[0]] for defect in DEFECTS] == rows[1:]
