"""Maps to scale, such as 1 : 50, with a scale bar."""

from __future__ import annotations

from dataclasses import dataclass

from matplotlib.figure import Figure as Sheet
from matplotlib.patches import Rectangle

from inspect_cli.reporting.figures.figure import Json
from inspect_cli.reporting.figures.palette import INK
from inspect_cli.reporting.words.language import Language
from inspect_cli.reporting.words.text import Text, number, say

SCALES = tuple(m * 10**power for power in range(6) for m in (1, 2, 5, *((2.5,) if power else ())))
"""1 : 1, 1 : 2, 1 : 5, 1 : 10, 1 : 20, 1 : 25, 1 : 50 and so on, ISO 5455's with 25 and 250."""
BAR_SHARES = (0.08, 0.2)
"""Least and greatest length of a scale bar, of the drawing's width: words stand beside it."""
BAR_HEIGHT_MM = 1.3


@dataclass(frozen=True)
class MapScale:
    """A scale of 1 to ``denominator``."""

    denominator: float

    def millimetres(self, length_m: float) -> float:
        """How long a length is on paper."""
        return 1e3 * length_m / self.denominator

    def words(self) -> Text:
        """The scale in words, for the caption of the map."""
        return say("Scale 1 : {n}, printed at full size", n=number(self.denominator, 0))


def has_equal_scales(layout: Json) -> bool:
    """Whether both axes have the same scale, as in a map."""
    for name, axis in layout.items():
        if name.startswith(("xaxis", "yaxis")) and "scaleanchor" in axis:
            return float(axis.get("scaleratio", 1.0)) == 1.0
    return False


def scale_for(
    width_m: float, height_m: float, room_mm: tuple[float, float], least: float = 1.0
) -> MapScale:
    """The largest round scale at which the drawing fits, its denominator ``least`` or more."""
    for denominator in sorted(n for n in SCALES if n >= least):
        scale = MapScale(float(denominator))
        fits = (
            scale.millimetres(width_m) <= room_mm[0] and scale.millimetres(height_m) <= room_mm[1]
        )
        if fits:
            return scale
    return MapScale(max(least, 1e3 * width_m / room_mm[0], 1e3 * height_m / room_mm[1]))


def bar_length_m(scale: MapScale, width_mm: float) -> float:
    """A round length for the scale bar, m."""
    for power in range(-4, 6):
        for m in (1.0, 2.0, 5.0):
            length = m * 10.0**power
            if BAR_SHARES[0] <= scale.millimetres(length) / width_mm <= BAR_SHARES[1]:
                return length
    return 1.0


def draw_scale_bar(
    sheet: Sheet,
    scale: MapScale,
    place_mm: tuple[float, float],
    size_mm: tuple[float, float],
    language: Language,
) -> None:
    """Four fields, black and white by turns, with the ends' lengths and the scale in words."""
    length = bar_length_m(scale, size_mm[0])
    left, bottom = place_mm
    for k in range(4):
        quarter = scale.millimetres(length) / 4.0
        sheet.add_artist(
            Rectangle(
                ((left + k * quarter) / size_mm[0], bottom / size_mm[1]),
                quarter / size_mm[0],
                BAR_HEIGHT_MM / size_mm[1],
                facecolor=INK if k % 2 == 0 else "white",
                edgecolor=INK,
                linewidth=0.5,
            )
        )
    small = length < 0.1
    shown, unit, digits = (1e3 * length, "mm", 0) if small else (length, "m", int(length < 1.0))
    right = left + scale.millimetres(length)
    texts = (
        (left, "0", "center"),
        (right, f"{language.plain(number(shown, digits))} {unit}", "center"),
    )
    for x, text, ha in texts:
        sheet.text(
            x / size_mm[0],
            (bottom + BAR_HEIGHT_MM + 0.8) / size_mm[1],
            text,
            ha=ha,
            va="bottom",
            fontsize=7.0,
            color=INK,
        )
    sheet.text(
        (right + 8.0) / size_mm[0],
        (bottom + 0.5 * BAR_HEIGHT_MM) / size_mm[1],
        language.plain(scale.words()),
        ha="left",
        va="center",
        fontsize=7.5,
        color=INK,
    )
