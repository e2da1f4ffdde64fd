"""The dashboard in a real browser, from the file system: by mouse and by keyboard, wide and narrow; hostile names stay text."""

import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from southwell.cases.judge.results import Control
from southwell.cases.regression import history
from southwell.reports.dashboard.data import page
from southwell.reports.dashboard.write import write
from southwell.reports.shared.summary import plus_minus

from ...support import browsers, samples
from ...support.dashboards import ABSENT, HOSTILE, LOST, WORSE, hostile, kept, run

pytestmark = [browsers.needed, pytest.mark.slow]


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("site")
    return write({HOSTILE: hostile(), "before": run()}, history.read(kept(folder / "h.jsonl")), folder).parent


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with browsers.browser() as running:
        yield running


@pytest.fixture
def tab(browser: Any) -> Iterator[Any]:
    with browsers.tab(browser) as page:
        yield page


@pytest.mark.parametrize("step", [5, pytest.param(1, marks=pytest.mark.nightly)])
def test_pages_open_and_every_link_leads_somewhere(tab: Any, site: Path, step: int) -> None:
    """Every fifth page, and every night all of them."""
    pages = [*sorted(site.glob("*.html")), *(site / "run-2" / name for name in ("index.html", "codes.html"))]
    assert len(pages) > 20
    for path in pages[::step]:
        tab.goto(path.as_uri())
        assert tab.locator("h1").count() == 1
        assert tab.title() != "2"
        links = tab.eval_on_selector_all("a", "all => all.map(a => a.getAttribute('href'))")
        assert all((path.parent / name).is_file() for name in links)


def test_a_hostile_name_is_text(tab: Any, site: Path) -> None:
    tab.goto((site / "index.html").as_uri())
    assert tab.locator("table.matrix tbody th").first.inner_text() == HOSTILE
    assert WORSE in tab.locator("table.matrix thead th").all_inner_texts()
    for path in (site / page(HOSTILE), site / page(WORSE, "code"), site / "history.html"):
        tab.goto(path.as_uri())
        assert tab.locator("img").count() == 0
        assert HOSTILE in tab.locator("main").inner_text()


def test_a_fields_sign_and_value_are_those_of_its_worst_cell(tab: Any, site: Path) -> None:
    tab.goto((site / "run-2" / "index.html").as_uri())
    heads = tab.locator("table.matrix thead th").all_inner_texts()
    row = tab.locator("table.matrix tbody tr").filter(has=tab.locator("th", has_text=re.compile("^park-cantilever$")))
    fields = dict(zip(heads, row.locator("th, td").all_inner_texts(), strict=True))
    cells = [c for c in run().cells if (c.case, c.code) == ("park-cantilever", "pybmodes")]
    assert {c.verdict for c in cells} == {"known difference", "pass"}
    worst = max(abs(c.value / c.full - 1) for c in cells if c.verdict == "known difference" and c.value and c.full)
    assert fields["pybmodes"].split("\n") == ["≈", f"+{100 * worst:.3f} %"]
    assert fields[ABSENT].startswith("○")


def test_filters_by_mouse(tab: Any, site: Path) -> None:
    tab.goto((site / "index.html").as_uri())
    rows = tab.locator("table.matrix tbody tr").count()
    tab.select_option("select[name=code]", "exudyn-ancf")
    assert tab.locator("table.matrix thead th").all_inner_texts() == ["case", "exudyn-ancf"]
    tab.select_option("select[name=verdict]", label="✔ pass")
    assert 1 < tab.locator("table.matrix tbody tr").count() < rows
    assert tab.locator("table.matrix td.v5").count() == 0
    tab.select_option("select[name=code]", "")
    tab.select_option("select[name=family]", "flapwise")
    tab.select_option("select[name=speed]", "at rest")
    tab.locator("table.matrix td.v3").first.hover()
    assert "flapwise" in tab.locator("#detail").inner_text()
    assert "at rest" in tab.locator("#detail").inner_text()
    tab.select_option("select[name=verdict]", label="✘ fail")
    assert "No cell is of this kind" in tab.locator("main").inner_text()
    tab.get_by_role("button", name="show all").click()
    assert tab.locator("table.matrix tbody tr").count() == rows


def test_a_filter_by_speed_is_kept_after_reload(tab: Any, site: Path) -> None:
    tab.goto((site / "index.html").as_uri())
    tab.locator("select[name=speed]").focus()
    tab.keyboard.type("10 rad")
    tab.keyboard.press("Enter")
    output = tab.locator("table.matrix tbody tr").count()
    turning = {c.case for c in hostile().cells if c.omega == 10.0 and _speeds_in_rad(c.case)}
    assert output == len(turning) + 1  # and what codes share
    tab.reload()
    assert tab.locator("select[name=speed]").input_value() == "10 rad/s"
    assert tab.locator("table.matrix tbody tr").count() == output


def _speeds_in_rad(case: str) -> bool:
    return next(s.unit for s in hostile().settings if s.case == case) == "rad_s"


@pytest.mark.parametrize("name", ["code", "family", "speed", "verdict"])
def test_every_filter_by_keyboard(tab: Any, site: Path, name: str) -> None:
    tab.goto((site / "run-2" / "index.html").as_uri())
    before = tab.locator("table.matrix").inner_text()
    for _ in range(40):  # as far as the chooser, by Tab alone
        tab.keyboard.press("Tab")
        if tab.evaluate("document.activeElement.name") == name:
            break
    for key in ("ArrowDown", "ArrowDown", "ArrowDown"):
        tab.keyboard.press(key)
    chosen = tab.locator(f"select[name={name}]").input_value()
    assert chosen
    output = tab.locator("table.matrix")
    assert not output.count() or output.inner_text() != before
    assert f"{name}=" in tab.evaluate("location.hash")


def test_the_verdict_is_said_first(tab: Any, site: Path) -> None:
    tab.goto((site / "run-2" / "index.html").as_uri())
    first, worst, *_ = tab.locator("#headline p").all_inner_texts()
    assert first.startswith(f"Yes: nothing contradicts Southwell's own solver. {len(run().cells)} cells: ")
    message = re.fullmatch(
        r"Worst independent answer.*: ✔ (\S+ % ± \S+ %): (\S+), (\S+), (\w+ \d), (.+); target (\S+ %)\.", worst
    )
    assert message
    size, case, code, *_ = message.groups()
    assert any((c.case, c.code, plus_minus(c)) == (case, code, size) for c in run().cells)
    assert tab.locator("#headline").bounding_box()["y"] < 150
    tab.goto((site / "run-2" / page(case)).as_uri())
    assert size in tab.locator("#headline").inner_text()
    assert tab.locator("#headline").bounding_box()["y"] < 150


def test_wide_enough_only_the_matrix_scrolls_and_it_shows_that(tab: Any, site: Path) -> None:
    hidden = (
        "all => all.filter(b => b.offsetParent && b.scrollWidth > b.clientWidth + 1).map(b => b.firstChild.className)"
    )
    tab.set_viewport_size({"width": 1440, "height": 800})
    for name in ("codes.html", "history.html", page("park-cantilever"), page("nrel-5mw"), page("pybmodes", "code")):
        tab.goto((site / name if name == "history.html" else site / "run-2" / name).as_uri())
        assert tab.locator(".wide").evaluate_all(hidden) == [], name
    tab.goto((site / "run-2" / "index.html").as_uri())
    assert set(tab.locator(".wide").evaluate_all(hidden)) <= {"matrix"}
    tab.set_viewport_size({"width": 900, "height": 800})
    faded = tab.locator(".wide.more")
    assert faded.count() == 1
    faded.evaluate("box => { box.scrollLeft = box.scrollWidth }")
    faded.wait_for(state="detached")


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
    box = tab.locator("#detail").bounding_box()
    assert box["y"] + box["height"] <= 900, "details are in sight"
    assert fields.count() == 1
    tab.keyboard.press("Enter")
    tab.wait_for_url(re.compile(r"/case-.*\.html$"))


def test_campbell_diagram(tab: Any, site: Path) -> None:
    tab.goto((site / page("park-cantilever")).as_uri())
    diagram = tab.locator("svg[aria-label='Campbell diagram']")
    lines = diagram.locator("polyline").count()
    button = tab.get_by_role("button", name="6P")
    button.click()
    assert diagram.locator("polyline").count() == lines + 1
    assert diagram.locator("text", has_text="6P").count() == 1
    assert button.get_attribute("aria-pressed") == "true"
    button.press("Enter")
    assert diagram.locator("polyline").count() == lines
    points = diagram.locator("circle").count()
    tab.select_option("select[name=marks]", "pinocchio")
    own = [c for c in run().cells if (c.case, c.code) == ("park-cantilever", "pinocchio") and c.mode]
    assert diagram.locator("circle").count() == len(own) < points


def scale(chart: Any, across: bool) -> Any:
    """What a place in a chart means, from the places of the numbers along its axis: a linear axis."""
    texts = chart.locator("text").evaluate_all(
        "all => all.map(t => [t.textContent, +t.getAttribute('x'), +t.getAttribute('y'), t.getAttribute('text-anchor')])"
    )
    numbers = [t for t in texts if re.fullmatch(r"-?[\d.]+", t[0]) and (t[3] == "middle") == across]
    places, values = zip(*[(x if across else y - 4, float(text)) for text, x, y, _ in numbers], strict=True)
    slope, offset = np.polyfit(places, values, 1)
    return lambda place: slope * place + offset


def points(line: Any) -> Any:
    return np.array([[float(v) for v in p.split(",")] for p in line.get_attribute("points").split()])


@pytest.mark.parametrize(
    ("case", "hertz"),
    [("nrel-5mw", 1 / 60), ("park-cantilever", 1.0), ("yoo-shin-chordwise/delta-5", 1.0)],
    ids=["rpm and Hz", "rad/s", "without dimension"],
)
def test_a_ray_is_where_its_label_says(tab: Any, site: Path, case: str, hertz: float) -> None:
    tab.goto((site / "run-2" / page(case)).as_uri())
    diagram = tab.locator("svg[aria-label='Campbell diagram']")
    for n in (6, 12):
        tab.get_by_role("button", name=f"{n}P", exact=True).click()
    x, y = scale(diagram, True), scale(diagram, False)
    for n in (1, 2, 3, 6, 12):
        ray = diagram.locator("g").filter(has=tab.locator("title", has_text=re.compile(f"^{n}P$"))).locator("polyline")
        (x0, y0), (x1, y1) = points(ray)
        assert (y(y1) - y(y0)) / (x(x1) - x(x0)) == pytest.approx(n * hertz, rel=0.01)
        assert ray.locator("xpath=../*[name()='text']").inner_html() == f"{n}P"


def test_cores_line_passes_through_cores_frequencies(tab: Any, site: Path) -> None:
    tab.goto((site / page("park-cantilever")).as_uri())
    diagram = tab.locator("svg[aria-label='Campbell diagram']")
    x, y = scale(diagram, True), scale(diagram, False)
    cells = [c for c in run().cells if c.case == "park-cantilever" and c.reference == c.full and c.mode == 1]
    by_speed = {c.omega: c.full or 0.0 for c in cells}
    first = diagram.locator("g").filter(has=tab.locator("title", has_text=re.compile("^(edgewise|mode) 1$")))
    line = points(first.locator("polyline").first)
    speeds, frequencies = x(line[:, 0]), y(line[:, 1])
    for omega, f in by_speed.items():
        assert np.interp(omega, speeds, frequencies) == pytest.approx(f, abs=0.5)
    a, b = sorted(by_speed)[:2]
    between = np.sqrt((by_speed[a] ** 2 + by_speed[b] ** 2) / 2)  # at the mean of the squared speeds
    assert np.interp(np.sqrt((a * a + b * b) / 2), speeds, frequencies) == pytest.approx(between, abs=0.5)


def test_the_shape_along_the_blade_is_the_beams(tab: Any, site: Path) -> None:
    """A cantilever's second mode has its node at 0.7834 of its length (Young and Felgar 1949); the hub is 0.3 m of 6.3 m."""
    tab.goto((site / page("park-cantilever")).as_uri())
    tab.select_option("select[name=shape-speed]", label="at rest")
    second = tab.locator("select[name=shape] option", has_text="flapwise 2")
    tab.select_option("select[name=shape]", second.get_attribute("value"))
    drawing = tab.locator("svg[aria-label='Displacements along the blade']")
    x, y = scale(drawing, True), scale(drawing, False)
    line = points(drawing.locator("polyline"))
    along, moved = x(line[:, 0]), y(line[:, 1])
    assert moved[-1] == pytest.approx(1.0, abs=0.01)
    outer = along > 0.5
    assert np.interp(0.0, moved[outer], along[outer]) == pytest.approx((0.3 + 6 * 0.7834) / 6.3, abs=5e-3)


def test_the_animation_starts_and_stops(tab: Any, site: Path) -> None:
    tab.goto((site / page("park-cantilever")).as_uri())
    picture = "document.querySelector('canvas').toDataURL()"
    first = tab.evaluate(picture)
    tab.wait_for_function(f"{picture} !== arguments[0]".replace("arguments[0]", repr(first)))
    button = tab.get_by_role("button", name="move")
    button.press("Enter")
    assert button.get_attribute("aria-pressed") == "false"
    at_rest = tab.evaluate(picture)
    tab.wait_for_timeout(150)
    assert tab.evaluate(picture) == at_rest
    assert tab.locator("select[name=shape] option").count() == 6
    tab.select_option("select[name=shape]", "3")
    assert tab.evaluate(picture) != at_rest
    tab.select_option("select[name=shape-speed]", label="at rest")
    assert "10.549 rad/s" in tab.locator("select[name=shape] option").first.inner_text()


def test_reduced_motion_stops_the_animation(browser: Any, site: Path) -> None:
    quiet = browsers.page(browser, reduced_motion="reduce")
    quiet.goto((site / page("park-cantilever")).as_uri())
    first = quiet.evaluate("document.querySelector('canvas').toDataURL()")
    quiet.wait_for_timeout(150)
    assert quiet.evaluate("document.querySelector('canvas').toDataURL()") == first
    quiet.close()


def test_a_cases_differences_and_convergence(tab: Any, site: Path) -> None:
    tab.goto((site / page("park-cantilever")).as_uri())
    tab.select_option("select[name=speed]", label="10 rad/s")
    field = tab.locator("table.matrix td[aria-label^='edgewise 1, park2010/present:']")
    field.click()
    cell = next(
        c for c in run().cells if (c.case, c.code, c.omega, c.mode) == ("park-cantilever", "park2010/present", 10.0, 1)
    )
    assert cell.difference is not None
    assert cell.uncertainty is not None
    assert field.inner_text() == f"✔ −{100 * abs(cell.difference):.4f} %\n± {100 * cell.uncertainty:.4f} %"
    assert f"{cell.value:.6f}" in tab.locator("#detail").inner_text()
    tab.locator("details summary", has_text="Every number").press("Enter")
    all_ = [c for c in run().cells if c.case == "park-cantilever"]
    assert tab.locator("#everything tbody tr").count() == len(all_)
    convergence = tab.locator("svg[aria-label='Convergence']")
    assert convergence.locator("circle").count() == 6
    tab.select_option("select[name=convergence]", label="flapwise 1, 10 rad/s")
    assert convergence.locator("polyline").count() == 2


def test_a_case_that_is_not_the_packages_says_that_it_has_no_shapes(tab: Any, site: Path) -> None:
    tab.goto((site / page(HOSTILE)).as_uri())
    assert "Not drawn" in tab.locator("main").inner_text()
    assert tab.locator("canvas").count() == 0


def test_codes_and_seeded_faults(tab: Any, site: Path) -> None:
    tab.goto((site / "run-2" / "codes.html").as_uri())
    tab.get_by_role("link", name="pybmodes").press("Enter")
    tab.wait_for_url(re.compile(r"/code-pybmodes\.html$"))
    text = tab.locator("main").inner_text()
    assert "version 1.19.1" in text
    assert "shares with Southwell: nothing" in text
    assert "leaves out: prestretch" in text
    cases = {c.case for c in run().cells if c.code == "pybmodes"}
    assert tab.locator("#worst tbody tr").count() == len(cases)
    tab.goto((site / "run-2" / "index.html").as_uri())
    controls = tab.locator("#controls tbody tr").all_inner_texts()
    assert len(controls) == len({c.control for c in run().controls})


def test_a_fault_that_many_cells_detect_takes_a_few_lines(tab: Any, tmp_path: Path) -> None:
    """It took more than the height of the screen."""
    cells = tuple(f"park-cantilever, exact-beam, edgewise (mode {k}), 10 rad/s: fail" for k in range(40))
    control = Control(
        "no hub radius", "solver", "the root is on the rotor's axis", "-3 %", "park-cantilever", 10.0, cells
    )
    seeded = replace(samples.run(), controls=(control,))
    tab.goto(write({"run": seeded}, None, tmp_path).as_uri())
    rows = tab.locator("#controls tbody tr")
    assert rows.first.inner_text().endswith("and 39 more")
    assert max(rows.evaluate_all("rows => rows.map((r) => r.getBoundingClientRect().height)")) < 80


def test_the_history_lists_runs_steps_and_changes(tab: Any, site: Path) -> None:
    tab.goto((site / "history.html").as_uri())
    assert "truncated and left out: line 8 of the file" in tab.locator("main").inner_text()
    assert tab.locator("#runs tbody tr").count() == 7
    steps = tab.locator("#steps tbody tr").all_inner_texts()
    assert [re.split(r"\s*\t\s*", s)[1] for s in steps] == ["Southwell", "scikit-fem"]
    assert "scikit-fem 12 → 13" in steps[1]
    gone = tab.locator("#who tbody tr").all_inner_texts()  # from the sixth to the seventh
    answers = [c for c in run().cells if c.code == LOST and c.value]
    assert len(gone) == 1
    assert gone[0].split() == [LOST, str(len(answers))]
    tab.select_option("select[name=from]", "3")
    tab.select_option("select[name=to]", "4")
    (moved,) = tab.locator("#who tbody tr").all_inner_texts()
    assert moved.startswith("scikit-fem")
    assert "+1.00e-6" in moved
    assert "scikit-fem 12 → 13" in tab.locator("#moved").inner_text()
    tab.select_option("select[name=from]", "4")
    tab.select_option("select[name=to]", "5")
    (moved,) = tab.locator("#who tbody tr").all_inner_texts()
    assert moved.startswith("Southwell")
    assert "+1.00e-5" in moved
    tab.locator("#moved summary").first.click()
    assert tab.locator("#cells tbody tr").count() > 10
    tab.select_option("select[name=from]", "0")
    tab.select_option("select[name=to]", "1")
    assert "No number moved" in tab.locator("#moved").inner_text()


def test_one_number_run_by_run(tab: Any, site: Path) -> None:
    tab.goto((site / "history.html").as_uri())
    chart = tab.locator(".chart svg")
    assert tab.locator("select[name=series-case]").input_value() == "wright-flapwise"  # what stepped last: core, there
    assert "difference" in tab.locator("select[name=series-number]").input_value().replace("d mode", "difference")
    assert chart.locator("line.step").count() == 1
    tab.select_option("select[name=series-case]", "tip-mass")
    tab.select_option("select[name=series-code]", "scikit-fem")
    tab.select_option("select[name=series-number]", index=0)
    assert chart.locator("circle").count() == 7
    assert chart.locator("line.step").count() == 1
    tab.select_option("select[name=series-code]", LOST)
    assert chart.locator("circle").count() == 6  # the seventh run has none
    assert chart.locator("line.step").count() == 0


NARROW = ["index.html", page("park-cantilever"), page("nrel-5mw"), page(HOSTILE), "codes.html", "history.html"]


@pytest.mark.parametrize("name", [*NARROW, page("pybmodes", "code").replace("code-", "run-2/code-")])
def test_on_a_phone_only_heat_maps_scroll_sideways(browser: Any, site: Path, name: str) -> None:
    phone = browsers.page(browser, viewport={"width": 390, "height": 844})
    phone.goto((site / name).as_uri())
    assert phone.evaluate("document.documentElement.scrollWidth") <= 390
    for summary in phone.locator("summary").all():
        summary.click()
    if phone.locator("td[tabindex]").count():
        phone.locator("td[tabindex]").first.click()
    assert phone.evaluate("document.documentElement.scrollWidth") <= 390
    widths = "all => all.map(t => t.getBoundingClientRect().right)"
    assert all(right <= 390 for right in phone.locator("table:not(.matrix)").evaluate_all(widths))
    phone.close()


def test_pages_are_printed_dark_on_white_and_complete(browser: Any, site: Path) -> None:
    dark = browsers.page(browser, color_scheme="dark", viewport={"width": 1000, "height": 700})
    dark.goto((site / "index.html").as_uri())
    paper = "getComputedStyle(document.body).backgroundColor"
    assert dark.evaluate(paper) != "rgb(255, 255, 255)"
    dark.emulate_media(media="print", color_scheme="dark")
    assert dark.evaluate(paper) == "rgb(255, 255, 255)"
    assert not dark.locator(".filters").is_visible()
    assert dark.evaluate("getComputedStyle(document.querySelector('.wide')).overflowX") == "visible"
    dark.close()
