"""Mutated files and arguments: each is refused in one line, or taken and makes sense; nothing crashes, hangs or fills memory.

    python tests/support/fuzz.py 10000 [--seed N]

runs so many in batches, each in a process with limits, and prints what was found; status 1 if anything was. A trial is known
by its seed and number: ``trial(seed, number, folder)`` repeats it. ``.ci/fuzz`` runs this nightly.
"""

import argparse
import contextlib
import io
import json
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import traceback
from collections import Counter
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from types import FrameType
from typing import Any

import msgspec
import numpy as np

DATA = Path(__file__).parents[1] / "data"

SECONDS, WAITING, MEMORY, BATCH = 10.0, 60.0, 1 << 30, 250
"""Of one trial at most: processor time and wall time in s, and bytes; trials in one process."""

LONGEST_LINE = 1500
"""Characters of a message."""

HOSTILE = (
    "nan", "inf", "-inf", "1e308", "-1e308", "1e400", "1e30", "-2.5e9", "1e-320", "0", "-0.0", "-1", "1e12",
    "9" * 4400, str(2**63), str(-(2**63)), str(2**64), "0x" + "f" * 5000, "1.0D+03", "1.5+300", "1e", "1E+", "1_000",
    "٣", "True", "0b1", "../../../../etc/hostname", "/dev/zero", "/dev/stdin", "pipe", "folder", "loop",
    "/proc/self/mem", "x" * 300, ".", "b|<img src=x onerror=alert(1)>", "::error::x", "a\nb", '"', "'", "[/]",
    "[bold]", "\0", "\x1b[2J", "\u2028", "#", "%", ";", "[" * 3000, "{a=" * 3000, "{" * 100_000, "[" * 100_000,
    "a." * 5000 + "a=1", "- " * 5000, "(" * 5000, "&a [*a, *a]", "x" * 200_000, "1 " * 100_000,
    "!!python/object:os.system x", "!include /etc/hostname", "*SUBSTRUCTURE", "%%MatrixMarket",
)  # fmt: skip
NUMBER = re.compile(rb"(?<![\w.])[+-]?\d+\.?\d*(?:[eE][+-]?\d+)?")
WORD = re.compile(rb"[A-Za-z_][\w./-]+")


class SlowError(BaseException):
    """A trial took too long."""


def mutated(content: bytes, rng: random.Random) -> bytes:
    """A file's content with one to three faults in it."""
    for _ in range(rng.choice((1, 1, 1, 2, 3))):
        content = rng.choice(MUTATIONS)(content, rng)
    return content


def _cut(c: bytes, rng: random.Random) -> bytes:
    return c[: rng.randrange(len(c) + 1)]


def _flip(c: bytes, rng: random.Random) -> bytes:
    out = bytearray(c)
    for _ in range(rng.randrange(1, 5)):
        if out:
            out[rng.randrange(len(out))] = rng.randrange(256)
    return bytes(out)


def _insert(c: bytes, rng: random.Random) -> bytes:
    k = rng.randrange(len(c) + 1)
    return c[:k] + rng.choice(HOSTILE).encode("utf-8", "surrogatepass") + c[k:]


def _lines(c: bytes, rng: random.Random) -> bytes:
    lines = c.split(b"\n")
    i, j = rng.randrange(len(lines)), rng.randrange(len(lines))
    how = rng.randrange(4)
    if how == 0:
        del lines[i]
    elif how == 1:
        lines[i], lines[j] = lines[j], lines[i]
    else:
        lines[i:i] = [lines[j]] * (1 if how == 2 else rng.choice((10, 1000, 20_000)))
    return b"\n".join(lines)


def _replace(pattern: re.Pattern[bytes]) -> Callable[[bytes, random.Random], bytes]:
    def change(c: bytes, rng: random.Random) -> bytes:
        result = list(pattern.finditer(c))
        if not result:
            return c
        match = rng.choice(result)
        return c[: match.start()] + rng.choice(HOSTILE).encode() + c[match.end() :]

    return change


def _encode(c: bytes, rng: random.Random) -> bytes:
    return rng.choice(
        (c.decode("latin-1").encode("utf-16"), b"\xff\xfe" + c, c.replace(b"\n", b"\r"), b"\xef\xbb\xbf" + c, b"")
    )


MUTATIONS = (_cut, _flip, _insert, _lines, *([_replace(NUMBER)] * 4), *([_replace(WORD)] * 3), _encode)


def seeds(folder: Path) -> dict[str, Path]:
    """Everything that is mutated, written into ``folder``: what kind of file (by what reads it) → the file that is named."""
    from southwell.cases.condense import condensed, condensing
    from southwell.cases.regression import history
    from southwell.cases.store import results_file

    shutil.copytree(DATA / "blades", folder, dirs_exist_ok=True)
    shutil.copytree(DATA / "fuzz", folder, dirs_exist_ok=True)
    shutil.copy(DATA / "calculix_substructure.mtx", folder)
    run = _run()
    results_file.write(folder / "results.jsonl", run)
    history.append(folder / "history.jsonl", history.entry(run, "abc", "here"))
    condensed.write(folder / "segments.json", condensing.condense(folder / "bar.toml").blade)
    for name in ("pipe", "folder", "loop"):  # what a mutated name may lead to
        path = folder / name
        if not os.path.lexists(path):
            {"pipe": os.mkfifo, "folder": os.mkdir, "loop": lambda p: os.symlink("loop", p)}[name](path)
    return {kind: folder / name for kind, name in FIRST.items()}


FIRST = {
    "elastodyn": "elastodyn_main.dat",
    "beamdyn": "beamdyn_main.dat",
    "old beamdyn": "beamdyn_old_main.dat",
    "fast7": "fast7_main.fst",
    "bmodes": "bmodes.bmi",
    "hawc2": "hawc2.htc",
    "windio": "windio.yaml",
    "windio1": "windio1.yaml",
    "sections": "sections.toml",
    "case": "case.toml",
    "mechanism": "mechanism.toml",
    "condense": "bar.toml",
    "condense named": "named.toml",
    "matrix": "calculix_substructure.mtx",
    "results": "results.jsonl",
    "history": "history.jsonl",
    "segments": "segments.json",
    "rig": "rig.csv",
    "load": "load.csv",
    "arguments": "case.toml",
}
BESIDE = {
    "elastodyn": ("elastodyn_blade.dat",),
    "beamdyn": ("beamdyn_blade.dat",),
    "fast7": ("fast7_blade.dat",),
    "bmodes": ("bmodes_sections.dat",),
    "hawc2": ("hawc2_st.dat",),
    "case": ("stations.csv",),
    "condense": ("K.mtx", "M.mtx", "nodes.csv"),
    "condense named": ("K.txt", "M.txt", "nodes.csv"),
}
"""Of files of several, those that are mutated in the place of the first."""


def _run():
    from southwell.cases.judge.results import BudgetEntry, Cell, Control, Level, Origin, Planned, Run, Setting

    def cell(mode: int, code: str, **more: Any) -> Cell:
        row: dict[str, Any] = {
            "case": "beam", "omega": 10.0, "mode": mode, "family": "flapwise", "ordinal": mode, "code": code,
            "version": "1", "role": "code", "value": 11.7, "reference": 11.7, "difference": 1e-6, "uncertainty": 1e-7,
            "target": 1e-3, "verdict": "pass", "full": 11.7, "elements": 20, "order": 4.0, "mac": 1.0,
            "shares": "nothing",
        }  # fmt: skip
        return Cell(**row | more)

    empty = dict.fromkeys(("value", "reference", "difference", "uncertainty", "full", "mac")) | {"family": ""}
    cells = (cell(1, "a"), cell(2, "a"), cell(1, "b", difference=0.02, verdict="fail", reason="because"))
    cells += (cell(0, "c", verdict="not run", reason="not installed", **empty),)
    return Run(
        cells,
        (Level("beam", 10.0, 1, "a", 10, 11.8), Level("beam", 10.0, 1, "a", 20, 11.71)),
        {"southwell": "0.1"},
        "southwell verify beam",
        (Setting("beam", "A beam", "It shows.", "made up", "rpm", {"length": "1 m"}, 1, "", 1e-3),),
        (Control("no Coriolis", "solver", "leaves it out", "1 %", "beam", 10.0, ("a: flapwise 1",), 0.01),),
        (BudgetEntry("beam", 10.0, "flapwise 1", "discretisation", "lumped mass", 1e-3),),
        (Origin("beam", "a", "e", "t", "r", "s", "q"),),
        plan=(Planned("beam", "a", 1, 2), Planned("beam", "b", 1, 1), Planned("beam", "c", 1, 2)),
    )


def take(kind: str, path: Path, rng: random.Random) -> None:
    """Read a file as the command for it would.

    Raises:
        AssertionError: what is taken makes no sense.
    """
    from southwell.cases.campbell import prestress
    from southwell.cases.condense import condensed, condensing
    from southwell.cases.input import mechanisms, readers, schema
    from southwell.cases.plan import user_results
    from southwell.core.blade import uniform_blade
    from southwell.core.condense import matrix_files
    from southwell.reports.cli import arguments
    from southwell.reports.cli.history import load

    if kind == "case":
        for variant in schema.read(path).variants:
            _sound(variant.blade)
            assert (np.diff(variant.speeds) > 0).all()
    elif kind == "mechanism":
        read = mechanisms.read(path)
        assert read.text.name.isprintable()
        if rng.random() < 0.3:
            frequencies = np.abs(read.solve(2).values)
            assert np.isfinite(frequencies).all()
    elif kind.startswith("condense"):
        condensation = condensing.condense(path)
        for segment in condensation.blade.segments:
            assert np.isfinite(segment.stiffness).all()
            assert segment.inertia[0, 0] > 0
    elif kind == "segments":
        for segment in condensed.read(path).segments:
            assert np.isfinite(segment.stiffness).all()
            assert segment.inertia[0, 0] > 0
    elif kind == "matrix":
        assert np.isfinite(matrix_files.read_matrix(path).matrix.data).all()
    elif kind == "results":
        _shown(arguments.finished(path), path.parent)
    elif kind == "history":
        with contextlib.redirect_stderr(io.StringIO()):
            load(path)
    elif kind == "rig":
        for row in user_results.read("rig", path).rows:
            assert 0 < row.value.value < 1e12
            assert 0 <= row.omega < 1e9
    elif kind == "load":
        assert np.isfinite(
            prestress.load(path, uniform_blade("b", 10.0, 1.0, EA=1, GJ=1, EI_y=1, EI_z=1, mass=1))
        ).all()
    elif kind == "arguments":
        _command(path, rng)
    else:
        _sound(readers.read(path))


def _sound(blade) -> None:
    assert 0 < blade.length <= 1e4
    assert 0 <= blade.hub_radius <= 1e4
    assert abs(np.degrees(blade.precone)) <= 90.0001
    assert abs(np.degrees(blade.pitch)) <= 180
    assert np.isfinite(blade.mass).all()
    assert (blade.mass[:, 0, 0] > 0).all()
    assert (np.diagonal(blade.stiffness, axis1=1, axis2=2) > 0).all()
    assert (np.diff(blade.stations) > 0).all()
    assert blade.name.isprintable()
    assert len(blade.name) <= 100


def _shown(run, folder: Path) -> None:
    """The report of a run, in all its forms; nothing of the run is markup."""
    from southwell.reports.ci import junit
    from southwell.reports.cli import report
    from southwell.reports.dashboard import data
    from southwell.reports.documents import html, pdf
    from southwell.reports.shared import summary
    from southwell.reports.shared.log_safe import LogSafe
    from southwell.reports.verification import report as matrix_report

    text = matrix_report.render(run, {})
    page = html.render(text, folder)
    assert "<img" not in page
    assert "<script" not in page
    if find_spec("typst"):
        pdf.render(text, folder)
    junit.render(run)
    json.dumps([data.first(run, "x"), *(data.of_case(run, case) for case in summary.cases(run))], allow_nan=False)
    output = io.StringIO()
    with contextlib.redirect_stdout(LogSafe(output)):  # pyright: ignore[reportArgumentType]
        report.show_tables(run)
    assert not re.search(r"^\s*::|##\[", output.getvalue(), re.MULTILINE)


def _command(path: Path, rng: random.Random) -> None:
    """A command line with a hostile word in it."""
    from southwell.reports.cli import app

    lines = (
        "modes {path} --omega 1,2 --modes 2 --elements 5",
        "modes park-cantilever --rpm 0:10:5 --modes 2 --elements 5 --json",
        "mechanism hinged-blade --modes 2 --time 0.5",
        "show {path} --all",
        "modes {path} --precone 2 --pitch 3 --hub-radius 1 --modes 2 --elements 4",
        "campbell {path} --rpm 0,10 --modes 2 --elements 4 --per-rev 1:3 --margin 5 --azimuth 10 --operating 2:8 --out {out}",
        "gate {results} --against {results} --tolerance 1e-6 --annotations",
        "history list {history}",
        "convert {path}/plain {out}/x.toml --to toml --rpm 3",
        "verify park-cantilever --codes nothing --workers 1 --add rig={rig} --out {out}",
        "condense {condense} --omega 1,2 --modes 2 --out {out}",
        "report {out} --html",
        "cases park-cantilever",
    )
    folder = path.parent
    beside = {name: folder / FIRST[name] for name in ("results", "history", "rig", "condense")}
    words = rng.choice(lines).format(path=path, out=folder / "out", **beside).split()
    for _ in range(rng.choice((1, 1, 2))):
        k = rng.randrange(1, len(words))
        word = "".join(c for c in rng.choice(HOSTILE) if c != "\0")[:100_000]
        words[k : k + rng.choice((0, 1, 1, 1))] = [
            rng.choice((word, words[k] + word, word + words[k], f"{words[k]},{word}"))
        ]
    out, err, status = io.StringIO(), io.StringIO(), None
    with contextlib.chdir(folder), contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            app.main(words)
        except SystemExit as ended:
            status = ended.code
    assert status in (0, 1, 2), f"status {status}: {str(words)[:LONGEST_LINE]}"
    message = [line for line in err.getvalue().splitlines() if line]
    assert "Traceback" not in err.getvalue()
    if status == 2:
        assert message, f"nothing is said of {str(words)[:LONGEST_LINE]}"
        assert len(message[-1]) < LONGEST_LINE, f"{len(message[-1])} characters: {message[-1][:LONGEST_LINE]}"


def trial(seed: int, number: int, folder: Path) -> tuple[str, str]:
    """Run one trial: what kind it was of, and what is wrong; empty if nothing is.

    ``folder`` has ``seeds`` in it; it is as before afterwards, but for what commands wrote to ``out``.
    """
    from southwell.cases.input import files
    from southwell.cases.input.errors import CaseError
    from southwell.core.condense.exported import MatrixFileError
    from southwell.reports.cli.errors import IncompleteError

    rng = random.Random(f"{seed}/{number}")
    kind = rng.choice(list(FIRST))
    first = folder / FIRST[kind]
    victim = folder / rng.choice((FIRST[kind], *BESIDE.get(kind, ())))
    content = victim.read_bytes()
    if kind != "arguments":
        victim.write_bytes(mutated(content, rng))
    timers = ((signal.SIGPROF, signal.ITIMER_PROF, SECONDS), (signal.SIGALRM, signal.ITIMER_REAL, WAITING))
    before = [signal.signal(number, _slow) for number, _, _ in timers]
    for _, timer, seconds in timers:
        signal.setitimer(timer, seconds)
    try:
        with files.reading(first):
            take(kind, first, rng)
        return kind, ""
    except (CaseError, MatrixFileError, IncompleteError) as error:
        message = str(error)
        return kind, "" if "\n" not in message.strip() and len(
            message
        ) < LONGEST_LINE else f"message: {message[:300]!r}"
    except SlowError:
        return kind, f"more than {SECONDS:g} s"
    except Exception:
        return kind, traceback.format_exc(limit=-6)
    finally:
        for (number, timer, _), handler in zip(timers, before, strict=True):
            signal.setitimer(timer, 0)
            signal.signal(number, handler)
        victim.write_bytes(content)
        shutil.rmtree(folder / "out", ignore_errors=True)


def _slow(signal_number: int, frame: FrameType | None) -> None:
    raise SlowError


def batch(seed: int, first: int, last: int, progress: Path) -> None:
    """Trials ``first`` to ``last`` (left out), in this process; each is named in ``progress`` before it begins."""
    resource.setrlimit(resource.RLIMIT_AS, (8 * MEMORY, 8 * MEMORY))
    with tempfile.TemporaryDirectory() as name, progress.open("ab", buffering=0) as log:
        folder = Path(name)
        seeds(folder)
        peak = 0
        for number in range(first, last):
            log.write(msgspec.json.encode({"begins": number}) + b"\n")
            began = time.monotonic()
            kind, altered = trial(seed, number, folder)
            most = 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
            if not altered and most > MEMORY and most > peak:
                altered = f"{most >> 20} MB"
            peak = max(peak, most)
            spent = time.monotonic() - began
            log.write(msgspec.json.encode({"number": number, "kind": kind, "wrong": altered, "seconds": spent}) + b"\n")


def run(count: int, seed: int, first: int = 0) -> list[dict]:
    """Trials ``first`` to ``count`` (left out), in processes; rows of ``batch``, those that killed the process among them."""
    rows: list[dict] = []
    while first < count:
        last = min(first + BATCH, count)
        with tempfile.TemporaryDirectory() as name:
            progress = Path(name) / "progress"
            command = [sys.executable, __file__, "--batch", str(first), str(last), str(progress), "--seed", str(seed)]
            try:
                process = subprocess.run(
                    command, timeout=60 + BATCH * SECONDS / 5, stdin=subprocess.DEVNULL, check=False
                )
                ended = f"process ended with {process.returncode}"
            except subprocess.TimeoutExpired:
                ended = "hang"
            result = [json.loads(line) for line in progress.read_bytes().splitlines()] if progress.exists() else []
        new = [row for row in result if "number" in row]
        if not result:
            raise RuntimeError(f"no trial was begun: {ended}")
        if "begins" in result[-1]:
            new.append({"number": result[-1]["begins"], "kind": "?", "wrong": ended, "seconds": 0.0})
            first = result[-1]["begins"] + 1
        else:
            first = result[-1]["number"] + 1
        rows += new
        for row in (r for r in new if r["wrong"]):
            print(f"--- seed {seed}, trial {row['number']}, {row['kind']}\n{row['wrong']}")
        print(f"{first} of {count}: {sum(bool(r['wrong']) for r in rows)} wrong", flush=True)
    return rows


def main() -> int:
    """The command."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("count", type=int, nargs="?", default=10_000)
    parser.add_argument("--seed", type=int)
    parser.add_argument("--first", type=int, default=0, help="number of the first trial")
    parser.add_argument("--batch", nargs=3, help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.batch:
        batch(given.seed, int(given.batch[0]), int(given.batch[1]), Path(given.batch[2]))
        return 0
    seed = random.SystemRandom().randrange(2**32) if given.seed is None else given.seed
    print(f"seed {seed}", flush=True)
    rows = run(given.count, seed, given.first)
    slowest = max(rows, key=lambda r: r["seconds"])
    print(
        f"seed {seed}: {len(rows)} trials, {sum(bool(r['wrong']) for r in rows)} wrong; by kind:",
        dict(Counter(r["kind"] for r in rows)),
    )
    print(f"slowest: trial {slowest['number']} ({slowest['kind']}), {slowest['seconds']:.1f} s")
    return int(any(r["wrong"] for r in rows))


if __name__ == "__main__":
    sys.exit(main())
