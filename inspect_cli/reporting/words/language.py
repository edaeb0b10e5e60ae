"""Languages of a report: translations, formats of numbers, enumerations.

A catalogue (``languages/<code>.po``) translates the English templates of ``content.say`` and
``content.count``. English is its own catalogue. A template without a translation stays English; a
test holds the catalogues complete.
"""

from __future__ import annotations

import string
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources
from io import BytesIO
from typing import Any, get_args

from babel import Locale
from babel.lists import format_list
from babel.messages.pofile import read_po

from inspect_cli.reporting.words.text import (
    NOTHING,
    Amount,
    Badge,
    Chip,
    Joined,
    Lines,
    Link,
    Listed,
    Marked,
    Said,
    Text,
    exists,
)
from inspect_cli.schema.survey import LanguageCode

LANGUAGES: tuple[LanguageCode, ...] = get_args(LanguageCode)
LOCALES: Mapping[LanguageCode, str] = {"en": "en_GB", "de": "de_DE"}

MINUS = "\u2212"
THIN_SPACE = "\u202f"
"""Between thousands in every language (ISO 80000-1), because points and commas change sides."""

TEXT_TYPES = (Said, Amount, Joined, Listed, Marked, Chip, Badge, Link, Lines)


@dataclass(frozen=True)
class Language:
    """Turns pieces of text into words of one language."""

    code: LanguageCode
    decimal_sign: str
    phrases: Mapping[str, str | tuple[str, ...]]
    """Translations by their English; of a counted phrase, the singular and the plural."""

    def template(self, said: Said) -> str:
        """The sentence in this language, its {names} still open."""
        translated = self.phrases.get(said.template) or (said.template, said.many)
        if isinstance(translated, str):
            return translated
        return translated[0] if said.count == 1 or not translated[1] else translated[1]

    def number(self, amount: Amount) -> str:
        """The number with this language's decimal sign and a true minus."""
        value = amount.value
        if value is None or not exists(value):
            return NOTHING
        form = f"{value:.{amount.digits}g}" if amount.significant else f"{value:,.{amount.digits}f}"
        signs = {",": THIN_SPACE, ".": self.decimal_sign, "-": MINUS}
        return "".join(signs.get(character, character) for character in form)

    def enumeration(self, items: Iterable[str]) -> str:
        """ "1, 2 and 3", as this language joins them."""
        return str(format_list(list(items), locale=LOCALES[self.code]))

    def plain(self, text: Text) -> str:
        """The piece as words alone, without what sets it apart."""
        match text:
            case str():
                return text
            case Said():
                filled = {name: self.plain(value) for name, value in text.values.items()}
                return self.template(text).format_map(filled)
            case Amount():
                return self.number(text)
            case Joined(parts):
                return "".join(map(self.plain, parts))
            case Listed(items):
                return self.enumeration(map(self.plain, items))
            case Lines(items):
                return " ".join(map(self.plain, items))
            case Marked() | Chip() | Badge() | Link():
                return self.plain(text.text)

    def resolved(self, value: Any) -> Any:
        """A figure's JSON with every piece of text in it put into words."""
        if isinstance(value, TEXT_TYPES):
            return self.plain(value)
        if isinstance(value, Mapping):
            return {key: self.resolved(item) for key, item in value.items()}
        if isinstance(value, list | tuple):
            return [self.resolved(item) for item in value]
        return value


def pieces(template: str) -> list[tuple[str, str | None]]:
    """A template as (text, name of the value that follows it or None)."""
    return [(text, name) for text, name, _, _ in string.Formatter().parse(template)]


@cache
def language(code: LanguageCode) -> Language:
    """The language of this code."""
    sign = str(Locale.parse(LOCALES[code]).number_symbols["latn"]["decimal"])
    return Language(code, sign, {} if code == "en" else _phrases(code))


def _phrases(code: LanguageCode) -> dict[str, str | tuple[str, ...]]:
    file = resources.files(__package__).joinpath("languages", f"{code}.po")
    found: dict[str, str | tuple[str, ...]] = {}
    for message in read_po(BytesIO(file.read_bytes()), locale=code):
        if not message.id or not message.string or message.fuzzy:
            continue
        key = message.id if isinstance(message.id, str) else message.id[0]
        found[key] = message.string if isinstance(message.string, str) else tuple(message.string)
    return found
