"""The site: pages, links and names of files are complete, it builds without a warning and offline, and its commands work."""

import importlib.util
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import tomllib
from collections import Counter
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import pytest
import yaml

from southwell.cases.input import library
from southwell.cases.plan.settings import settings
from southwell.cases.store import results_file
from southwell.references.protocol import registry
from southwell.reports.cli import app as cli
from southwell.reports.cli.arguments import RESULTS
from southwell.reports.shared.summary import BAD
from southwell.reports.site import notebook
from southwell.reports.site import pages as site
from southwell.reports.verification import report as matrix_report

from ...support import browsers, samples

ROOT = Path(__file__).parents[3]
DOCS = ROOT / "docs"
PAGES = sorted(page.name for page in DOCS.glob("*.md"))

TESTED_BY = {"add-your-code.md": "test_add_your_code.py", "pytest-plugin.md": "test_pytest_plugin.py"}
"""Pages whose examples are followed by tests of their own: the second's are parts of tests/example_project."""

NIGHTLY = {"add-a-case.md", "index.md", "machine.md", "mechanisms.md", "studies.md", "your-blade.md"}


def blocks(page: str, language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", (DOCS / page).read_text(encoding="utf-8"), re.M | re.S)


def configuration() -> dict:
    return yaml.safe_load((ROOT / "mkdocs.yml").read_text(encoding="utf-8"))


def leaves(part: object) -> list[str]:
    if isinstance(part, str):
        return [part]
    return [name for entry in (part.values() if isinstance(part, dict) else part) for name in leaves(entry)]  # type: ignore[union-attr]


# ----------------------------------------------------------------------------------------------------------- the pages


def test_files_named_on_a_page_exist() -> None:
    pages = [*DOCS.glob("*.md"), ROOT / "README.md", ROOT / "CONTRIBUTING.md"]
    by_name = {
        (page.name, name)
        for page in pages
        for name in re.findall(
            r"`((?:core|references|cases|reports|tests)/[\w/]+\.\w+)`", page.read_text(encoding="utf-8")
        )
    }
    assert len({page for page, _ in by_name}) > 5
    assert sorted((page, name) for page, name in by_name if not (ROOT / name).is_file()) == []


def test_every_page_is_in_the_nav_and_every_name_in_the_nav_is_a_page() -> None:
    made = site.cases() | site.api()
    named = leaves(configuration()["nav"])
    assert set(PAGES) <= set(named), "add it to the nav of mkdocs.yml"
    pages = {*PAGES, *made, "codes/index.md", "cli.md", "results.md", "first-blade.md"}
    assert set(named) <= pages
    assert len(named) == len(set(named))


def test_a_page_for_every_case_with_the_words_of_its_file() -> None:
    made = site.cases()
    cases, absent = library.load_all()
    assert {f"cases/{name}.md" for name in {*cases, *library.mechanisms(), *library.turbines()}} == set(made) - {
        "cases/index.md"
    }
    for name, case in cases.items():
        first, *rest = settings(case)
        text = re.sub(r"\\(.)", r"\1", str(made[f"cases/{name}.md"]))
        assert first.description.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;") in text
        assert all(f"## {phrase.case}" in text for phrase in (first, *rest))
    assert all(name in str(made["cases/index.md"]) for name in absent)


def test_a_case_has_its_results_and_the_figures_of_a_run(tmp_path: Path) -> None:
    (tmp_path / "figures").mkdir()
    for name in ("tip-mass-campbell.svg", "tip-mass-differences.svg", "tip-mass-in-plane-straight-campbell.svg"):
        (tmp_path / "figures" / name).write_text("<svg/>", encoding="utf-8")
    page = site.cases(tmp_path)["cases/tip-mass.md"]
    assert re.search(r"\| `exact-beam` +\| ✔ pass", page)
    assert re.findall(r"!\[.+?\]\(\.\./(.*?)\)", page) == [
        "figures/tip-mass-campbell.svg",
        "figures/tip-mass-differences.svg",
    ]
    assert set(site.figures(tmp_path)) >= {"figures/tip-mass-campbell.svg"}


def test_the_command_line_has_every_command_and_option() -> None:
    text = site.command_line()
    for name in cli.app:
        if not name.startswith("-"):
            assert f"## southwell {name}\n" in text
    assert "--junit PATH" in text
    assert "Exit status" in text


def test_the_api_has_every_module() -> None:
    made = site.api()
    for floor in site.FLOORS:
        files = [path.relative_to(ROOT).with_suffix("") for path in (ROOT / floor).rglob("*.py")]
        modules = {".".join(("southwell", *path.parts)) for path in files if path.name != "__init__"}
        assert modules
        pages = "".join(text for path, text in made.items() if path.startswith(f"api/southwell.{floor}."))
        assert modules == set(re.findall(r"^::: (\S+)", pages, re.M))


def test_the_api_has_a_page_for_each_package_and_an_index_that_links_them() -> None:
    made = site.api()
    index = made.pop("api/index.md")
    assert set(re.findall(r"\]\((.+?\.md)", index)) == {path.removeprefix("api/") for path in made}
    assert max(len(re.findall("^::: ", text, re.M)) for text in made.values()) <= 16


# ------------------------------------------------------------------------------------------------------- what is typed


@pytest.mark.slow
@pytest.mark.parametrize(
    "page",
    [
        pytest.param(page, marks=pytest.mark.nightly) if page in NIGHTLY else page
        for page in PAGES
        if page not in TESTED_BY
    ],
)
def test_commands_on_pages_run(page: str, tmp_path: Path) -> None:
    """Its files are saved under the names it says, its commands typed in their order, its Python run in one go.

    The folder is a checkout, with results where `make verify` leaves them. Only southwell's own commands are typed.
    """
    author = ["-c", "user.name=x", "-c", "user.email=x@example.org"]
    for git in (["init", "--quiet"], [*author, "commit", "--quiet", "--allow-empty", "--message", "x"]):
        subprocess.run(["git", *git], cwd=tmp_path, check=True)
    sample = samples.run()
    passing = tuple(c for c in sample.cells if c.verdict not in BAD)
    run = replace(sample, cells=passing, controls=tuple(c for c in sample.controls if not c.missed))
    (tmp_path / "reports" / "out").mkdir(parents=True)
    results_file.write(tmp_path / "reports" / "out" / RESULTS, run)
    shutil.copyfile(ROOT / "examples" / "nrel-5mw-blade.dat", tmp_path / "blade.dat")
    for text in blocks(page, "toml"):
        (tmp_path / f"{tomllib.loads(text)['name']}.toml").write_text(text, encoding="utf-8")
    for line in (line for block in blocks(page, "console") for line in block.splitlines()):
        program, *arguments = shlex.split(line)
        if arguments[:1] == ["verify"] and "--faults" not in arguments:
            arguments += ["--faults", "none"]  # make verify seeds them
        if program == "southwell":
            done = typed([sys.executable, "-m", program, *arguments], tmp_path)
            assert done.returncode == 0, f"{line}\n{done.stdout}{done.stderr}"
    if python := "\n".join(blocks(page, "python")):
        done = typed([sys.executable, "-c", python], tmp_path)
        assert done.returncode == 0, done.stderr


def typed(command: list[str], folder: Path) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "OMP_NUM_THREADS": "1"}
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, env=environment, timeout=300)


@pytest.mark.slow
@pytest.mark.nightly
def test_the_notebook_is_a_page_with_what_its_cells_show() -> None:
    path = DOCS / "first-blade.ipynb"
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    assert not any(cell.get("outputs") for cell in cells), "clear the outputs before committing"
    made = notebook.page(path)
    page = made.pop("first-blade.md")
    assert page.count("```python") == sum(cell["cell_type"] == "code" for cell in cells)
    assert page.count("<table") >= 4
    assert len(made) == 3
    assert all(f"]({name})" in page and text.startswith("<svg") for name, text in made.items())
    assert "flapwise 1 crosses 4P" in page
    assert "<style" not in page


def test_a_cell_shows_its_last_value_and_what_it_prints(tmp_path: Path) -> None:
    sources = ["import os\nhere = os.getcwd()\nprint('printed')\n1 + 1", "2 + 2;", "here == os.getcwd()"]
    cells = [{"cell_type": "markdown", "source": ["# Title"]}]
    cells += [{"cell_type": "code", "source": [source]} for source in sources]
    path = tmp_path / "small.ipynb"
    path.write_text(json.dumps({"cells": cells}), encoding="utf-8")
    output = re.findall(r"```text\n(.*?)\n```", notebook.page(path)["small.md"], re.S)
    assert output == ["printed", "2", "True"]


# ------------------------------------------------------------------------------------------------------------ the site


class Page(HTMLParser):
    """What a page loads, and its formulas."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.loaded: list[str] = []
        self.formulas = 0
        self.feed(html)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        if tag == "link" and given.get("rel") not in ("canonical", "next", "prev"):
            self.loaded.append(given.get("href") or "")
        if tag in ("script", "img", "iframe"):
            self.loaded.append(given.get("src") or "")
        self.formulas += tag == "math"


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    for needed in ("mkdocs", "material", "mkdocstrings", "latex2mathml"):
        if importlib.util.find_spec(needed) is None:
            pytest.skip(f"{needed} is not installed: pip install '.[docs]'")
    out = tmp_path_factory.mktemp("site")
    done = typed([sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(out)], ROOT)
    assert done.returncode == 0, done.stdout + done.stderr
    return out


@pytest.mark.slow
def test_the_site_builds_without_warnings(built: Path) -> None:
    assert {Path(page).stem for page in PAGES} <= {path.stem for path in built.glob("*.html")}
    names = [registry.code(name).name for name in registry.names()]
    assert all((built / "codes" / f"{name}.html").exists() for name in names)
    assert '<div class="language-console highlight">' in (built / "your-blade.html").read_text(encoding="utf-8")
    assert not [page.name for page in (built / "api").glob("*.html") if "::</p>" in page.read_text(encoding="utf-8")]


@pytest.mark.slow
def test_the_site_loads_nothing_from_the_network(built: Path) -> None:
    for path in built.rglob("*.html"):
        away = [url for url in Page(path.read_text(encoding="utf-8")).loaded if re.match(r"(https?:)?//", url)]
        assert not away, path
    for path in built.rglob("*.css"):
        assert not re.search(r"(@import|url\()\s*[\"']?(https?:)?//", path.read_text(encoding="utf-8")), path


@pytest.mark.slow
@browsers.needed
def test_search_works_from_the_file_system(built: Path) -> None:
    with browsers.browser() as running, browsers.tab(running) as page:
        start = (built / "cases" / "index.html").as_uri()
        page.goto(start)
        page.click(".md-search__input")
        page.keyboard.type("precone")
        page.click(".md-search-result__link >> nth=0")
        page.wait_for_url(lambda url: url != start)
        assert "precone" in page.inner_text(".md-content").lower()


@pytest.mark.slow
def test_formulas_are_shown_without_a_script(built: Path) -> None:
    text = (DOCS / "theory.md").read_text(encoding="utf-8")
    inline = re.sub(r"\$\$.*?\$\$", "", text, flags=re.S)
    html = (built / "theory.html").read_text(encoding="utf-8")
    assert Page(html).formulas == (text.count("$$") + inline.count("$")) // 2 > 50
    assert "arithmatex" not in html
    assert not re.findall(r"\\[a-z]{3,}", re.sub(r"<script.*?</script>", "", html, flags=re.S))


@pytest.mark.slow
def test_the_api_is_filled_from_docstrings_without_internals(built: Path) -> None:
    pages = {path.stem: path.read_text(encoding="utf-8") for path in (built / "api").glob("*.html")}
    for name in ("southwell", "southwell.core"):
        assert "A rotating blade on its hub; properties vary linearly between stations." in pages[name]
    objects = Counter[str]()
    for name, text in pages.items():
        objects[name.partition(".")[2].partition(".")[0]] += text.count('class="doc doc-heading"')
    least = {"adapter": 15, "core": 400, "references": 400, "cases": 800, "reports": 300}
    assert all(objects[part] >= count for part, count in least.items()), objects
    for text in pages.values():
        assert not re.search(r'id="[\w.]*__\w+__', text)
        assert "Built-in" not in text
        assert str(ROOT) not in text


def test_a_runs_report_is_on_the_site_with_its_figures(tmp_path: Path) -> None:
    assert site.report(tmp_path) == {}
    written = matrix_report.write(samples.run(), tmp_path).read_text(encoding="utf-8")
    made = site.report(tmp_path)
    links = re.findall(r"!\[.*?\]\((.*?)\)", written)
    assert set(made) == {site.REPORT}
    assert set(site.figures(tmp_path)) == set(links)
    assert len(links) == 4
    assert made[site.REPORT].count('<details markdown="1">') == written.count("<details>") > 0
