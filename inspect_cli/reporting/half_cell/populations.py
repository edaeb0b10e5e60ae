"""The one or two normal populations that an assessment found, as curves."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from inspect_cli.reporting.figures.palette import BLUE, INK, VERMILION, LineStyle
from inspect_cli.reporting.words.text import Text, number, say
from inspect_cli.schema.assessment import MixtureFindings, SurfaceAssessment
from inspect_cli.spatial.arrays import Vector

ACTIVE = LineStyle(say("active population"), VERMILION, "dash", 2.0)
PASSIVE = LineStyle(say("passive population"), BLUE, "dot", 2.0)
BOTH = LineStyle(say("both together"), INK, "solid", 1.8)
ALONE = LineStyle(say("one normal population"), INK, "solid", 1.6)
BAND = "rgba(204, 121, 167, 0.28)"
BAND_EDGE = "#8e4a72"


@dataclass(frozen=True)
class Curve:
    """A sum of normal populations: shares, means and standard deviations, mV."""

    style: LineStyle
    parts: tuple[tuple[float, float, float], ...]

    def above(self, mv: Vector) -> Vector:
        """The share of its readings that are at least as positive as each of ``mv``."""
        from scipy.special import ndtr

        total = sum(share for share, _, _ in self.parts)
        terms = (share * ndtr((mean - mv) / sd) for share, mean, sd in self.parts)
        return np.asarray(sum(terms)) / total

    def density(self, mv: Vector) -> Vector:
        """Readings of all readings per mV."""
        terms = (
            share * np.exp(-0.5 * ((mv - mean) / sd) ** 2) / (sd * np.sqrt(2.0 * np.pi))
            for share, mean, sd in self.parts
        )
        return np.asarray(sum(terms))


def curves_of(summary: SurfaceAssessment) -> list[Curve]:
    """Both populations and their sum; the one population; nothing where none was fitted."""
    mixture, potential = summary.mixture, summary.potential
    if mixture.active is not None and mixture.passive is not None:
        active, passive = ((p.share, p.mean_mv, p.sd_mv) for p in (mixture.active, mixture.passive))
        both = Curve(BOTH, (active, passive))
        return [Curve(ACTIVE, (active,)), Curve(PASSIVE, (passive,)), both]
    if mixture.verdict is None or potential is None or not potential.sd_mv:
        return []
    return [Curve(ALONE, ((1.0, potential.mean_mv, potential.sd_mv),))]


def threshold_text(mixture: MixtureFindings) -> Text:
    """The threshold between both populations with its standard error."""
    if mixture.threshold_error_mv is None:
        return say("threshold {mv} mV", mv=number(mixture.threshold_mv, 0))
    return say(
        "threshold {mv} ± {error} mV",
        mv=number(mixture.threshold_mv, 0),
        error=number(mixture.threshold_error_mv, 0),
    )
