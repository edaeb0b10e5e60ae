"""A language that marks every translated word, and what of a page is not marked.

A word that is neither translated nor somebody else's is a string that no catalogue can reach.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from html.parser import HTMLParser
from typing import Any

from example_flights import Flight
from report_pages import Page

from inspect_cli.metrics.catalogue import METRICS
from inspect_cli.records import CORE_RECORDS
from inspect_cli.reporting.words.language import Language, language, pieces
from inspect_cli.reporting.words.published import PUBLISHED, SOURCE
from inspect_cli.reporting.words.text import Said

UNITS = {
    "V",
    "mV",
    "CSE",
    "A",
    "N",
    "m",
    "m²",
    "mm",
    "mrad",
    "rad",
    "s",
    "Wh",
    "W",
    "Hz",
    "kΩ",
    "cm",
    "Ω",
}
SYMBOLS = {*"abpuvxyzEFRfρτθ", "Δ", "K", "K_I", "e"}
NAMES = {"ASTM", "C", "SHA", "RMS"}
"""What every language writes alike: units, symbols, names of standards."""
SHOWN_KEYS = {"text", "title", "name", "ticktext", "customdata", "hovertemplate", "x", "y"}


class Pseudo(Language):
    """Puts every piece of a template into ⟦ ⟧ and leaves what is filled in."""

    @staticmethod
    def made() -> Pseudo:
        german = language("de")
        return Pseudo(german.code, german.decimal_sign, {})

    def template(self, said: Said) -> str:
        return "".join(
            (f"⟦{_braced(words)}⟧" if words else "") + (f"{{{name}}}" if name else "")
            for words, name in pieces(super().template(said))
        )

    def enumeration(self, items: Iterable[str]) -> str:
        return "⟦, ⟧".join(items)


def _braced(words: str) -> str:
    return words.replace("{", "{{").replace("}", "}}")


def foreign(flight: Flight) -> set[str]:
    """What a flight's report holds that is not the project's to translate."""
    mission, platform, plan, log = flight.mission, flight.platform, flight.plan, flight.log()
    found = {mission.name, mission.title, mission.description, str(plan.impedance)}
    found |= {mission.estimation, platform.name, platform.title, platform.kind, platform.source}
    found |= {*platform.chosen, *platform.chosen.values(), *plan.warnings, SOURCE}
    found |= {str(check.known_failure) for check in mission.acceptance if check.known_failure}
    found |= {check.ref for check in mission.acceptance if check.ref}
    for surface in plan.surfaces:
        found |= {surface.name, surface.source, surface.fit.method if surface.fit else ""}
    found |= {event.text for event in log.events} | {flight.status_reason}
    found |= {*log.attachments, *log.versions, *log.versions.values(), *METRICS}
    found |= {record.topic for record in CORE_RECORDS}
    return found - {""}


def left_over(page: Page, others: set[str]) -> list[str]:
    """Every visible text with a word that nobody has translated, the word first."""
    places = {row.section for row in PUBLISHED.values()} | {row.table for row in PUBLISHED.values()}
    ours = sorted((others | places) - {""}, key=len, reverse=True)
    pattern = re.compile("|".join(rf"(?<!\w){re.escape(text)}(?!\w)" for text in ours))
    allowed = UNITS | SYMBOLS | NAMES
    found = []
    for text in visible(page):
        rest = re.sub(
            r"<sub>\w</sub>|<[^>]*>|%\{[^}]*\}|\b[0-9a-f]{64}\b", " ", shown(pattern.sub(" ", text))
        )
        words = set(re.findall(r"[^\W\d_]+(?:_[^\W\d_]+)?", rest)) - allowed
        found += [f"{word}: {text[:120]}" for word in sorted(words)]
    return found


def shown(text: str) -> str:
    """The text without what is marked."""
    return re.sub(r"⟦[^⟦⟧]*⟧", "", text)


def visible(page: Page) -> Iterator[str]:
    reader = _Reader()
    reader.feed(page.source)
    yield from reader.texts
    for figure in page.figures.values():
        for trace in figure["data"]:
            hidden = trace.get("showlegend") is False and trace.get("hoverinfo") == "skip"
            yield from _strings({k: v for k, v in trace.items() if not (hidden and k == "name")})
        yield from _strings(figure["layout"])


def _strings(value: Any, key: str = "") -> Iterator[str]:
    if isinstance(value, dict):
        for name, item in value.items():
            yield from _strings(item, name)
    elif isinstance(value, list):
        for item in value:
            yield from _strings(item, key)
    elif isinstance(value, str) and key in SHOWN_KEYS:
        yield value


class _Reader(HTMLParser):
    """The texts of a page, and what screen readers say."""

    def __init__(self) -> None:
        super().__init__(convert_charrefs=True)
        self.texts: list[str] = []
        self._raw = False

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self._raw = tag in ("script", "style")
        spoken = ("aria-label", "alt", "title", "placeholder")
        self.texts += [value for name, value in attrs if name in spoken and value]

    def handle_endtag(self, tag: str) -> None:
        self._raw = False

    def handle_data(self, data: str) -> None:
        if not self._raw:
            self.texts.append(data)
