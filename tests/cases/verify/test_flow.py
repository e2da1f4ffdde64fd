"""The page that describes a run names at most thirty files, each once."""

import re

from ...test_packaging import ROOT


def test_thirty_files_in_reading_order() -> None:
    flow, _, helpers = (ROOT / "docs" / "run.md").read_text(encoding="utf-8").partition("## Modules used by the steps")
    files = re.findall(r"`((?:cases|references|reports)/[^`]+\.py)`", flow)
    assert len(files) == len(set(files)) == 30
    assert all((ROOT / file).is_file() for file in files)
    assert helpers
