"""Pages in a real browser: drawn whole, accessible, readable on phones and on paper."""

from __future__ import annotations

from collections.abc import Callable
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from axe_playwright_python.sync_playwright import Axe
from browser import DESKTOP, PAPER_PX, PHONE, Visit, visit
from example_documents import ACCEPTANCE, FLIGHTS, flown, studied, study_result, surveyed
from example_flights import Flight, spoil
from playwright.sync_api import Browser
from pypdf import PdfReader
from report_pages import Page

from inspect_cli.records import Estimate, InvalidReason, State
from inspect_cli.reporting.content.blocks import Document
from inspect_cli.reporting.screen.html import html
from inspect_cli.reporting.words.language import language

pytestmark = [pytest.mark.browser, pytest.mark.xdist_group("browser")]

Fly = Callable[..., Flight]

SMALLEST_PX = 11.0
A4_PT = (595.3, 841.9)
WIDE = """
(limit) => [...document.body.querySelectorAll("*")].filter(function (element) {
  const style = getComputedStyle(element);
  const box = element.getBoundingClientRect();
  return box.width && style.visibility !== "hidden"
    && !element.closest(".scroll *, .js-plotly-plot *, #js-plotly-tester, nav *")
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
() => [...document.querySelectorAll(".js-plotly-plot")].filter(function (plot) {
  const { yaxis, _size: room } = plot._fullLayout;
  return yaxis?.scaleanchor && room.h - yaxis._length > 2;
}).map((plot) => plot.id)
"""
"""Figures at equal scales that leave height empty."""

PAGES: dict[str, Callable[[Fly], Document]] = {
    "flight": lambda fly: flown(spoiled(fly(1, 3, acceptance=ACCEPTANCE))),
    "survey": lambda fly: surveyed(fly(2, 3)),
    "pitch": lambda _: studied(study_result("pitch")),
    "force": lambda _: studied(study_result("force")),
}
EXPERIMENTS = ("drawing", "servoing", "pulls", "forces")


def spoiled(flight: Flight) -> Flight:
    """The flight with an invalid reading among its readings."""
    spoil(flight, 1, InvalidReason.FORCE)
    return flight


def whole(seen: Visit, file: Path) -> None:
    """Every figure is drawn, and nothing went wrong."""
    figures = Page(file.read_text(encoding="utf-8")).figures
    assert seen.told["figures"] == str(len(figures))
    assert seen.told["failures"] == "0"
    assert seen.page.locator(".plot .main-svg").count() >= len(figures) > 0
    assert seen.errors == []
    assert seen.violations == []


@pytest.mark.parametrize("kind", PAGES)
def test_a_page_is_whole_and_readable_everywhere(
    chromium: Browser, fly: Fly, tmp_path: Path, kind: str
) -> None:
    """On a phone, on a desk and on paper; in German, whose words are longer."""
    file = tmp_path / "page.html"
    file.write_text(html(PAGES[kind](fly), language("de")), encoding="utf-8")
    with visit(chromium, file, **PHONE) as seen:
        whole(seen, file)
        readable_on_a_phone(seen)
        assert violations(seen) == []
        page = seen.page
        page.set_viewport_size(DESKTOP["viewport"])
        seen.settle()
        assert page.evaluate(WIDE, 1280) == []
        assert page.evaluate(CUT) == []
        assert page.evaluate(SPARE) == []
        page.set_viewport_size({"width": PAPER_PX, "height": 1000})
        page.emulate_media(media="print")
        page.evaluate("window.dispatchEvent(new Event('beforeprint'))")
        seen.settle()
        assert page.evaluate(WIDE_ON_PAPER, PAPER_PX) == []
        assert page.evaluate(CUT) == []
        assert not page.locator("nav").is_visible()
        assert seen.errors == []


@pytest.mark.parametrize("kind", PAGES)
def test_a_page_is_accessible_on_a_desk(
    chromium: Browser, fly: Fly, tmp_path: Path, kind: str
) -> None:
    file = tmp_path / "page.html"
    file.write_text(html(PAGES[kind](fly), language("en")), encoding="utf-8")
    with visit(chromium, file) as seen:
        whole(seen, file)
        assert violations(seen) == []


@pytest.mark.parametrize("name", EXPERIMENTS)
def test_the_figures_of_an_experiment_are_whole_on_a_phone(
    chromium: Browser, fly: Fly, platform_file: Path, tmp_path: Path, name: str
) -> None:
    file = tmp_path / "page.html"
    document = flown(FLIGHTS[name](fly, platform_file))
    file.write_text(html(document, language("de")), encoding="utf-8")
    with visit(chromium, file, **PHONE) as seen:
        whole(seen, file)
        readable_on_a_phone(seen)


def readable_on_a_phone(seen: Visit) -> None:
    """Nothing scrolls sideways but tables, and no text is small or cut."""
    width = PHONE["viewport"]["width"]
    assert seen.page.evaluate("document.scrollingElement.scrollWidth") <= width
    assert seen.page.evaluate(WIDE, width) == []
    assert seen.page.evaluate(SMALL, SMALLEST_PX) == []
    assert seen.page.evaluate(CUT) == []
    assert seen.page.evaluate(SPARE) == []


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


def test_a_printed_page_is_a4(chromium: Browser, fly: Fly, tmp_path: Path) -> None:
    file = tmp_path / "page.html"
    file.write_text(html(PAGES["force"](fly), language("de")), encoding="utf-8")
    with visit(chromium, file) as seen:
        printed = seen.page.pdf(prefer_css_page_size=True)
        assert "printing" not in seen.page.evaluate("document.documentElement.className")
    pages = PdfReader(BytesIO(printed)).pages
    for page in pages:
        assert (float(page.mediabox.width), float(page.mediabox.height)) == pytest.approx(
            A4_PT, abs=1.0
        )
    assert "Variationen" in " ".join(page.extract_text() for page in pages)


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
