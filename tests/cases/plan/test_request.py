"""The command line that a report gives to reproduce a run asks exactly what the run was asked."""

import shlex
from dataclasses import fields, replace
from math import radians
from pathlib import Path

import pytest

from southwell.cases.input.readers import Mount
from southwell.cases.judge.results import Run
from southwell.cases.plan.request import Execution, Request, command_line
from southwell.reports.cli import app
from southwell.reports.cli import verify as command

DEFAULT = Request()

EVERYTHING = Request(
    subjects=("my deck/blade.dat", "tip-mass"),
    codes=("exact-beam", "module:CODE"),
    rpm="0:12.1:1.1",
    mount=Mount(Path("main file.dat"), 61.5, 1.5, radians(-2.5), radians(0.1), (5, 1), (1.057344, 1.0, 1.0), False),
    blade_only=True,
    changes=("EI_flap=*1.1", "tip_mass=*0.5"),
    add=("rig=a file.csv", "other=b.csv"),
    data_uncertainty="1%",
    input_uncertainty="2%",
    faults="no Coriolis,frozen frame",
    witnesses=0,
    time_limit=3.5,
    memory_limit=0.1,
)

EACH = [replace(EVERYTHING, **{f.name: getattr(DEFAULT, f.name)}) for f in fields(Request)]


def parsed(line: str, monkeypatch: pytest.MonkeyPatch) -> Request:
    """The request that the command makes of a line."""
    requests: list[Request] = []

    def verify(request: Request, observer: object) -> Run:
        requests.append(request)
        return Run(())

    monkeypatch.setattr(command, "verify", verify)
    with pytest.raises(SystemExit):
        app.main(shlex.split(line)[1:])
    return replace(requests[0], execution=Execution())


@pytest.mark.parametrize("request_", [DEFAULT, EVERYTHING, replace(EVERYTHING, rpm=None, omega="0,10.5"), *EACH])
def test_the_command_line_of_a_request_gives_the_same_request(
    request_: Request, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert parsed(command_line(request_), monkeypatch) == request_


def test_the_command_line_of_a_request_omits_the_executor() -> None:
    """The results of a request are the same bytes on any machine."""
    request = Request(("tip-mass",), execution=Execution(4, None, out=Path("out"), fresh=True))
    assert command_line(request) == "southwell verify tip-mass"


@pytest.mark.parametrize("degrees", [0.0, 2.5, -2.5, 61.123456789, 1e-7, 1 / 3])
def test_an_angle_is_kept_to_the_last_bit(degrees: float, monkeypatch: pytest.MonkeyPatch) -> None:
    request = Request(("blade.dat",), mount=Mount(precone=radians(degrees)))
    assert parsed(command_line(request), monkeypatch) == request
