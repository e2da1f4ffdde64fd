"""``southwell study``: what it writes, says and refuses."""

import sys
from importlib import import_module
from pathlib import Path

import pytest

from southwell.reports.cli import app as cli
from southwell.reports.shared import console

from ....support.studies import lines, text


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "200")
    (tmp_path / "study.toml").write_text(text(samples=2))
    return tmp_path


def run(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, str, str]:
    with pytest.raises(SystemExit) as ending:
        cli.main(["study", *arguments])
    out, err = capsys.readouterr()
    return int(ending.value.code or 0), out, err


def test_rows_a_summary_and_nothing_solved_again(capsys: pytest.CaptureFixture[str], folder: Path) -> None:
    status, out, err = run(capsys, "study.toml", "--workers", "1", "--summary")
    assert status == 0, err
    assert "study.jsonl: 12 frequencies of 2 samples at 2 speeds" in out
    assert "flapwise 1" in out
    before = (folder / "study.jsonl").read_bytes()
    assert len(before.splitlines()) == 13
    status, _, err = run(capsys, "study.toml", "--workers", "1")
    assert (status, (folder / "study.jsonl").read_bytes()) == (0, before)


def test_parquet_has_the_same_rows_in_groups(capsys: pytest.CaptureFixture[str], folder: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet", reason="PyArrow is not installed: pip install -e '.[cluster]'")
    import_module("southwell.cases.study.parquet")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("southwell.cases.study.parquet.ROWS", 5)
        status, _, err = run(capsys, "study.toml", "--workers", "1", "--out", "out.parquet")
    assert status == 0, err
    file = parquet.ParquetFile(folder / "out.parquet")
    assert [file.metadata.row_group(k).num_rows for k in range(file.num_row_groups)] == [5, 5, 2]
    assert file.schema_arrow.metadata[b"southwell.study"] == lines(folder / "out.jsonl")[0]
    read = import_module("southwell.cases.study.journal").read
    for row, stored in zip(read(folder / "out.jsonl"), file.read().to_pylist(), strict=True):
        properties = {name: stored.pop(name) for name in ("EI_flap", "mass")}
        assert properties == row.properties
        assert stored == {name: getattr(row, name) for name in stored}
    assert "omega_rad_s" in stored
    assert "rows_left" not in stored


def test_without_pyarrow_there_is_a_hint_before_the_first_answer(
    capsys: pytest.CaptureFixture[str], folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    monkeypatch.setitem(sys.modules, "pyarrow.parquet", None)
    status, _, err = run(capsys, "study.toml", "--out", "out.parquet")
    assert status == 2
    assert err == (
        "southwell: --out out.parquet: pyarrow is not installed: pip install 'southwell[cluster]', or give a .jsonl file\n"
    )
    assert [path.name for path in folder.iterdir()] == ["study.toml"]


@pytest.mark.slow
def test_a_speed_without_a_frequency_is_status_1_with_its_reason(
    capsys: pytest.CaptureFixture[str], folder: Path
) -> None:
    wide = text(samples=8).replace("standard_deviation = 0.05", "standard_deviation = 2.0")
    (folder / "study.toml").write_text(wide)
    status, out, _ = run(capsys, "study.toml", "--workers", "1")
    assert status == 1
    assert "speeds of samples without one (first: park-cantilever, sample " in out
    assert "a factor is positive" in out


@pytest.mark.parametrize(
    ("before", "after", "message"),
    [
        ('"park-cantilever"', '"park-cantilevr"', "case: 'park-cantilevr' is not known: did you mean park-cantilever?"),
        ('"park-cantilever"', '"no.dat"', "no.dat: no such file"),
        ('["park-cantilever"]', '["tip-mass", "tip-mass"]', "blades: 'tip-mass' twice: "),
        ('["park-cantilever"]', "[]", "study.toml: blades: "),
        ("EI_flap", "EI_flat", "properties.EI_flat: not a property of a blade: did you mean EI_flap?"),
        (
            '"normal"',
            '"norml"',
            "properties.EI_flap.distribution: 'norml': not one of its values: did you mean normal?",
        ),
        ("standard_deviation = 0.05", "", "standard_deviation: missing: add it"),
        ("standard_deviation = 0.05", "standard_deviation = -1.0", "properties.EI_flap.standard_deviation: "),
        ("standard_deviation = 0.05", "standard_deviation = 0.05\nabsolute = true", "properties.EI_flap.absolute: "),
        ("low = 0.9", "low = 1.2", "properties.mass.low: 1.2: not below high = 1.1: exchange them"),
        ("low = 0.9", "low = -0.9", "properties.mass.low: -0.9: a factor is positive: correct it"),
        ("high = 1.1", "hgh = 1.1", "properties.mass.hgh: unknown key: did you mean high?"),
        ("rad_s = [0.0, 10.0]", "rad_s = [10.0, 0.0]", "speeds.rad_s: [10.0, 0.0]: not ascending"),
        ("rad_s = [0.0, 10.0]", "gamma = [1.0]", "speeds.gamma: requires blade.kind"),
        ("samples = 2", "samples = 0", "study.toml: samples: 0: "),
        ("seed = 1", "seed = -1", "study.toml: seed: -1: "),
        ('name = "small"', "", "study.toml: name: missing: add it"),
    ],
)
def test_an_error_of_the_study_file_is_one_line(
    before: str, after: str, message: str, capsys: pytest.CaptureFixture[str], folder: Path
) -> None:
    given = text(samples=2)
    assert before in given
    (folder / "study.toml").write_text(given.replace(before, after))
    status, _, err = run(capsys, "study.toml")
    assert status == 2
    assert message in err
    assert err.count("\n") == 1
    assert [path.name for path in folder.iterdir()] == ["study.toml"]


def test_samples_without_properties_are_refused(capsys: pytest.CaptureFixture[str], folder: Path) -> None:
    (folder / "study.toml").write_text(text(samples=2).partition("[properties")[0])
    status, _, err = run(capsys, "study.toml")
    assert (status, err.count("\n")) == (2, 1)
    assert "samples: 2: no sampled properties: add [properties], or leave it out" in err


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--out", "out.csv"], "--out out.csv: neither JSON Lines nor Parquet"),
        (["--out", "no/such/out.jsonl"], "--out no/such/out.jsonl: cannot be written (No such file or directory)"),
        (["--scheduler", "slurm"], "--workers: missing: give the number of workers"),
        (
            ["--scheduler", "tcp://h:1", "--workers", "2"],
            "--workers 2: the workers of tcp://h:1 are used: leave it out",
        ),
    ],
)
def test_an_error_of_the_options_is_one_line(
    options: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    status, _, err = run(capsys, "study.toml", *options)
    assert (status, err.count("\n")) == (2, 1)
    assert message in err


@pytest.mark.slow
def test_a_blade_file_is_in_the_folder_of_the_study(capsys: pytest.CaptureFixture[str], folder: Path) -> None:
    inner = folder / "inner"
    inner.mkdir()
    deck = Path(__file__).parents[4] / "examples" / "nrel-5mw-blade.dat"
    (inner / "blade.dat").write_bytes(deck.read_bytes())
    table = '{ file = "blade.dat", length = 61.5, hub_radius = 1.5 }'
    (inner / "study.toml").write_text(
        f'name = "deck"\nblades = [{table}]\nmodes = 1\nelements = 4\n[speeds]\nrpm = "0:12:12"\n'
    )
    status, out, err = run(capsys, "inner/study.toml", "--workers", "1")
    assert status == 0, err
    assert "2 frequencies of 1 samples at 2 speeds" in out
    (folder / "blade.dat").write_bytes(deck.read_bytes())
    text = (inner / "study.toml").read_text().replace('"blade.dat"', '"../blade.dat"')
    (inner / "study.toml").write_text(text)
    status, _, err = run(capsys, "inner/study.toml", "--out", "other.jsonl")
    assert (status, err.count("\n")) == (2, 1)
    assert f"outside {inner}: a file may name files in its folder only" in err


def test_a_log_has_the_remaining_time_of_this_run(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Ten samples are from an earlier run; the next ten took 20 s, so that the last 80 take 160 s."""
    clock = iter([0.0, 100.0, 105.0, 120.0])
    monkeypatch.setattr("southwell.reports.shared.console.time.monotonic", lambda: next(clock))
    counter = console.Counter("samples", 100)
    for done in (10, 11, 20):
        counter.show(done)
    lines = capsys.readouterr().err.splitlines()
    assert lines == ["11 of 100 samples; remaining: 0:07:25", "20 of 100 samples; remaining: 0:02:40"]
