"""Names in files that spreadsheets open: none of them may run as a formula.

A text that begins with = + - or @ (or a tab or a line break, which some programs skip) gets an
apostrophe before it, the spreadsheets' own mark for text; so does one that begins with
apostrophes before such a character, so that reading takes back exactly what writing put there.
"""

from __future__ import annotations

import re

_RISKY = re.compile(r"'*[=+\-@\t\r\n]")


def defused(text: str) -> str:
    """The text as a cell that is safe to open."""
    return f"'{text}" if _RISKY.match(text) else text


def undefused(text: str) -> str:
    """What ``defused`` was given."""
    return text[1:] if text.startswith("'") and _RISKY.match(text) else text
