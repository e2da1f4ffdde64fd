"""Over a hundred failures of a foreign code: each affects its cells only, is reported, and leaves no process running."""

import os
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import partial
from pathlib import Path

import pytest

from southwell.core.blade import uniform_blade
from southwell.core.modes import Modes
from southwell.references.protocol import description, launch, registry
from southwell.references.protocol.description import Description, describe
from southwell.references.protocol.process import Failure, Limits
from southwell.references.protocol.worker import answers

from ...support.misdeeds import ANSWERS, DECLARATIONS, TABLE, Misdeed, answering, declaring, module

pytestmark = pytest.mark.slow

BLADE = uniform_blade("beam", 6.0, 0.3, EA=1e7, GJ=1e3, EI_y=1 / 3, EI_z=1.4e4, mass=1.2)
RUNS = [(0.0, 10, 3), (2.0, 10, 3), (0.5, 20, 3)]
LIMITS = Limits(seconds=60.0, memory=3 * 2**28)
TOKEN = f"southwell-misdeeds-{os.getpid()}"

LEFT = {"none": "MMM", "one": "MFM", "rest": "MFF", "all": "FFF"}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """The current folder, which contains the codes, and files with names of the standard library."""
    made = tmp_path_factory.mktemp("misdeeds")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(made)
        patch.setenv("SOUTHWELL_TEST", TOKEN)
        yield made


def does(misdeed: Misdeed, folder: Path) -> tuple[Description, list[Modes | Failure]]:
    """The description of the code and its answers; a code without a description is not run."""
    path = misdeed.write(folder)
    limits = replace(LIMITS, seconds=misdeed.seconds)
    if misdeed.when in ("unsupported", "solve"):
        return Description(path, path), answers(path, BLADE, RUNS, limits)
    (description_,) = describe([path], limits=limits)
    return description_, [description_.failure] * len(RUNS) if description_.failure else answers(
        path, BLADE, RUNS, limits
    )


@pytest.fixture(scope="module")
def done(folder: Path) -> dict[Misdeed, tuple[Description, list[Modes | Failure]]]:
    with ThreadPoolExecutor(2) as threads:
        answered = dict(zip(TABLE, threads.map(partial(does, folder=folder), TABLE), strict=True))
    launch.prepare().close()
    return answered


@pytest.mark.parametrize("misdeed", TABLE, ids=lambda m: f"{m.when}-{m.name}")
def test_a_failure_affects_its_runs_only_and_is_reported(misdeed: Misdeed, done: dict) -> None:
    message, replies = done[misdeed]
    assert "".join("F" if isinstance(answer, Failure) else "M" for answer in replies) == LEFT[misdeed.lost], replies
    assert not message.failure or message.name.startswith("mis")
    for failure in (answer for answer in replies if isinstance(answer, Failure)):
        assert misdeed.reason in failure.reason
        assert failure.reason.isprintable()
        assert len(failure.reason) <= 400


def test_no_process_is_left_running(done: dict) -> None:
    remainder = []
    for environ in Path("/proc").glob("[0-9]*/environ"):
        try:
            if TOKEN.encode() in environ.read_bytes() and int(environ.parent.name) != os.getpid():
                remainder.append((environ.parent / "cmdline").read_bytes())
        except OSError:  # the process has ended, or is another user's
            continue
    assert len(done) == len(TABLE) >= 60
    assert not remainder


def test_invalid_declarations_are_quoted(folder: Path) -> None:
    """In one process, as none of them ends it; each is a separate code."""
    paths = declaring(folder)
    descriptions = description._asked({path: registry.address(path) for path in paths.values()}, [], LIMITS)
    for (line, reported), description_ in zip(DECLARATIONS.items(), descriptions, strict=True):
        assert description_.failure, line
        assert description_.failure.kind == "nonsense", line
        assert reported in description_.failure.reason, (line, description_.failure.reason)
        assert description_.name in ("misdeed", paths[line])


def test_invalid_answers_are_quoted_and_affect_no_other(folder: Path) -> None:
    path = answering(folder)
    runs = [run for number in range(len(ANSWERS)) for run in ((10.0 + number, 10, 3), (1.0, 10, 3))]
    answer = answers(path, BLADE, runs, Limits(30.0))
    for (line, reported), bad, good in zip(ANSWERS.items(), answer[::2], answer[1::2], strict=True):
        assert isinstance(good, Modes), (line, good)
        assert isinstance(bad, Failure), line
        assert bad.kind == ("refused" if "CodeError" in line else "nonsense"), (line, bad)
        assert reported in bad.reason, (line, bad.reason)


def test_a_path_without_a_code_is_an_error(folder: Path) -> None:
    module(folder, "nothing_here", "CODE = 42\n")
    for path, reported in (
        ("nothing_here:CODE", "is int, not an adapter"),
        ("nothing_here:NO", "no attribute 'NO'"),
        ("nowhere:CODE", "No module"),
    ):
        with pytest.raises(registry.UnknownCodeError, match=reported):
            describe([path], limits=LIMITS)


def test_no_file_of_the_current_folder_shadows_a_module(folder: Path) -> None:
    """A code in the current folder and a module it imports are found; ``random.py`` in the folder is not executed."""
    for name in ("random", "json", "numpy", "ctypes", "signal", "select"):
        (folder / f"{name}.py").write_text("import os\nos._exit(9)\n", encoding="utf-8")
    (folder / "southwell").mkdir()
    (folder / "southwell" / "__init__.py").write_text("import os\nos._exit(9)\n", encoding="utf-8")
    module(folder, "neighbour", "NAME = 'by-my-neighbour'\n")
    lines = "import random\nfrom neighbour import NAME\nclass Code(Base):\n    name = NAME\n    version = lambda self: '1'\n"
    module(
        folder,
        "lawful",
        lines
        + "    unsupported = lambda self, blade: None\n    modes = lambda self, *a: good(*a[1:])\nCODE = Code()\n",
    )
    (actual, own_answer) = describe(["yoo-shin", "lawful:CODE"], limits=Limits(30.0))
    assert (actual.failure, own_answer.failure, own_answer.name) == (None, None, "by-my-neighbour")
    (answer,) = answers("lawful:CODE", BLADE, RUNS[:1], Limits(30.0))
    assert isinstance(answer, Modes)
