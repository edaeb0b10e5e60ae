"""HTML that is escaped by construction.

``element("td", label)`` escapes its text; only what is ``Markup`` already goes in as it is. So
a mission's title, a point's label or a failure's reason cannot become part of the page's code.
"""

from __future__ import annotations

import html
import json
from typing import Any


class Markup(str):
    """Text that is HTML already."""

    __slots__ = ()


def escaped(text: str) -> Markup:
    """The text as HTML; markup stays what it is, and NUL, which HTML forbids, gets a sign."""
    return text if isinstance(text, Markup) else Markup(html.escape(text.replace("\0", "\ufffd")))


def joined(*parts: str) -> Markup:
    """Several pieces one after the other."""
    return Markup("".join(escaped(part) for part in parts))


def element(name: str, *children: str, **attributes: str) -> Markup:
    """One element; ``class_`` and ``aria_label`` become ``class`` and ``aria-label``."""
    written = "".join(
        f' {key.rstrip("_").replace("_", "-")}="{escaped(str(value))}"'
        for key, value in attributes.items()
    )
    return Markup(f"<{name}{written}>{joined(*children)}</{name}>")


def data_script(value: Any, **attributes: str) -> Markup:
    """A value as JSON inside a script element that no browser executes.

    ``<``, ``>`` and ``&`` are written as ``\\u003c`` and so on: JSON reads them back, and no
    ``</script>`` or ``<!--`` can end or change the element.

    Raises:
        ValueError: the value holds NaN or an infinity, which JSON cannot write.
    """
    text = json.dumps(value, allow_nan=False, separators=(",", ":"))
    for character in "<>&":
        text = text.replace(character, f"\\u{ord(character):04x}")
    return element("script", Markup(text), type="application/json", **attributes)
