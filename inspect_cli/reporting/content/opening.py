"""What the openings of all documents share: the finding, and the lines to be signed."""

from __future__ import annotations

from collections.abc import Sequence

from inspect_cli.reporting.content.blocks import Block, Paragraph
from inspect_cli.reporting.words.text import Text, say, sentences, strong

SIGNED = (say("Place and date"), say("Name and signature of who answers for the evaluation"))
"""Lines to be signed in the report of a real structure."""


def finding(statements: Sequence[Text]) -> list[Block]:
    """The finding as one paragraph, its first sentence standing out."""
    if not statements:
        return []
    first, *rest = statements
    return [Paragraph(sentences([strong(first), *rest]), "finding")]
