"""Pages in a real browser: drawn whole, accessible, readable on phones and on paper."""

from __future__ import annotations

from collections.abc import Callable
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from axe_playwright_python.sync_playwright import Axe
from browser import DESKTOP, PAPER_PX, PHONE, Visit, visit
from example_documents import FLIGHTS, flown, studied, study_result, surveyed
from example_flights import Flight, spoil
from playwright.sync_api import Browser
from pypdf import PdfReader
from report_pages import Page

from inspect_cli.records import Estimate, InvalidReason, State
from inspect_cli.reporting.content import Document
from inspect_cli.reporting.html import html
from inspect_cli.reporting.language import language
from inspect_cli.schema.survey import LanguageCode

pytestmark = [pytest.mark.browser, pytest.mark.xdist_group("browser")]

Fly = Callable[..., Flight]

SMALLEST_PX = 11.0
A4_PT = (595.3, 841.9)
WIDE = """
(limit) => [...document.body.querySelectorAll("*")].filter(function (element) {
  const style = getComputedStyle(element);
  const box = element.getBoundingClientRect();
  return box.width && style.visibility !== "hidden" && !element.closest(".scroll *, .js-plotly-plot *, #js-plotly-tester, nav *")
    && (box.right > limit + 1 || box.left < -1);
}).map((element) => `${element.tagName}.${element.className} ${element.textContent.slice(0, 60)}`)
"""
"""Elements that reach over the page; what scrolls in a region of its own may."""
WIDE_ON_PAPER = WIDE.replace(".scroll *, ", "")
"""Paper scrolls nothing."""
SMALL = """
(least) => [...document.body.querySelectorAll("*")].filter(function (element) {
  const own = [...element.childNodes].some((node) => node.nodeType === 3 && node.data.trim());
  const box = element.getBoundingClientRect();
  const index = element.tagName === "SUB" || /font-size: ?70%/.test(element.getAttribute("style"));
  return own && box.width && !index && parseFloat(getComputedStyle(element).fontSize) < least;
}).map((element) => `${getComputedStyle(element).fontSize} ${element.textContent.slice(0, 60)}`)
"""
"""Elements with text of their own that is too small; indices are what they are."""
CUT = """
() => [...document.querySelectorAll(".js-plotly-plot")].flatMap(function (plot) {
  const frame = plot.getBoundingClientRect();
  return [...plot.querySelectorAll("svg.main-svg text")].filter(function (text) {
    const box = text.getBoundingClientRect();
    return box.width && (box.left < frame.left - 1 || box.right > frame.right + 1
      || box.top < frame.top - 1 || box.bottom > frame.bottom + 1);
  }).map((text) => `${plot.id}: ${text.textContent}`);
})
"""
"""Texts of figures that reach out of their figure."""
SPARE = """
() => [...document.querySelectorAll(".js-plotly-plot")].filter((plot) =>
  plot._fullLayout.yaxis?.scaleanchor && plot._fullLayout._size.h - plot._fullLayout.yaxis._length > 2
).map((plot) => plot.id)
"""
"""Figures at equal scales that leave height empty."""

PAGES: dict[str, Callable[[Fly, Path], Document]] = {
    "nine": lambda fly, platform: flown(FLIGHTS["nine"](fly, platform)),
    "survey": lambda fly, _: surveyed(fly(2, 3)),
    "pitch": lambda *_: studied(study_result("pitch")),
    "force": lambda *_: studied(study_result("force")),
    **{
        name: lambda fly, platform, name=name: flown(FLIGHTS[name](fly, platform))
        for name in ("drawing", "servoing", "pulls", "forces")
    },
}
BOTH = ("nine", "survey", "pitch")
"""Pages that are looked at in both languages; the others in German, whose words are longer."""
LOOKED_AT = [
    (name, code) for name in PAGES for code in ("en", "de") if code == "de" or name in BOTH
]


def whole(seen: Visit, file: Path) -> None:
    """Every figure is drawn, and nothing went wrong."""
    figures = Page(file.read_text(encoding="utf-8")).figures
    assert seen.told["figures"] == str(len(figures))
    assert seen.told["failures"] == "0"
    assert seen.page.locator(".plot .main-svg").count() >= len(figures) > 0
    assert seen.errors == []
    assert seen.violations == []


@pytest.mark.parametrize(("kind", "code"), LOOKED_AT)
def test_a_page_is_whole_accessible_and_readable(
    chromium: Browser, fly: Fly, platform_file: Path, tmp_path: Path, kind: str, code: LanguageCode
) -> None:
    """On a phone, on a desk and on paper."""
    file = tmp_path / "page.html"
    file.write_text(html(PAGES[kind](fly, platform_file), language(code)), encoding="utf-8")
    with visit(chromium, file, **PHONE) as seen:
        whole(seen, file)
        page = seen.page
        assert page.evaluate("document.scrollingElement.scrollWidth") <= 390
        assert page.evaluate(WIDE, 390) == []
        assert page.evaluate(SMALL, SMALLEST_PX) == []
        assert page.evaluate(CUT) == []
        assert page.evaluate(SPARE) == []
        page.set_viewport_size(DESKTOP["viewport"])
        seen.settle()
        assert page.evaluate(WIDE, 1280) == []
        assert page.evaluate(CUT) == []
        assert page.evaluate(SPARE) == []
        assert violations(seen) == []
        page.set_viewport_size({"width": PAPER_PX, "height": 1000})
        page.emulate_media(media="print")
        page.evaluate("window.dispatchEvent(new Event('beforeprint'))")
        seen.settle()
        assert page.evaluate(WIDE_ON_PAPER, PAPER_PX) == []
        assert page.evaluate(CUT) == []
        assert not page.locator("nav").is_visible()
        assert seen.errors == []


def violations(seen: Visit) -> list[str]:
    """What axe-core objects to, of any impact, with the elements."""
    found = Axe().run(seen.page).response["violations"]
    return [
        f"{rule['impact']} {rule['id']}: {node['html'][:150]} {node['failureSummary'][:200]}"
        for rule in found
        for node in rule["nodes"][:3]
    ]


def test_axe_finds_what_it_should(chromium: Browser, tmp_path: Path) -> None:
    file = tmp_path / "page.html"
    file.write_text("<!DOCTYPE html><img src='data:,'><p style='color:#ddd'>pale", encoding="utf-8")
    with visit(chromium, file, drawn=False) as seen:
        found = " ".join(violations(seen))
    assert all(rule in found for rule in ("image-alt", "color-contrast", "html-has-lang"))


def test_a_printed_page_is_a4_with_all_its_figures(
    chromium: Browser, fly: Fly, tmp_path: Path
) -> None:
    file = tmp_path / "page.html"
    file.write_text(html(surveyed(fly(2, 3)), language("de")), encoding="utf-8")
    with visit(chromium, file) as seen:
        printed = seen.page.pdf(prefer_css_page_size=True)
        assert "printing" not in seen.page.evaluate("document.documentElement.className")
    pages = PdfReader(BytesIO(printed)).pages
    for page in pages:
        assert (float(page.mediabox.width), float(page.mediabox.height)) == pytest.approx(
            A4_PT, abs=1.0
        )
    text = " ".join(page.extract_text() for page in pages)
    assert "Zusammenfassung" in text


def test_a_spoiled_flight_is_drawn_too(chromium: Browser, fly: Fly, tmp_path: Path) -> None:
    flight = fly(1, 2)
    for k in range(2):
        spoil(flight, k, InvalidReason.OPEN_CIRCUIT)
    flight.rows(State)["p_WB"][900:] = 1e200
    flight.rows(Estimate)["q_WB"][900:] = np.nan
    flight.status = "diverged"
    file = tmp_path / "page.html"
    file.write_text(html(flown(flight), language("en")), encoding="utf-8")
    with visit(chromium, file) as seen:
        whole(seen, file)
