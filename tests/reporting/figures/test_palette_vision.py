"""Colours stay apart for every common kind of colour blindness, and are never alone.

Dichromats' vision after Machado, Oliveira & Fernandes, "A physiologically-based model for
simulation of color vision deficiency", IEEE TVCG 15(6), 2009, severity 1.0, on linear RGB.
Distances are ΔE*ab (CIE 1976); 2.3 is just noticeable (Mahy et al. 1994). Marks are a few pixels
large and lines thin, so that several times as much is asked for.
"""

from __future__ import annotations

from itertools import combinations, pairwise

import numpy as np
import pytest

from inspect_cli.reporting.figures import palette
from inspect_cli.reporting.figures.palette import (
    ASTM_STYLES,
    COMMAND,
    CORROSION_STYLES,
    ESTIMATE,
    INVALID_STYLE,
    POTENTIAL_STOPS,
    REFERENCE,
    SATURATED,
    SEEN_SURFACE,
    SENSOR,
    SENSOR_FILTERED,
    SENSOR_RAW,
    TRUE_SURFACE,
    TRUTH,
    LineStyle,
    trial_style,
)
from inspect_cli.spatial.arrays import Vector

VISIONS = {
    "all cones": np.eye(3),
    "protanopia": np.array(
        [
            [0.152286, 1.052583, -0.204868],
            [0.114503, 0.786281, 0.099216],
            [-0.003882, -0.048116, 1.051998],
        ]
    ),
    "deuteranopia": np.array(
        [
            [0.367322, 0.860646, -0.227968],
            [0.280085, 0.672501, 0.047413],
            [-0.011820, 0.042940, 0.968881],
        ]
    ),
    "tritanopia": np.array(
        [
            [1.255528, -0.076749, -0.178779],
            [-0.078411, 0.930809, 0.147602],
            [0.004733, 0.691367, 0.303900],
        ]
    ),
}
APART = 20.0
"""ΔE between classes, and between lines that only their colour tells apart."""
JOINT = 10.0
"""ΔE between the two colours that meet at a class's boundary on a potential map."""
TO_XYZ = np.array(
    [
        [0.4124564, 0.3575761, 0.1804375],
        [0.2126729, 0.7151522, 0.0721750],
        [0.0193339, 0.1191920, 0.9503041],
    ]
)
"""Linear sRGB to CIE XYZ under D65, IEC 61966-2-1."""

FIGURES = {
    "pose": (REFERENCE, ESTIMATE, TRUTH),
    "force": (SENSOR, ESTIMATE, TRUTH),
    "force sensor": (SENSOR_RAW, SENSOR_FILTERED, ESTIMATE, TRUTH),
    "actuators": (COMMAND, TRUTH, SATURATED),
    "side of a slide": (TRUE_SURFACE, REFERENCE, TRUTH, ESTIMATE, SEEN_SURFACE),
    "trials": tuple(trial_style(k) for k in range(4)),
}
"""Lines that are drawn in one figure."""


def lab(colour: str, vision: str) -> Vector:
    """CIELAB of a colour as it is seen."""
    coded = np.array([int(colour[k : k + 2], 16) for k in (1, 3, 5)]) / 255.0
    linear = np.where(coded <= 0.04045, coded / 12.92, ((coded + 0.055) / 1.055) ** 2.4)
    seen = np.clip(VISIONS[vision] @ linear, 0.0, 1.0)
    ratio = TO_XYZ @ seen / TO_XYZ.sum(axis=1)
    f = np.where(ratio > (6 / 29) ** 3, np.cbrt(ratio), ratio / (3 * (6 / 29) ** 2) + 4 / 29)
    return np.array([116.0 * f[1] - 16.0, 500.0 * (f[0] - f[1]), 200.0 * (f[1] - f[2])])


def apart(a: str, b: str, vision: str) -> float:
    """ΔE*ab of two colours as they are seen."""
    return float(np.linalg.norm(lab(a, vision) - lab(b, vision)))


def test_the_measure_knows_known_colours() -> None:
    """White, and red against green, which a deuteranope hardly tells apart by their hue."""
    assert lab("#ffffff", "all cones") == pytest.approx([100.0, 0.0, 0.0], abs=0.02)
    assert lab("#ff0000", "all cones") == pytest.approx([53.24, 80.09, 67.20], abs=0.05)
    for matrix in VISIONS.values():
        assert matrix.sum(axis=1) == pytest.approx(np.ones(3), abs=2e-6)
    for vision in ("protanopia", "deuteranopia"):
        assert apart("#a05a2c", "#6f7d28", vision) < 0.5 * apart("#a05a2c", "#6f7d28", "all cones")


@pytest.mark.parametrize("vision", VISIONS)
def test_classes_stay_apart(vision: str) -> None:
    for styles in (ASTM_STYLES, CORROSION_STYLES):
        every = [*styles.values(), INVALID_STYLE]
        for a, b in combinations(every, 2):
            assert apart(a.colour, b.colour, vision) >= APART, (a.label, b.label)
        assert len({style.symbol for style in every}) == len(every)


@pytest.mark.parametrize("vision", VISIONS)
@pytest.mark.parametrize("figure", FIGURES)
def test_lines_of_one_figure_stay_apart(figure: str, vision: str) -> None:
    for a, b in combinations(FIGURES[figure], 2):
        assert told_apart(a, b) or apart(a.colour, b.colour, vision) >= APART, (a.label, b.label)


def told_apart(a: LineStyle, b: LineStyle) -> bool:
    """Whether two lines differ without their colour: in dash, or one twice as wide."""
    return a.dash != b.dash or max(a.width, b.width) >= 2.0 * min(a.width, b.width)


@pytest.mark.parametrize("vision", VISIONS)
def test_a_potential_map_darkens_towards_corrosion(vision: str) -> None:
    stops = [colour for pair in POTENTIAL_STOPS.values() for colour in pair]
    lightness = [lab(colour, vision)[0] for colour in stops]
    within, across = pairwise(lightness), pairwise(POTENTIAL_STOPS.values())
    assert all(lighter > darker for lighter, darker in list(within)[::2])
    assert lightness[0] > lightness[2] > lightness[4]
    for above, below in across:
        assert apart(above[1], below[0], vision) >= JOINT


@pytest.mark.parametrize("vision", VISIONS)
def test_colours_of_studies_stay_apart(vision: str) -> None:
    """Curves of a study differ in marker and dash besides."""
    used = [palette.BLUE, palette.GREEN, palette.ORANGE, palette.INK]
    for a, b in combinations(used, 2):
        assert apart(a, b, vision) >= APART, (a, b)
