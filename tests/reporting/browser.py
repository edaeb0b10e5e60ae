"""A page as a browser shows it: loaded to the end, with all that ran and all that was refused."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from playwright.sync_api import Browser, ConsoleMessage, Dialog, Error, Page

DESKTOP: dict[str, Any] = {"viewport": {"width": 1280, "height": 900}}
PHONE: dict[str, Any] = {
    "viewport": {"width": 390, "height": 844},
    "is_mobile": True,
    "has_touch": True,
}
PAPER_PX = 703
"""186 mm, the width of A4 without its margins, at 96 px to the inch."""

WATCH = """
window.violations = [];
document.addEventListener("securitypolicyviolation",
  (event) => window.violations.push(`${event.violatedDirective}: ${event.blockedURI}`));
"""
RESTLESS = """
() => new Promise((done) => requestAnimationFrame(() => setTimeout(done, 150)))
"""


@dataclass
class Visit:
    """An open page and what has happened on it."""

    page: Page
    errors: list[str] = field(default_factory=list)
    dialogs: list[str] = field(default_factory=list)

    @property
    def told(self) -> dict[str, str]:
        """What the page's script says of itself on the root element."""
        found: dict[str, str] = self.page.evaluate("({...document.documentElement.dataset})")
        return found

    @property
    def violations(self) -> list[str]:
        """What the content security policy has refused."""
        found: list[str] = self.page.evaluate("window.violations")
        return found

    def settle(self) -> None:
        """Wait until the figures have followed a change of the width."""
        self.page.evaluate(RESTLESS)


@contextmanager
def visit(browser: Browser, file: Path, *, drawn: bool = True, **options: Any) -> Iterator[Visit]:
    """Open a file in a fresh profile; with ``drawn``, wait until its figures are."""
    context = browser.new_context(**(options or DESKTOP))
    try:
        page = context.new_page()
        seen = Visit(page)

        def hear(message: ConsoleMessage) -> None:
            if message.type == "error":
                seen.errors.append(message.text)

        def close(dialog: Dialog) -> None:
            seen.dialogs.append(dialog.message)
            dialog.dismiss()

        def failed(error: Error) -> None:
            seen.errors.append(error.message)

        page.on("console", hear)
        page.on("dialog", close)
        page.on("pageerror", failed)
        page.add_init_script(WATCH)
        page.goto(file.as_uri())
        if drawn:
            page.wait_for_selector("html[data-drawn=true]", state="attached")
        yield seen
    finally:
        context.close()
