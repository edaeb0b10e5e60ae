"""``specimen: {model: macro_cell}``: the concrete, its reinforcement and where it corrodes.

What is computed from it, and by which equations, stands in ``truth.macro_cell``.
"""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import Field, model_validator

from inspect_cli.schema.base import Positive, Strict
from inspect_cli.schema.geometry import CylinderShape, MeshShape, SphereShape, TrueShape
from inspect_cli.schema.specimens.base import SpecimenModel

MOST_NODES = 1_500_000
"""Of the surface times the layers in depth: beyond it a solution takes minutes."""
LAYERS_ABOVE, LAYERS_BELOW = 4, 6
"""Fewest layers between the surface and the steel, and between the steel and the back."""
LEAST_OHM_M, MOST_OHM_M = 1.0, 1e6
"""Concrete has some 5 Ω·m where it is saturated with chlorides, and 10⁵ Ω·m where it is dry."""

Extent = Annotated[float, Field(gt=0, le=1000)]
Factor = Annotated[float, Field(gt=0, le=MOST_OHM_M)]

TafelSlope = Annotated[float, Field(ge=0.02, le=1.0)]
"""V for ten times the current."""
Rest = Annotated[float, Field(ge=-1.5, le=0.5)]
CurrentDensity = Annotated[float, Field(gt=0, le=10)]


class Bars(Strict):
    """The mat of reinforcing bars."""

    spacing_m: Annotated[float, Field(gt=0, le=5)] = 0.15
    """From bar to bar."""
    diameter_m: Annotated[float, Field(ge=0.001, le=0.1)] = 0.012
    directions: Literal[1, 2] = 2
    """1: parallel bars; 2: a mat of bars that cross."""

    @model_validator(mode="after")
    def _apart(self) -> Bars:
        if self.spacing_m <= math.pi * self.diameter_m:
            raise ValueError(
                f"spacing_m {self.spacing_m:g} must be above π times diameter_m, "
                f"{math.pi * self.diameter_m:.3g}: closer bars do not let the current between them"
            )
        return self


class Kinetics(Strict):
    """How the steel's current density answers to its potential; at 22.2 °C."""

    rest_v: Rest
    """Potential against CSE at which isolated steel rests with ample oxygen."""
    current_apm2: CurrentDensity
    """Anodic current density at rest; 0.01 A/m² = 1 µA/cm²."""
    anodic_slope_vpdec: TafelSlope
    cathodic_slope_vpdec: TafelSlope
    limit_apm2: CurrentDensity | None = 0.05
    """Greatest cathodic current density that oxygen's diffusion allows; null for none."""


class ActiveSite(Strict):
    """A disc of the mat that is depassivated, under the surface's (u, v)."""

    at_m: tuple[float, float]
    radius_m: Positive
    resistivity_factor: Factor = 1.0
    """Resistivity over the middle as a share of the sound concrete's, as chlorides leave it; it
    returns as a Gaussian with the standard deviation ``radius_m``."""


class MoistSpot(Strict):
    """Concrete that is wetter (or drier) than the rest: a Gaussian over (u, v), all through."""

    at_m: tuple[float, float]
    radius_m: Positive
    """Standard deviation of the Gaussian."""
    resistivity_factor: Factor
    """Resistivity in the middle as a share of the sound concrete's."""
    oxygen_factor: Annotated[float, Field(ge=1e-4, le=10)] = 1.0
    """Limiting cathodic current in the middle as a share; water in the pores holds oxygen back. By
    itself a spot that is smaller than the wall hardly moves the potential of passive steel."""


class MacroCellSpecimen(SpecimenModel):
    """Active and passive steel in concrete, whose potential field is solved for."""

    model: Literal["macro_cell"]
    size_m: tuple[Extent, Extent] | None = None
    """Extent of the concrete along u and v; the whole surface without it. Its edges are
    insulated, beyond them nothing can be read."""
    at_m: tuple[float, float] = (0.0, 0.0)
    """(u, v) of the middle of that extent."""
    thickness_m: Annotated[float, Field(gt=0, le=10)] = 0.20
    cover_m: Annotated[float, Field(gt=0, le=1)]
    """From the surface to the middle of the mat."""
    resistivity_ohm_m: Annotated[float, Field(ge=LEAST_OHM_M, le=MOST_OHM_M)] = 200.0
    """Of the sound concrete at 20 °C."""
    bars: Bars = Bars()
    passive: Kinetics = Kinetics(
        rest_v=-0.12, current_apm2=2e-4, anodic_slope_vpdec=0.30, cathodic_slope_vpdec=0.16
    )
    active: Kinetics = Kinetics(
        rest_v=-0.65, current_apm2=0.01, anodic_slope_vpdec=0.075, cathodic_slope_vpdec=0.15
    )
    sites: tuple[ActiveSite, ...] = ()
    moisture: tuple[MoistSpot, ...] = ()
    resolution_m: Annotated[float, Field(ge=0.002, le=0.2)] = 0.02
    """Spacing of the nodes along the surface."""

    @model_validator(mode="after")
    def _mat_inside(self) -> MacroCellSpecimen:
        radius = 0.5 * self.bars.diameter_m
        if not radius < self.cover_m < self.thickness_m - radius:
            raise ValueError(
                f"cover_m {self.cover_m:g} must leave the bars of {self.bars.diameter_m:g} m "
                f"inside of thickness_m {self.thickness_m:g}"
            )
        return self

    @model_validator(mode="after")
    def _still_concrete(self) -> MacroCellSpecimen:
        spots: tuple[ActiveSite | MoistSpot, ...] = (*self.sites, *self.moisture)
        for spot in spots:
            there = self.resistivity_ohm_m * spot.resistivity_factor
            # A factor of 0.01 may leave 1 Ω·m to the last digit.
            if not LEAST_OHM_M * (1 - 1e-9) <= there <= MOST_OHM_M * (1 + 1e-9):
                raise ValueError(
                    f"resistivity_factor {spot.resistivity_factor:g} at {list(spot.at_m)} makes "
                    f"{there:g} Ω·m of resistivity_ohm_m {self.resistivity_ohm_m:g}: concrete "
                    f"has {LEAST_OHM_M:g} to {MOST_OHM_M:g}"
                )
        return self

    @model_validator(mode="after")
    def _sites_resolved(self) -> MacroCellSpecimen:
        for site in self.sites:
            if site.radius_m < self.resolution_m:
                raise ValueError(
                    f"a site of radius_m {site.radius_m:g} lies between nodes "
                    f"{self.resolution_m:g} m apart: give a resolution_m of at most its radius"
                )
        return self

    @model_validator(mode="after")
    def _sites_inside(self) -> MacroCellSpecimen:
        if self.size_m is None:
            return self
        refuse_sites_outside(self, self.size_m)
        refuse_too_many_nodes(self, self.size_m)
        return self

    def refuse_unfit(self, shape: TrueShape, extent_m: tuple[float, float] | None = None) -> None:
        """Raise ValueError where the concrete is too thick for the curve, or its sites or nodes do
        not fit its extent.
        """
        refuse_thicker_than_round(self, shape)
        size_m = self.size_m or (extent_m if isinstance(shape, MeshShape) else shape.size_m)
        if size_m is not None:
            refuse_sites_outside(self, size_m)
            refuse_too_many_nodes(self, size_m)


def refuse_sites_outside(specimen: MacroCellSpecimen, size_m: tuple[float, float]) -> None:
    """ValueError for a site whose middle is not within the extent ``size_m`` of the concrete."""
    for site in specimen.sites:
        for at, middle, size in zip(site.at_m, specimen.at_m, size_m, strict=True):
            if abs(at - middle) > 0.5 * size:
                raise ValueError(
                    f"the site at {list(site.at_m)} lies outside of the modelled "
                    f"{size_m[0]:g} m × {size_m[1]:g} m around {list(specimen.at_m)}"
                )


def layers(specimen: MacroCellSpecimen, resolution_m: float) -> tuple[int, int]:
    """How many layers of nodes there are above the steel, twice as fine, and below it."""
    above = math.ceil(2.0 * specimen.cover_m / resolution_m - 1e-9)
    below = math.ceil((specimen.thickness_m - specimen.cover_m) / resolution_m - 1e-9)
    return max(above, LAYERS_ABOVE), max(below, LAYERS_BELOW)


def refuse_too_many_nodes(specimen: MacroCellSpecimen, size_m: tuple[float, float]) -> None:
    """ValueError where the extent ``size_m`` at the resolution is more than can be solved."""

    def nodes(resolution_m: float) -> float:
        return sum(layers(specimen, resolution_m)) * size_m[0] * size_m[1] / resolution_m**2

    least = specimen.resolution_m
    if nodes(least) > MOST_NODES:
        while nodes(float(f"{least:.2g}")) > MOST_NODES and least < max(size_m):
            least *= 1.01
        raise ValueError(
            f"{size_m[0]:g} m × {size_m[1]:g} m every {specimen.resolution_m:g} m are too many "
            f"nodes: give a resolution_m of at least {least:.2g}, or a smaller size_m"
        )


def refuse_thicker_than_round(specimen: MacroCellSpecimen, shape: TrueShape) -> None:
    """ValueError for concrete that would reach to the axis or centre of a curved surface."""
    if not isinstance(shape, CylinderShape | SphereShape) or shape.side == "inside":
        return
    if specimen.thickness_m > 0.9 * shape.radius_m:
        raise ValueError(
            f"thickness_m {specimen.thickness_m:g} must be at most 0.9 times the "
            f"{shape.kind}'s radius_m {shape.radius_m:g}"
        )
