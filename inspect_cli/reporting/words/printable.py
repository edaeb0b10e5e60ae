"""Text of users made printable: one line, no control characters, long words breakable."""

from __future__ import annotations

import re
import unicodedata

REPLACEMENT = "\ufffd"
BREAK = "\u200b"
LONGEST_WORD = 28
"""A longer run without a blank is given places to break at; no column is narrower than that."""
BLANKS = re.compile(r"[ \t\n\r\f\v]+")
DIRECTIONS = frozenset("\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069")
"""Controls that turn the direction of whatever follows, and so of words that are not theirs."""
SEAMS = frozenset("/_.,;:-=&?#@|")


def printable(text: str) -> str:
    """The text as one line: blanks joined as HTML joins them, what has no shape replaced.

    Controls, halves of surrogate pairs, numbers that are no characters and the explicit controls
    of direction become U+FFFD; letters that run from right to left keep doing so.
    """
    return "".join(map(_shown, BLANKS.sub(" ", text)))


def shortened(text: str, length: int) -> str:
    """The text, cut off with an ellipsis if it is longer than the given number of letters."""
    return text if len(text) <= length else f"{text[: length - 1]}…"


def _shown(character: str) -> str:
    known = unicodedata.category(character) not in ("Cc", "Cs")
    return character if known and not _is_no_character(character) else REPLACEMENT


def _is_no_character(character: str) -> bool:
    """Whether Unicode keeps the number free for ever, or its effect goes beyond its own text."""
    number = ord(character)
    free = number & 0xFFFE == 0xFFFE or 0xFDD0 <= number <= 0xFDEF
    return free or character in DIRECTIONS


def breakable(text: str) -> str:
    """Printable text whose overlong words may be broken, after a sign between words if there is
    one, else anywhere.
    """
    return " ".join(
        word if len(word) <= LONGEST_WORD else _broken(word) for word in text.split(" ")
    )


def _broken(word: str) -> str:
    pieces, length = [], 0
    for character in word:
        pieces.append(character)
        length += 1
        if (character in SEAMS and length > 3) or length >= LONGEST_WORD // 2:
            pieces.append(BREAK)
            length = 0
    return "".join(pieces).removesuffix(BREAK)
