"""Text and frames that are drawn into a picture: time, legend, close view."""

from __future__ import annotations

import io
from collections.abc import Sequence
from typing import Any

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from inspect_cli.pictures.script import LegendEntry

INK, MUTED, PAPER = (31, 35, 40), (89, 99, 110), (255, 255, 255)
EDGE_SHARE, LETTER_SHARE = 0.03, 0.033
"""Free edge and size of letters, as shares of the picture's height."""
PANEL_OPACITY = 215
STEP = 3
"""Step between the colour levels of a PNG file: invisible, and the file is much smaller. It divides
255, so that white stays white."""


def lettered(image: Any, line: str, legend: Sequence[LegendEntry]) -> Any:
    """The image (height, width, 3) uint8 with a line lower left and the legend lower right."""
    picture = Image.fromarray(image)
    height = picture.height
    edge = round(EDGE_SHARE * height)
    font = ImageFont.load_default(LETTER_SHARE * height)
    draw = ImageDraw.Draw(picture, "RGBA")
    if line:
        _panel(draw, (edge, height - edge), "left", font, [(line, None)])
    if legend:
        entries = [(entry.label, entry) for entry in legend]
        _panel(draw, (picture.width - edge, height - edge), "right", font, entries)
    return np.asarray(picture)


def with_inset(image: Any, inset: Any, on_right: bool) -> Any:
    """The image (height, width, 3) uint8 with a smaller one in an upper corner."""
    framed = np.full((inset.shape[0] + 4, inset.shape[1] + 4, 3), 255, dtype=np.uint8)
    framed[2:-2, 2:-2] = inset
    edge = round(EDGE_SHARE * image.shape[0])
    left = image.shape[1] - edge - framed.shape[1] if on_right else edge
    joined = image.copy()
    joined[edge : edge + framed.shape[0], left : left + framed.shape[1]] = framed
    return joined


def png_of(image: Any) -> bytes:
    """An image (height, width, 3) uint8 as a PNG file."""
    buffer = io.BytesIO()
    coarse = np.minimum((image.astype(np.uint16) + STEP // 2) // STEP * STEP, 255)
    Image.fromarray(coarse.astype(np.uint8)).save(buffer, "PNG", optimize=True)
    return buffer.getvalue()


def _panel(
    draw: ImageDraw.ImageDraw,
    corner: tuple[int, int],
    side: str,
    font: Any,
    entries: Sequence[tuple[str, LegendEntry | None]],
) -> None:
    """Entries in a row on a light panel, whose lower corner on ``side`` is at ``corner``."""
    size = font.size
    gap, sign = 0.6 * size, 0.8 * size
    widths = [
        font.getlength(text) + (sign + 0.5 * gap if entry else 0.0) for text, entry in entries
    ]
    width = sum(widths) + gap * (len(entries) + 1)
    left = corner[0] if side == "left" else corner[0] - width
    top = corner[1] - 1.7 * size
    draw.rounded_rectangle(
        (left, top, left + width, corner[1]), 0.35 * size, fill=(*PAPER, PANEL_OPACITY)
    )
    x, middle = left + gap, top + 0.85 * size
    for (text, entry), entry_width in zip(entries, widths, strict=True):
        at = x
        if entry:
            _sign(draw, x + 0.5 * sign, middle, 0.42 * sign, entry)
            at += sign + 0.5 * gap
        draw.text((at, middle), text, fill=INK, font=font, anchor="lm")
        x += entry_width + gap


def _sign(draw: ImageDraw.ImageDraw, x: float, y: float, radius: float, entry: LegendEntry) -> None:
    if entry.symbol == "square":
        half = 0.89 * radius
        draw.rectangle((x - half, y - half, x + half, y + half), fill=entry.colour)
    elif entry.symbol == "diamond":
        r = 1.26 * radius
        draw.polygon([(x - r, y), (x, y - r), (x + r, y), (x, y + r)], fill=entry.colour)
    else:
        r = radius if entry.symbol == "circle" else 0.6 * radius
        draw.ellipse((x - r, y - r, x + r, y + r), fill=entry.colour)
