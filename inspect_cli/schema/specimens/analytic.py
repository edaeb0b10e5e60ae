"""``model: analytic``: sound concrete with Gaussian active spots."""

from __future__ import annotations

from typing import Literal

from inspect_cli.schema.base import Positive, Strict
from inspect_cli.schema.specimens.base import SpecimenModel


class AnalyticSpot(Strict):
    """A Gaussian depression of potential around an active site, on the surface's (u, v)."""

    at_m: tuple[float, float]
    depth_v: Positive
    """How much more negative the potential is at the centre."""
    radius_m: Positive
    """Standard deviation of the Gaussian."""
    resistivity_factor: Positive = 1.0
    """Resistivity at the centre as a share of the sound concrete's."""


class AnalyticSpecimen(SpecimenModel):
    """Sound concrete with Gaussian active spots; potentials in V against copper sulphate."""

    model: Literal["analytic"]
    potential_v: float = -0.1
    resistivity_ohm_m: Positive = 200.0
    spots: tuple[AnalyticSpot, ...] = ()
