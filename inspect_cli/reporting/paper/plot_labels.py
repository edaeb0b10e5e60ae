"""Words in a drawing, line by line, with a halo where they lie upon other things."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.patheffects import Stroke
from matplotlib.text import Annotation
from matplotlib.transforms import Bbox

from inspect_cli.reporting.paper.plot_text import label_lines

PT_PER_PX = 0.62
"""Points per pixel of letters. A thousand pixels are 170 mm of paper, but letters must not shrink
as much."""
LINE_HEIGHT = 1.2
LEAST_PT = 6.0
KEPT_SHARE = 0.9
"""Share of a label's box that no other label may cover."""


def points(pixels: float) -> float:
    """A length on the screen as one on paper, in typographic points."""
    return PT_PER_PX * pixels


def font_points(pixels: float) -> float:
    """The size of a letter on paper; none is too small to read."""
    return max(LEAST_PT, points(pixels))


def write(
    ax: Axes,
    label: object,
    place: tuple[float, float],
    *,
    coordinates: Any = "data",
    shift: tuple[float, float] = (0.0, 0.0),
    ha: str = "center",
    va: str = "bottom",
    size: float = 7.0,
    colour: Any = "black",
    halo: bool = False,
    angle: float = 0.0,
) -> list[Annotation]:
    """Write a label at a place of the axes, ``shift`` points beside it; return its pieces.

    Each line is text of its own, because one of them may be bold. The halo is a drawing beneath
    the text, which itself stays text.
    """
    lines, written = label_lines(label), []
    step = LINE_HEIGHT * size
    height = step * (len(lines) - 1)
    top = {"bottom": height, "center": 0.5 * height, "top": 0.0}[va]
    for k, line in enumerate(lines):
        if not line.text.strip():
            continue
        offset = (shift[0], shift[1] + top - k * step)
        for beneath in (True, False) if halo else (False,):
            text = ax.annotate(
                line.text,
                place,
                offset,
                xycoords=coordinates,
                textcoords="offset points",
                ha=ha,
                va=va,
                fontsize=size,
                color="white" if beneath else colour,
                fontweight="bold" if line.bold else "normal",
                rotation=angle,
                parse_math=line.formula,
                annotation_clip=False,
                zorder=5.0 if beneath else 6.0,
            )
            if beneath:
                text.set_path_effects([Stroke(linewidth=1.8, foreground="white")])
            written.append(text)
    return written


def thin_out(labels: Sequence[Sequence[Annotation]]) -> None:
    """Hide each label that would overlap an earlier one: neither could be read."""
    kept: list[Bbox] = []
    for pieces in labels:
        boxes = [piece.get_window_extent() for piece in pieces]
        if not boxes:
            continue
        own = Bbox.union(boxes).shrunk(KEPT_SHARE, KEPT_SHARE)
        if any(own.overlaps(other) for other in kept):
            for piece in pieces:
                piece.set_visible(False)
        else:
            kept.append(own)
