"""Classes of points in words, each with the colour of its class."""

from __future__ import annotations

from inspect_cli.reporting.words.recorded import recorded
from inspect_cli.reporting.words.text import NOTHING, Chip, Text, say


def class_chip(name: str | None) -> Text:
    """The class in words with its colour; ``none`` corrosion has the passive class's."""
    if name is None:
        return NOTHING
    kind = {"none": "passive", "possible": "uncertain"}.get(name, name)
    return Chip(class_word(name), kind)


def class_word(name: str) -> Text:
    """The class in words; of a verdict ``none`` no more than that nothing indicates corrosion."""
    return say("not indicated") if name == "none" else recorded(name)
