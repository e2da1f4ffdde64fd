"""A run as JUnit XML: one test suite per blade, one test case per cell and per check of a property.

Written with ElementTree of the standard library. Characters that XML cannot represent, such as in the output of a
crashed code, are replaced.
"""

import re
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from ...cases.judge.quantities import QUANTITIES
from ...cases.judge.results import Cell, Key, PropertyCheck, Run, described
from ...cases.regression.gate import Comparison
from ...cases.regression.history import Detection, Point
from ..shared import summary

FORBIDDEN = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
"""Characters that XML 1.0 (section 2.2, Char) does not allow."""

SKIPPED = ("not run", "not applicable", "measured")
"""Verdicts without a judgement; their test cases are skipped."""


def render(run: Run, gate: Comparison | None = None, strict: bool = False) -> bytes:
    """The XML document.

    A cell fails if its verdict is a failure or inconclusive, or if the gate found it worse or, with ``strict``, moved.
    Missing answers, and seeded faults that are no longer detected, are separate failed test cases. An incomplete
    run adds a first test case with an error.
    """
    findings = _findings(gate, strict) if gate else {}
    root = Element("testsuites", name="southwell")
    if messages := summary.incomplete(run):
        test = _test(SubElement(root, "testsuite", name="the run"), "southwell", "the run is complete")
        SubElement(test, "error", type="incomplete", message=_text(messages)).text = _text(messages)
    for case in summary.cases(run):
        suite = SubElement(root, "testsuite", name=_text(case))
        for cell in (c for c in run.cells if c.case == case):
            test = _test(suite, case, _name(cell))
            _judge(test, cell, findings.get(cell.key, ""))
        for check in (c for c in run.property_checks if c.case == case):
            _check(_test(suite, case, f"{check.quantity} by {check.code}: {check.part or 'no property'}"), check)
    if gate:
        _regressions(root, gate)
    for suite in root:
        suite.set("tests", str(len(suite)))
        for kind, name in {"failure": "failures", "error": "errors", "skipped": "skipped"}.items():
            suite.set(name, str(len(suite.findall(f"testcase/{kind}"))))
    indent(root)
    return tostring(root, encoding="utf-8", xml_declaration=True)


def _findings(gate: Comparison, strict: bool) -> dict[Key, str]:
    """Findings of the gate on present cells, by cell."""
    messages = {
        c.after.key: f"worse: {c.before.verdict if c.before else 'not there'} → {c.after.verdict}" for c in gate.worse
    }
    for c in gate.moved if strict else ():
        if c.before:
            messages.setdefault(c.after.key, f"moved: {_digits(c.before)} → {_digits(c.after)}")
    return messages


def _regressions(root: Element, gate: Comparison) -> None:
    """Add test cases for missing answers and for faults that are no longer detected."""
    regressions = [c for c in gate.properties if c.before and c.check.verdict != "fail"]
    if not (gate.gone or gate.undetected or regressions):
        return
    suite = SubElement(root, "testsuite", name="against the earlier run")
    for gone in gate.gone:
        p: Point = gone.point
        test = _test(suite, p.case, _name(p))
        _failed(test, "gone", f"the answer {_digits(p)} is missing; now {gone.replacement or 'nothing'}")
    for control in gate.undetected:
        _lost(suite, control)
    for change in regressions:
        check, verdict = change.check, change.after.verdict if change.after else "not there"
        test = _test(suite, check.case, f"{check.quantity} by {check.code}: {check.part or 'no property'}")
        _failed(test, "no longer checked", f"was {change.before.verdict if change.before else ''}; now {verdict}")


def _lost(suite: Element, control: Detection) -> None:
    test = _test(suite, control.case, f"seeded fault: {control.control} at {control.omega:.6g} rad/s")
    _failed(test, "not detected", f"was detected by {', '.join(control.detected_by)}; no code detects it now")


def _digits(point: Point) -> str:
    return f"{point.value!r} {QUANTITIES[point.quantity].unit}".rstrip()


def _name(of: Cell | Point) -> str:
    description = described(f"mode {of.mode} ({of.family})", of.quantity, of.where) if of.mode else "no answer"
    return f"{of.code}: {description} at {of.omega:.6g} rad/s"


def _test(suite: Element, case: str, name: str) -> Element:
    return SubElement(suite, "testcase", classname=_text(case), name=_text(name))


def _judge(test: Element, cell: Cell, finding: str) -> None:
    message = ": ".join(part for part in (cell.verdict, summary.plus_minus(cell), cell.reason) if part)
    if finding:
        _failed(test, finding.partition(":")[0], f"{finding}; {message}")
    else:
        _outcome(test, cell.verdict, message, cell.verdict in summary.BAD)


def _check(test: Element, check: PropertyCheck) -> None:
    message = ": ".join(part for part in (check.verdict, check.reason) if part)
    _outcome(test, check.verdict, message, check.verdict == "fail")


def _outcome(test: Element, verdict: str, message: str, failed: bool) -> None:
    if failed:
        _failed(test, verdict, message)
    elif verdict in SKIPPED:
        SubElement(test, "skipped", message=_text(message))
    else:
        SubElement(test, "system-out").text = _text(message)


def _failed(test: Element, kind: str, message: str) -> None:
    SubElement(test, "failure", type=_text(kind), message=_text(message)).text = _text(message)


def _text(text: str) -> str:
    return FORBIDDEN.sub("�", text)
