"""Defects planted into healthy sets are found by name; healthy sets have none."""

from collections.abc import Sequence

import pytest

from southwell.cases.linearisation.findings import DEFECT, LIMIT
from southwell.tests.support.linearised_defects import DEFECTS, HEALTHY, Defect, healthy, stiff_blade
from southwell.tests.support.linearised_machines import Lin, without
from southwell.tests.support.linearised_page import PAGE, findings_of, row


def findings(lins: Sequence[Lin]) -> dict[str, str]:
    """Level of each finding by name."""
    return {finding.name: finding.level for finding in findings_of(lins)}


@pytest.mark.parametrize("name", HEALTHY)
def test_a_healthy_set_has_no_finding(name: str) -> None:
    assert not {DEFECT, LIMIT} & set(findings(HEALTHY[name]()).values())


@pytest.mark.parametrize("defect", DEFECTS, ids=lambda defect: defect.title)
def test_a_planted_defect_is_found_by_its_name_alone(defect: Defect) -> None:
    own = findings_of(defect.plant())
    assert set(defect.names) & {finding.name for finding in own}
    assert {finding.name for finding in own if finding.level == DEFECT} <= set(defect.names)
    assert row(defect, own) in PAGE.read_text(encoding="utf-8")


def test_blades_are_equal_within_a_percent() -> None:
    assert "unequal blades" not in findings(stiff_blade(1.005))
    assert "unequal blades" in findings(stiff_blade(1.02))


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
    table = PAGE.read_text(encoding="utf-8").partition("| planted ")[2].partition("\n\n")[0]
    rows = [line.split(" | ")[:2] for line in ("| planted " + table).splitlines() if line.startswith("| ")]
    assert [["| " + defect.title, defect.names[0]] for defect in DEFECTS] == rows[1:]
