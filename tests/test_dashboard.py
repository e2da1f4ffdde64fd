"""The dashboard: what it shows is what the rows say, in a real browser, by mouse and by keyboard; hostile names stay text."""

import json
import re
import shutil
from collections.abc import Iterator
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest

from southwell.cases import history, results
from southwell.cases.results import Run
from southwell.reports import cli, readme
from southwell.reports.dashboard.data import page
from southwell.reports.dashboard.steps import frequency_steps, timing_steps
from southwell.reports.dashboard.write import write

BROWSER = next(
    (path for name in ("chromium", "chromium-browser", "google-chrome") if (path := shutil.which(name))), None
)
needs_browser = pytest.mark.skipif(
    BROWSER is None or find_spec("playwright") is None, reason="needs Chromium (Debian: apt install chromium), and: pip install playwright"
)
HOSTILE = '<img src=x onerror="document.title=1">/</script><script>document.title=2</script>'


def run() -> Run:
    return results.read(readme.ROWS)


def hostile() -> Run:
    """The README's rows, one case of theirs under a name that would do harm if it were markup."""
    plain = run()
    name = plain.cells[0].case
    return replace(
        plain,
        cells=tuple(
            replace(c, case=HOSTILE, reason=HOSTILE) if c.case == name else replace(c, seconds=0.5) for c in plain.cells
        ),
        settings=tuple(replace(s, case=HOSTILE, title=HOSTILE) if s.case == name else s for s in plain.settings),
    )


def kept(file: Path) -> Path:
    """A history of seven runs: a frequency moves at the fifth; a cell is gone in the last; the last line is torn."""
    first = run()
    for k in range(7):
        cells = first.cells[:-1] if k == 6 else first.cells
        moved = tuple(
            replace(c, frequency=c.frequency * (1 + 1e-6)) if k >= 4 and n == 5 and c.frequency else c
            for n, c in enumerate(_with_numbers(cells))
        )
        history.append(file, history.entry(replace(first, cells=moved), f"commit{k}", machine="a machine"))
    with file.open("ab") as out:
        out.write(b'{"commit":"to')
    return file


def _with_numbers(cells: Any) -> list[Any]:
    return [c for c in cells if c.frequency is not None]


def data(path: Path) -> Any:
    text = path.read_text(encoding="utf-8")
    found = re.search(r'<script type="application/json" id="data">(.*?)</script>', text, re.S)
    assert found
    return json.loads(found[1])


def test_every_cell_is_there_and_the_first_page_is_small(tmp_path: Path) -> None:
    path = write({"a run": run()}, None, tmp_path)
    first = data(path)
    assert len(first["cells"]) == len(run().cells)
    assert (
        sum((tmp_path / name).stat().st_size for name in ("index.html", "dashboard.js", "charts.js", "dashboard.css"))
        < 1.5e6
    )
    assert {c["page"] for c in first["cases"]} == {p.name for p in tmp_path.glob("case-*.html")}
    worst = max((c for c in run().cells if c.verdict == "known difference"), key=lambda c: abs(c.difference or 0.0))
    assert any(
        c[0] == [x["name"] for x in first["cases"]].index(worst.case) and worst.reason == c[7] for c in first["cells"]
    )


def test_nothing_is_fetched_from_anywhere(tmp_path: Path) -> None:
    write({"a run": run()}, history.read(kept(tmp_path / "h.jsonl")), tmp_path / "site")
    for file in (tmp_path / "site").rglob("*"):
        if file.suffix in (".html", ".js", ".css"):
            text = re.sub(r'(?s)<script type="application/json".*?</script>', "", file.read_text(encoding="utf-8"))
            assert set(re.findall(r"https?://[^\"' ]+", text)) <= {"http://www.w3.org/2000/svg"}


def test_page_names_are_files_whatever_the_case_is_called() -> None:
    assert page("park-blade/windpact") == "case-park-blade_2f_windpact.html"
    assert re.fullmatch(r"case-[\w.-]+\.html", page(HOSTILE))
    assert page("a/b") != page("a_b") != page("a_2f_b")


def test_steps_of_frequencies_are_moves_beyond_rounding() -> None:
    assert frequency_steps([1.0, 1.0 + 1e-12, None, 1.0 + 2e-9, 1.0 + 2e-9]) == [3]


def test_steps_of_timings_are_levels_not_points() -> None:
    noisy = [1.0, 1.1, 0.95, 1.05, 1.02, 5.0, 0.98, 1.04, 1.0, 1.1]
    assert timing_steps(noisy) == []
    assert timing_steps([*noisy, 2.0, 2.1, 1.95, 2.05]) == [10]
    assert timing_steps([1.0, 2.0]) == []


def test_the_command_writes_it_and_bad_input_is_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "run"
    folder.mkdir()
    shutil.copy(readme.ROWS, folder / "results.jsonl")

    def southwell(*words: str) -> tuple[int, str, str]:
        with pytest.raises(SystemExit) as ended:
            cli.main(["dashboard", *words])
        out, err = capsys.readouterr()
        return int(ended.value.code or 0), out, err

    status, out, err = southwell(
        str(folder), "--history", str(kept(tmp_path / "h.jsonl")), "--out", str(tmp_path / "site")
    )
    assert (status, out.strip()) == (0, str(tmp_path / "site" / "index.html"))
    assert "line 8: cut short" in err
    for words in ([], [str(tmp_path / "nowhere")], [str(folder), "--history", str(tmp_path / "none.jsonl")]):
        status, out, err = southwell(*words, "--out", str(tmp_path / "other"))
        assert (status, out, err.count("\n")) == (2, "", 1)


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("site")
    return write({"now": hostile(), "before": run()}, history.read(kept(folder / "h.jsonl")), folder).parent


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        open_ = playwright.chromium.launch(executable_path=BROWSER, args=["--no-sandbox"])
        yield open_
        open_.close()


@pytest.fixture
def tab(browser: Any) -> Iterator[Any]:
    """A page whose console must stay silent."""
    found = browser.new_page(viewport={"width": 1280, "height": 900})
    said: list[str] = []
    found.on("console", lambda m: said.append(m.text) if m.type in ("error", "warning") else None)
    found.on("pageerror", lambda e: said.append(str(e)))
    yield found
    found.close()
    assert said == []


@needs_browser
def test_every_page_opens_from_the_file_system(tab: Any, site: Path) -> None:
    pages = sorted(site.rglob("*.html"))
    assert len(pages) > 20
    for path in pages:
        tab.goto(path.as_uri())
        assert tab.locator("h1").count() == 1
        assert tab.title() not in ("1", "2")


@needs_browser
def test_a_hostile_name_is_text(tab: Any, site: Path) -> None:
    tab.goto((site / "index.html").as_uri())
    assert tab.locator("main img").count() == 0
    assert tab.locator("table.matrix tbody th").first.inner_text() == HOSTILE
    tab.goto((site / page(HOSTILE)).as_uri())
    assert tab.locator("h1").inner_text() == HOSTILE
    assert tab.locator("main img").count() == 0


@needs_browser
def test_filters_by_mouse(tab: Any, site: Path) -> None:
    tab.goto((site / "index.html").as_uri())
    rows = tab.locator("table.matrix tbody tr").count()
    tab.select_option("select[name=code]", "exudyn-ancf")
    assert tab.locator("table.matrix thead th").count() == 2
    tab.select_option("select[name=verdict]", label="✔ pass")
    assert 1 < tab.locator("table.matrix tbody tr").count() < rows
    assert tab.locator("table.matrix td.v5").count() == 0
    tab.select_option("select[name=code]", "")
    tab.select_option("select[name=family]", "flapwise")
    tab.select_option("select[name=speed]", "rest")
    tab.locator("table.matrix td.v3").first.hover()
    assert "flapwise" in tab.locator("#detail").inner_text()
    assert "at rest" in tab.locator("#detail").inner_text()
    tab.select_option("select[name=verdict]", label="✘ fail")
    assert "No cell is of this kind" in tab.locator("main").inner_text()


@needs_browser
def test_fields_by_keyboard(tab: Any, site: Path) -> None:
    tab.goto((site / "index.html").as_uri())
    fields = tab.locator("table.matrix td[tabindex='0']")
    assert fields.count() == 1
    fields.focus()
    before = tab.evaluate("document.activeElement.getAttribute('aria-label')")
    tab.keyboard.press("ArrowDown")
    tab.keyboard.press("ArrowRight")
    after = tab.evaluate("document.activeElement.getAttribute('aria-label')")
    assert after
    assert before != after
    assert after.split(",")[0] in tab.locator("#detail").inner_text()
    tab.keyboard.press("Enter")
    tab.wait_for_url(re.compile(r"/case-.*\.html$"))


@needs_browser
def test_a_case_page(tab: Any, site: Path) -> None:
    tab.goto((site / page("park-cantilever")).as_uri())
    diagram = tab.locator("svg[aria-label='Campbell diagram']")
    lines = diagram.locator("polyline").count()
    tab.get_by_role("button", name="6P").click()
    assert diagram.locator("polyline").count() == lines + 1
    assert tab.get_by_role("button", name="6P").get_attribute("aria-pressed") == "true"
    tab.get_by_role("button", name="6P").press("Enter")
    assert diagram.locator("polyline").count() == lines
    play = tab.get_by_role("button", name="play")
    still = play.get_attribute("aria-pressed")
    play.click()
    assert play.get_attribute("aria-pressed") != still
    shapes = tab.locator("select[name=shape] option")
    assert shapes.count() == 6
    tab.select_option("select[name=shape]", "2")
    tab.select_option("select[name=speed]", label="10 rad/s")
    assert tab.locator("#differences tbody tr").count() > 30
    assert tab.locator("#timing tbody tr").count() > 3


@needs_browser
def test_the_history(tab: Any, site: Path) -> None:
    tab.goto((site / "history.html").as_uri())
    assert "lines cut short and left out: 8" in tab.locator("main").inner_text()
    assert tab.locator("#runs tbody tr").count() == 7
    steps = tab.locator("#steps tbody tr").all_inner_texts()
    assert len([s for s in steps if "frequency" in s]) == 1
    assert "commit4" in steps[0]
    assert "absent" in tab.locator("#moved").inner_text()  # from the sixth to the seventh
    tab.select_option("select[name=from]", "3")
    tab.select_option("select[name=to]", "4")
    assert "1.00e-6" in tab.locator("#moved").inner_text()
    tab.select_option("select[name=from]", "0")
    tab.select_option("select[name=to]", "1")
    assert "No frequency moved" in tab.locator("#moved").inner_text()


@needs_browser
@pytest.mark.parametrize("name", ["index.html", page("park-cantilever"), "codes.html", "history.html"])
def test_on_a_phone_only_tables_scroll_sideways(browser: Any, site: Path, name: str) -> None:
    phone = browser.new_page(viewport={"width": 390, "height": 844})
    phone.goto((site / name).as_uri())
    assert phone.evaluate("document.documentElement.scrollWidth") <= 390
    phone.close()
