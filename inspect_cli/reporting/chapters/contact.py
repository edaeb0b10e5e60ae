"""Contacts without a reading: points that are pressed and not measured."""

from __future__ import annotations

from collections.abc import Iterator

from inspect_cli.reporting.chapters.chapter import Chapter
from inspect_cli.reporting.chapters.material import Material
from inspect_cli.reporting.chapters.shared import amount_in_words, metric_box
from inspect_cli.reporting.words.text import Text, count, say, significant


def _sentences(material: Material) -> Iterator[Text]:
    contacts = len(material.profile.contacts)
    force, amount = material.result.value("contact.force_mean_n"), amount_in_words(contacts)
    if force is None:
        yield count(
            contacts,
            "One point was pressed without a reading.",
            "{amount} points were pressed without a reading.",
            amount=amount,
        )
    else:
        yield count(
            contacts,
            "One point was pressed without a reading, on average with {force} N.",
            "{amount} points were pressed without a reading, on average with {force} N.",
            amount=amount,
            force=significant(force, 3),
        )


CHAPTER = Chapter(
    heading=say("Contact"),
    applies=lambda material: bool(material.profile.contacts),
    subjects=lambda material: [say("contact")],
    sentences=_sentences,
    boxes=lambda material: metric_box(
        material.result, say("mean contact force"), "contact.force_mean_n", "N"
    ),
    shared_groups=("contact", "guidance"),
)
