"""The dashboard's files: what they hold is what the rows say; nothing is fetched; the history's steps and who made them."""

import json
import re
from dataclasses import replace
from importlib.resources import files
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from southwell.cases.input import library
from southwell.cases.judge.results import Run, described
from southwell.cases.regression import history
from southwell.cases.store import results_file
from southwell.core.blade import Blade
from southwell.reports.cli import app as cli
from southwell.reports.dashboard import moving as shapes
from southwell.reports.dashboard.data import codes, headline, of_case, page
from southwell.reports.dashboard.moving import moving
from southwell.reports.dashboard.past import CORE, moves, of_history, steps
from southwell.reports.dashboard.write import SCRIPTS, write
from southwell.reports.shared.units import RAD_S
from southwell.reports.site import readme

from ...support import samples
from ...support.dashboards import HOSTILE, LOST, WORSE, hostile, kept, run

LARGEST_FIRST_PAGE = 1.5e6


def data(path: Path) -> Any:
    text = path.read_text(encoding="utf-8")
    element = re.search(r'<script type="application/json" id="data">(.*?)</script>', text, re.S)
    assert element
    return json.loads(element[1])


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The dashboard of a run, with a history."""
    folder = tmp_path_factory.mktemp("site")
    past = history.read(kept(tmp_path_factory.mktemp("history") / "h.jsonl"))
    return write({"a run": run()}, past, folder).parent


@pytest.mark.slow
def test_every_cell_is_included_and_the_first_page_is_small(site: Path) -> None:
    first = data(site / "index.html")
    rows = run().cells
    assert len(first["cells"]) == len(rows)
    needed = ("index.html", "dashboard.css", *SCRIPTS["matrix"])
    assert sum((site / name).stat().st_size for name in needed) < LARGEST_FIRST_PAGE
    assert {c["page"] for c in first["cases"]} == {p.name for p in site.glob("case-*.html")}
    assert {c["page"] for c in first["columns"] if c["page"]} == {p.name for p in site.glob("code-*.html")}
    for cell, row in zip(first["cells"], rows, strict=True):
        assert first["cases"][cell[0]]["name"] == row.case
        assert first["verdicts"][cell[4]]["name"] == row.verdict
        assert cell[7] == row.reason


@pytest.mark.slow
def test_the_worst_cell_of_many_is_the_worst_of_the_readmes(site: Path) -> None:
    """The table of all results, written by other code, against what a code's page says."""
    worst = {case: text for case, *_, text, _, _ in data(site / page("southwell-equation", "code"))["worst"]}
    row = next(line for line in readme.results_page().splitlines() if line.startswith("| tip-mass "))
    assert worst["tip-mass"].split(" ± ")[0].lstrip("+−") in row


def test_a_small_failure_is_named_before_large_known_differences() -> None:
    cells = list(run().cells)
    k = next(k for k, c in enumerate(cells) if (c.case, c.code, c.verdict) == ("park-cantilever", "pybmodes", "pass"))
    cells[k] = replace(cells[k], verdict="fail", difference=1.2e-3, uncertainty=1e-6)
    failing = replace(run(), cells=tuple(cells))
    answer, worst, *_ = headline(failing)
    assert answer.startswith("No: 1 answer contradicts Southwell's own solver.")
    assert worst.startswith("Worst failure: +0.120 % ± 0.0001 % (park-cantilever, pybmodes, ")
    pybmodes = next(c for c in codes(failing) if c["name"] == "pybmodes")
    assert pybmodes["worst"] == [0, "+0.120 % ± 0.0001 %", "park-cantilever"]
    assert pybmodes["known"][0] == 2
    case = of_case(failing, "park-cantilever")
    assert case["answer"] == "No: 1 answer contradicts Southwell's own solver."
    assert (case["verdict_counts"][0]["verdict"], case["verdict_counts"][0]["count"]) == (0, 1)


DEUTERANOPE = np.array([[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.01182, 0.04294, 0.968881]])
PROTANOPE = np.array(
    [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]]
)
"""Of linear RGB: Machado, Oliveira and Fernandes 2009, severity 1."""


def palettes() -> list[dict[str, Any]]:
    """Linear RGB of the style's colours, by light and by night."""
    style = files("southwell.reports.dashboard").joinpath("templates", "dashboard.css").read_text(encoding="utf-8")
    out = []
    for block in re.findall(r":root \{(.*?)\}", style, re.S):
        colours = dict(re.findall(r"--(\w+):(#\w+)", block))
        full = {k: v if len(v) == 7 else "#" + "".join(2 * c for c in v[1:]) for k, v in colours.items()}
        rgb = {k: np.array([int(v[i : i + 2], 16) / 255 for i in (1, 3, 5)]) for k, v in full.items()}
        out.append({k: np.where(v <= 0.04045, v / 12.92, ((v + 0.055) / 1.055) ** 2.4) for k, v in rgb.items()})
    return out


def lab(rgb: Any) -> Any:
    """CIE 1976 L*a*b* of linear sRGB, D65."""
    xyz = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]]) @ np.clip(rgb, 0, 1)
    x, y, z = np.cbrt(xyz / [0.9505, 1.0, 1.089])
    return np.array([116 * y - 16, 500 * (x - y), 200 * (y - z)])


def test_verdicts_colours_are_told_apart_by_the_colour_blind_and_text_on_them_is_read() -> None:
    light, dark = palettes()
    for palette in (light, dark):
        for sight in (np.eye(3), DEUTERANOPE, PROTANOPE):
            observed = {k: lab(sight @ palette[k]) for k in ("pass", "known", "open", "fail", "none")}
            for a, b in combinations(observed, 2):
                assert np.linalg.norm(observed[a] - observed[b]) > 8, (a, b)
        luminance = {k: float(v @ [0.2126, 0.7152, 0.0722]) for k, v in palette.items()}
        for ink, on in (
            [("ink", v) for v in ("paper", "soft", "pass", "known", "open", "fail", "none")]
            + [("muted", v) for v in ("paper", "soft", "none")]
            + [("link", "paper"), ("link", "soft")]
        ):
            bright, dim = sorted((luminance[ink], luminance[on]), reverse=True)
            assert (bright + 0.05) / (dim + 0.05) > 4.5, (ink, on)  # WCAG 2, AA


def test_cores_lines_are_cores_where_a_code_gives_another_mode_the_same_name() -> None:
    """A code that leaves effects out is compared with core without them, whose first mode is core's second."""
    cells = (
        *(samples.cell(omega=w, value=f, reference=f, full=f) for w, f in ((0.0, 10.0), (10.0, 12.0))),
        *(samples.cell(omega=w, mode=2, family="axial", full=f, reference=f) for w, f in ((0.0, 60.0), (10.0, 61.0))),
        samples.cell(omega=10.0, code="odd", value=55.0, reference=55.0, full=61.0, verdict="known difference"),
    )
    lines = of_case(Run(cells), "beam")["lines"]
    assert lines == [
        {"name": "edgewise 1", "points": [[0.0, 10.0], [10.0, 12.0]]},
        {"name": "axial 1", "points": [[0.0, 60.0], [10.0, 61.0]]},
    ]


@pytest.mark.slow
def test_pages_load_nothing_from_the_network(site: Path) -> None:
    for file in site.rglob("*"):
        if file.suffix in (".html", ".js", ".css"):
            text = re.sub(r'(?s)<script type="application/json".*?</script>', "", file.read_text(encoding="utf-8"))
            assert set(re.findall(r"https?://[^\"' ]+", text)) <= {"http://www.w3.org/2000/svg"}
            for name in re.findall(r'(?:src|href)="(?!data:)([^"]+)"', text):
                assert (file.parent / name).is_file()


@pytest.mark.slow
def test_no_text_of_a_case_is_markup(tmp_path: Path) -> None:
    cells = tuple(c for c in hostile().cells if HOSTILE in (c.case, c.reason) or WORSE in (c.code, c.reason))
    write({HOSTILE: replace(hostile(), cells=cells)}, None, tmp_path)
    for file in tmp_path.glob("*.html"):
        text = file.read_text(encoding="utf-8")
        assert "<img" not in text
        assert "<!--" not in text
        assert text.count("<script") == text.count("</script>") <= 1 + len(SCRIPTS["case"])
    assert data(tmp_path / page(HOSTILE))["name"] == HOSTILE


def test_page_names_are_files_whatever_the_case_is_called() -> None:
    assert page("park-cantilever") == "case-park-cantilever.html"
    assert page("pybmodes", "code") == "code-pybmodes.html"
    names = ["a/b", "a_b", "A/b", "a-b", HOSTILE, WORSE, "é" * 300, "é" * 301, "../../x"]
    pages = [page(name) for name in names]
    assert len({p.lower() for p in pages}) == len(names)
    assert all(re.fullmatch(r"case-[a-z0-9_.-]{1,100}\.html", p) for p in pages)


def test_animated_shapes_are_those_of_the_beam() -> None:
    """A cantilever at rest: φ(½)/φ(1) = 0.33952, and the second mode's node lies at 0.7834 (Young and Felgar 1949)."""
    cells = [c for c in run().cells if c.case == "park-cantilever" and c.omega == 0.0]
    shapes_of_beam = moving("park-cantilever", cells, RAD_S)
    assert shapes_of_beam
    at_rest = shapes_of_beam["speeds"][0]["modes"]
    flap = {m["name"]: np.array(m["re"])[:, 2] + 1j * np.array(m["im"])[:, 2] for m in at_rest}
    assert abs(flap["flapwise 1"][10] / flap["flapwise 1"][20]) == pytest.approx(0.33952, abs=2e-4)
    second = (flap["flapwise 2"] / flap["flapwise 2"][20]).real
    node = np.interp(0.0, second[12:], np.linspace(0, 1, 21)[12:])
    assert node == pytest.approx(0.7834, abs=2e-3)
    other = [replace(c, full=None if c.full is None else 1.5 * c.full) for c in cells]
    assert moving("park-cantilever", other, RAD_S) is None
    assert moving(HOSTILE, cells, RAD_S) is None


def test_a_rotor_without_a_steady_state_has_no_shapes(monkeypatch: pytest.MonkeyPatch) -> None:
    (blade,) = (v.blade for v in library.load("park-cantilever").variants)
    soft = replace(blade, stiffness=1e-9 * blade.stiffness)

    def unsteady(case: str) -> Blade:
        return soft

    monkeypatch.setattr(shapes, "_blade", unsteady)
    cells = [c for c in run().cells if c.case == "park-cantilever" and c.omega == 30.0]
    output = moving("park-cantilever", [replace(c, full=None) for c in cells], RAD_S)
    assert output is not None
    assert output["speeds"] == []


def test_steps_are_moves_beyond_rounding() -> None:
    """Of a frequency by a fraction of itself, of a damping ratio by a fraction of critical damping."""
    assert steps([1.0, 1.0 + 1e-12, None, 1.0 + 2e-9, 1.0 + 2e-9]) == [3]
    assert steps([1e-3, 1e-3 + 2e-12, 1e-3 + 2e-9]) == [1, 2]
    assert steps([1e-3, 1e-3 + 2e-12, 1e-3 + 2e-9], "damping") == [2]


def test_the_history_has_damping_ratios() -> None:
    """A code's ratio moves from 0.02 to 0.021, core's stays at 0.0205; the frequency of the same mode does not move."""
    ratio = samples.cell(quantity="damping", value=0.02, reference=0.0205, difference=-0.0005, full=None)
    runs = [Run((samples.cell(), c)) for c in (ratio, replace(ratio, value=0.021, difference=0.0005))]
    past = of_history(history.History(tuple(history.entry(r, f"commit{k}") for k, r in enumerate(runs))))
    frequency, damping = past["cells"]
    assert (frequency[5], frequency[8:]) == (samples.cell().value, ["", False])
    assert damping[5:7] == [[0.02, 0.021], [-0.0005, 0.0005]]
    assert damping[8:] == ["damping", True]
    (step,) = past["steps"]
    assert (step["run"], step["who"], step["numbers"], step["what"]) == (1, "alpha", "1 damping ratio", "damping")
    assert step["change"] == pytest.approx(0.001)


def test_a_change_is_attributed_to_code_or_solver(tmp_path: Path) -> None:
    changes = moves(history.read(kept(tmp_path / "h.jsonl")).entries)
    assert {(m["run"], m["who"], m["case"]) for m in changes} == {
        (4, "scikit-fem", "tip-mass"),
        (5, CORE, "wright-flapwise"),
    }
    assert [m["change"] for m in changes] == [pytest.approx(1e-6, rel=1e-6), pytest.approx(1e-5, rel=1e-6)]
    wright = {(c.omega, c.mode) for c in run().cells if c.case == "wright-flapwise" and c.value}
    assert next(m["count"] for m in changes if m["who"] == CORE) == len(wright)


def test_every_number_is_in_the_history(tmp_path: Path) -> None:
    rows = of_history(history.read(kept(tmp_path / "h.jsonl")))["cells"]
    by_key = {(*r[:4], r[8]): r for r in rows}
    assert set(by_key) == {(c.case, c.code, c.omega, c.mode, described("", c.quantity, c.where)) for c in run().cells}
    for c in run().cells:
        row = by_key[c.case, c.code, c.omega, c.mode, described("", c.quantity, c.where)]
        frequencies, verdicts = row[5], row[7]
        if c.code == LOST:
            assert verdicts[6] is None
        elif (c.case, c.code) != ("tip-mass", "scikit-fem"):
            assert frequencies == c.value


@pytest.mark.slow
def test_the_command_writes_the_site_and_reports_invalid_input(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "run"
    folder.mkdir()
    results_file.write(folder / "results.jsonl", replace(samples.run(), plan=()))

    def southwell(*words: str) -> tuple[int, str, str]:
        with pytest.raises(SystemExit) as exit_info:
            cli.main(["dashboard", *words])
        out, err = capsys.readouterr()
        return int(exit_info.value.code or 0), out, err

    status, out, err = southwell(
        str(folder), "--history", str(kept(tmp_path / "h.jsonl")), "--out", str(tmp_path / "site")
    )
    assert (status, out.strip()) == (0, str(tmp_path / "site" / "index.html"))
    assert "line 8: truncated" in err
    for words in ([], [str(tmp_path / "nowhere")], [str(folder), "--history", str(tmp_path / "none.jsonl")]):
        status, out, err = southwell(*words, "--out", str(tmp_path / "other"))
        assert (status, out, err.count("\n")) == (2, "", 1)
