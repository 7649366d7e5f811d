"""A real browser for tests: the chromium that the system has, headless, which loads nothing but the page."""

from __future__ import annotations

import shutil
from contextlib import contextmanager

import pytest

NAMES = ("chromium", "chromium-browser", "google-chrome-stable", "google-chrome")
FLAGS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
)


def program():
    """The path of the browser; skips the test if there is none, or no driver for it."""
    pytest.importorskip("playwright", reason="playwright drives the browser; pip install -e '.[dev]' brings it")
    found = next((path for name in NAMES if (path := shutil.which(name))), None)
    if found is None:
        pytest.skip(f"no browser: none of {', '.join(NAMES)} is on the PATH (Debian: apt-get install chromium)")
    return found


@contextmanager
def opened():
    """The browser, in a profile of its own that is gone afterwards."""
    path = program()
    from playwright.sync_api import sync_playwright

    with sync_playwright() as driver:
        running = driver.chromium.launch(executable_path=path, args=list(FLAGS))
        try:
            yield Window(running.new_page())
        finally:
            running.close()


class Window:
    """The one tab of the browser: what its console said, and what it asked the network for, since the last visit.

    A tab of its own for each visit would take five times the processor time.
    """

    def __init__(self, page):
        self.page = page
        self.said, self.requests = [], []
        self.page.on("console", lambda message: self.said.append(f"{message.type}: {message.text}"))
        self.page.on("pageerror", lambda error: self.said.append(f"uncaught: {error}"))
        self.page.on("request", lambda request: self.requests.append(request.url))

    def visit(self, path, *, width=1280):
        """Open a page, in a window of this width, on a screen and in the light."""
        self.page.goto("about:blank")
        self.page.set_viewport_size({"width": width, "height": 900})
        self.page.emulate_media(media="screen", color_scheme="light")
        self.said.clear()
        self.requests.clear()
        self.page.goto(path.as_uri())
        return self

    def unfold(self):
        """Open everything that is folded away."""
        self.page.evaluate("document.querySelectorAll('details').forEach(each => each.open = true)")
