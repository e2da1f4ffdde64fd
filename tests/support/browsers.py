"""A real browser, for pages read from the file system."""

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from typing import Any

import pytest

NAMES = ("chromium", "chromium-browser", "google-chrome")
BROWSER = next((path for name in NAMES if (path := shutil.which(name))), None)

needed = pytest.mark.skipif(
    BROWSER is None or find_spec("playwright") is None,
    reason="needs Chromium (Debian: apt install chromium), and: pip install playwright",
)


@contextmanager
def browser() -> Iterator[Any]:
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        running = playwright.chromium.launch(executable_path=BROWSER, args=["--no-sandbox"])
        yield running
        running.close()


TIMEOUT_MS = 120_000
"""Longest that a page may take to load, ms: a busy machine takes more than Playwright's 30 s."""


def page(running: Any, **options: Any) -> Any:
    """A page, in a context of its own with these options."""
    made = running.new_page(**options)
    made.set_default_timeout(TIMEOUT_MS)
    return made


@contextmanager
def tab(running: Any) -> Iterator[Any]:
    """A page whose console must stay silent, which opens no dialog, and fetches nothing from elsewhere."""
    tab = page(running, viewport={"width": 1280, "height": 900})
    messages: list[str] = []
    tab.on("console", lambda m: messages.append(m.text) if m.type in ("error", "warning") else None)
    tab.on("pageerror", lambda e: messages.append(str(e)))
    tab.on("dialog", lambda d: (messages.append(d.message), d.dismiss()))
    tab.on("request", lambda r: messages.append(r.url) if not r.url.startswith(("file:", "data:")) else None)
    yield tab
    tab.close()
    assert messages == []
