"""Hostile texts in every field of what a page is made of: nothing runs, everything is text."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from browser import Visit, visit
from example_documents import ACCEPTANCE, coverage, studied, study_result
from example_flights import Flight, spoil
from hostile import EVIL, START, poisoned
from playwright.sync_api import Browser

from inspect_cli.log.foxglove import Event
from inspect_cli.log.reader import RunLog
from inspect_cli.metrics.evaluate import evaluate
from inspect_cli.records import InvalidReason
from inspect_cli.reporting.content.blocks import Document
from inspect_cli.reporting.documents.flight import report_document, survey_document
from inspect_cli.reporting.screen.html import html
from inspect_cli.reporting.words.language import LANGUAGES, language
from inspect_cli.schema.survey import LanguageCode

pytestmark = [pytest.mark.browser, pytest.mark.xdist_group("browser")]

Fly = Callable[..., Flight]

FOREIGN = """
() => [...document.querySelectorAll("*")].filter((element) =>
  element.classList.contains("evil") ||
  ["IFRAME", "OBJECT", "EMBED", "BASE", "FORM"].includes(element.tagName) ||
  [...element.attributes].some((attribute) =>
    /^on/i.test(attribute.name) || /^\\s*(javascript|data:text)/i.test(attribute.value))
).map((element) => element.outerHTML.slice(0, 200))
"""
TEXTS = """
() => {
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  const found = [];
  while (walker.nextNode()) {
    const parent = walker.currentNode.parentElement;
    if (!["SCRIPT", "STYLE"].includes(parent.tagName)) found.push(walker.currentNode.data);
  }
  return found;
}
"""
HOVER = """
() => {
  for (const plot of document.querySelectorAll(".js-plotly-plot")) {
    if (plot.layout.scene) continue;
    plot.data.forEach(function (trace, curveNumber) {
      const subplot = (trace.xaxis || "x") + (trace.yaxis || "y");
      if (trace.hoverinfo !== "skip")
        Plotly.Fx.hover(plot, [{ curveNumber, pointNumber: 0 }], [subplot]);
    });
  }
}
"""


def ran(seen: Visit) -> list[str]:
    """Every sign that something foreign ran, was stopped from it, or became an element."""
    scripts = "[...document.scripts].filter((script) => script.type === '').length"
    signs = [*seen.dialogs, *seen.errors, *seen.violations]
    signs += ["marked"] if "pwned" in seen.told else []
    signs += ["a script"] if seen.page.evaluate(scripts) > 2 else []
    return signs + list(seen.page.evaluate(FOREIGN))


def texts(seen: Visit) -> list[str]:
    """The texts of a page and of its drawings, without what parsers make of NUL."""
    found = seen.page.evaluate(TEXTS)
    return [text.replace("\x00", "").replace("\ufffd", "") for text in found]


def a_flight(fly: Fly) -> tuple[Document, set[str]]:
    """The report of a flight of which every text is hostile, and what it has to show."""
    flight = fly(1, 3, acceptance=ACCEPTANCE)
    spoil(flight, 1, InvalidReason.FORCE)
    flight.status, flight.status_reason = "aborted", "it fell"
    log = hostile_log(flight)
    result = poisoned(evaluate(flight.log()))
    assert {"points.*.label", "points.*.reason", "checks.*.reason"} <= result.taken
    assert {"status", "points.*.astm_class"} <= result.refused
    shown = {flight.mission.title, flight.mission.description, *flight.platform.chosen.values()}
    shown |= {flight.plan.surfaces[0].source, "0.3.1", "flight.log", "it touched", "it fell"}
    shown |= {point.label.split(START)[0] for point in result.model.points}
    shown |= {point.reason.split(START)[0] for point in result.model.points}
    shown |= {"it presses with 1.8 N", flight.plan.surfaces[0].fit.method}
    return report_document(log, result.model, log.plan()), shown


def hostile_log(flight: Flight) -> RunLog:
    """The flight's log with hostile mission, platform, plan, events, versions and attachments."""
    mission, platform, plan = map(poisoned, (flight.mission, flight.platform, flight.plan))
    assert {"title", "description", "acceptance.*.known_failure"} <= mission.taken
    assert {"name", "structure.*.name", "tasks.*.contact_grid.on"} <= mission.refused
    assert {"title", "source", "chosen.tool"} <= platform.taken
    assert {"name", "kind"} <= platform.refused
    assert {"targets.*.label", "surfaces.*.source", "surfaces.*.fit.method"} <= plan.taken
    assert {"mission", "platform", "surfaces.*.name", "targets.*.surface"} <= plan.refused
    wicked = replace(flight, mission=mission.model, platform=platform.model, plan=plan.model)
    wicked.run = {"seed": 1, "versions": {"mujoco" + EVIL: "0.3.1" + EVIL}}
    wicked.events = (Event(3.0, "info", "it touched" + EVIL), Event(9.0, "error", EVIL))
    wicked.status, wicked.status_reason = "aborted", "it fell" + EVIL
    log = wicked.log()
    return replace(log, attachments=log.attachments | {"flight.log" + EVIL: b""})


def a_survey(fly: Fly) -> tuple[Document, set[str]]:
    """The same of a survey."""
    flight = fly(1, 3, acceptance=ACCEPTANCE)
    log = hostile_log(flight)
    result = poisoned(evaluate(log)).model
    late = result.model_copy(update={"status": "aborted", "status_reason": "es riss" + EVIL})
    survey = poisoned(coverage(log.plan()))
    assert {"skipped.*.label", "skipped.*.reason"} <= survey.taken
    document = survey_document(log, result, [result, late], survey.model, log.plan())
    return document, {flight.mission.title, "z-9", "zu weit", "es riss"}


def a_study(_: Fly) -> tuple[Document, set[str]]:
    """The same of a study."""
    study = poisoned(study_result("pitch"), frozenset({"title", "columns.*.heading"}))
    assert {"mission", "findings.*", "quantities.*.symbol"} <= study.taken
    assert {"study", "variants.*.status"} <= study.refused
    return studied(study.model), {"example-survey", "variant-0", "p", "m²"}


PAGES: dict[str, Callable[[Fly], tuple[Document, set[str]]]] = {
    "flight": a_flight,
    "survey": a_survey,
    "study": a_study,
}


@pytest.mark.parametrize("code", LANGUAGES)
@pytest.mark.parametrize("kind", PAGES)
def test_hostile_texts_are_shown_as_texts(
    chromium: Browser, fly: Fly, tmp_path: Path, kind: str, code: LanguageCode
) -> None:
    document, wanted = PAGES[kind](fly)
    file = tmp_path / "page.html"
    file.write_text(html(document, language(code)), encoding="utf-8")
    whole = EVIL.replace("\x00", "")
    with visit(chromium, file) as seen:
        assert seen.told["failures"] == "0"
        before = texts(seen)
        seen.page.evaluate(HOVER)
        seen.settle()
        found = [*before, *texts(seen)]
        assert ran(seen) == []
    marked = [text for text in found if START in text]
    assert len(marked) > 10
    assert [text for text in marked if text.count(START) != text.count(whole)] == []
    everything = "\n".join(found)
    assert sorted(text for text in wanted if text + whole not in everything) == []


@pytest.mark.parametrize("policy", ["", "default-src 'none'; script-src 'none'"])
def test_the_check_sees_what_an_unsafe_page_does(
    chromium: Browser, tmp_path: Path, policy: str
) -> None:
    file = tmp_path / "unsafe.html"
    rule = f'<meta http-equiv="Content-Security-Policy" content="{policy}">' if policy else ""
    file.write_text(f"<!DOCTYPE html>{rule}<p>{EVIL.replace('<!--', '')}</p>", encoding="utf-8")
    with visit(chromium, file, drawn=False) as seen:
        seen.settle()
        signs = ran(seen)
        assert any('class="evil"' in sign for sign in signs)
        assert ("marked" in signs) == (not policy)
        assert bool(seen.dialogs) == (not policy)
        assert bool(seen.violations) == bool(policy)
        assert all(START not in text or EVIL not in text for text in texts(seen))
