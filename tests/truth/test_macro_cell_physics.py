"""What a macro cell reads: oracles of the physics, limits, extremes, and what it depends on."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from cells import SITE, WALL, read_along_u, solved, specimen

from inspect_cli.errors import InputError
from inspect_cli.schema.specimens.macro_cell import ActiveSite, Bars, Kinetics, MoistSpot
from inspect_cli.truth.macro_cell.newton import Joint, solve_potentials
from inspect_cli.truth.macro_cell.patch import Patch
from inspect_cli.truth.macro_cell.solution import (
    active_shares,
    resistivity_at,
    solve_cell,
    surface_nodes,
    surface_reading,
)
from inspect_cli.truth.macro_cell.steel import Steel, branches

STEEP = Kinetics(rest_v=-0.65, current_apm2=5.0, anodic_slope_vpdec=0.02, cathodic_slope_vpdec=0.02)
EXTREMES: list[dict[str, Any]] = [
    {"resistivity_ohm_m": 1.0},
    {"resistivity_ohm_m": 1e6},
    {"sites": (ActiveSite(at_m=(0.013, -0.007), radius_m=0.025),)},
    {"sites": (ActiveSite(at_m=(0.0, 0.0), radius_m=0.4, resistivity_factor=0.01),)},
    {"active": STEEP},
    {"active": STEEP, "resistivity_ohm_m": 1e5},
    {"moisture": (MoistSpot(at_m=(0.1, 0.1), radius_m=0.2, resistivity_factor=0.01),)},
    {"moisture": (MoistSpot(at_m=(0, 0), radius_m=0.3, resistivity_factor=5, oxygen_factor=1e-4),)},
    {"bars": Bars(spacing_m=1.0, diameter_m=0.006, directions=1)},
    {"bars": Bars(spacing_m=0.04, diameter_m=0.0127)},
    {"cover_m": 0.0061, "thickness_m": 0.013},
    {"cover_m": 0.15, "thickness_m": 2.0},
]


def test_spots_that_leave_no_concrete_are_refused() -> None:
    spot = MoistSpot(at_m=(0.0, 0.0), radius_m=0.3, resistivity_factor=0.01)
    with pytest.raises(InputError, match=r"leave resistivities of 1\.\d+e-08 to"):
        solved(moisture=(spot,) * 5)


@pytest.mark.parametrize("entries", [{}, *EXTREMES])
def test_what_the_anodes_give_the_cathodes_take(entries: dict[str, Any]) -> None:
    cell = solved(**entries)
    anodic, cathodic = cell.charge
    assert abs(anodic - cathodic) < 1e-6 * anodic
    rest = cell.steel.rest()
    for potentials in (cell.potentials.concrete, cell.potentials.bars):
        assert rest.min() <= potentials.min() <= potentials.max() <= rest.max()
    assert cell.potentials.steps < 40


def test_without_a_site_the_steel_rests() -> None:
    cell = solved(sites=())
    # The limit of oxygen, 250 times the current at rest, draws it down by less than a millivolt.
    assert np.ptp(cell.potentials.concrete) < 1e-6
    assert cell.potentials.concrete.mean() == pytest.approx(-0.12, abs=1e-3)


def test_deeper_cover_flattens_the_minimum() -> None:
    cells = [solved(cover_m=cover) for cover in (0.02, 0.04, 0.07)]
    minima = [float(cell.potentials.concrete[0].min()) for cell in cells]
    contrasts = [read_along_u(cell, 0.2) - read_along_u(cell, 0.0) for cell in cells]
    assert minima == sorted(minima)
    assert contrasts == sorted(contrasts, reverse=True)
    assert contrasts[-1] < 0.7 * contrasts[0]


def test_higher_resistivity_makes_the_minimum_narrower() -> None:
    widths = [half_width(rho) for rho in (30.0, 100.0, 300.0, 1000.0)]
    assert widths == sorted(widths, reverse=True)


def half_width(resistivity_ohm_m: float) -> float:
    """Where E along u is half way between its minimum and its greatest value, m."""
    cell = solved(resistivity_ohm_m=resistivity_ohm_m)
    u = cell.concrete.u[cell.concrete.u >= 0.0]
    E = np.array([read_along_u(cell, at) for at in u])
    return float(np.interp(0.5 * (E[0] + E.max()), E, u))


def test_higher_resistivity_leaves_the_anode_itself_more_negative() -> None:
    bars = [
        float(solved(resistivity_ohm_m=rho).potentials.bars[0, 16, 16])
        for rho in (30.0, 100.0, 300.0, 1000.0)
    ]
    assert bars == sorted(bars, reverse=True)
    assert bars[0] - bars[-1] > 0.03


def test_at_the_surface_only_wide_sites_show_it() -> None:
    """A site wide against its cover is read more negative with resistivity, like its bars.

    Over a narrow one the share of its potential that reaches the surface falls as much as the
    potential itself does: the reading hardly depends on the resistivity.
    """
    minima = {
        radius_m: [
            read_along_u(
                solved(
                    Patch((1.6, 1.6)),
                    resistivity_ohm_m=rho,
                    sites=(ActiveSite(at_m=(0.0, 0.0), radius_m=radius_m),),
                ),
                0.0,
            )
            for rho in (30.0, 200.0, 1000.0)
        ]
        for radius_m in (0.05, 0.15)
    }
    assert minima[0.15] == sorted(minima[0.15], reverse=True)
    assert np.ptp(minima[0.15]) > 0.02
    assert np.ptp(minima[0.05]) < 0.02


@pytest.mark.parametrize("kind", ["cylinder", "sphere"])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_curved_surface_tends_to_a_plane(kind: Any, side: float) -> None:
    flat = solved().potentials.concrete[0]
    apart = []
    for radius in (1.0, 10.0, 100.0):
        patch = Patch(WALL.size_m, kind, side / radius)
        apart.append(float(np.abs(solved(patch).potentials.concrete[0] - flat).max()))
    assert apart[0] > 5e-4
    # Either to the first order of 1/R (thickness) or to the second (the sphere's meridians).
    assert apart[1] < apart[0] / 8.0
    assert apart[2] < apart[1] / 8.0


def test_the_default_resolution_is_as_good_as_a_voltmeter() -> None:
    """Errors of a reading of 10 mV, the standard's rounding, are what half-cells repeat to."""
    for at in ((0.0, 0.0), (0.013, -0.007)):
        site = ActiveSite(at_m=at, radius_m=0.05)
        coarse, fine = (
            solve_cell(specimen(sites=(site,), resolution_m=r), Patch((0.4, 0.4)))
            for r in (0.02, 0.01)
        )
        difference = coarse.potentials.concrete[0] - fine.potentials.concrete[0, ::2, ::2]
        assert np.abs(difference).max() < 5e-3


def test_temperature_shifts_the_reading_against_the_standards_correction() -> None:
    """Readings at T, corrected by +0.9 mV/K (T − 22.2 °C), are those of concrete at 22.2 °C."""
    plain = specimen(sites=(), temperature_c=22.2)
    reading = surface_reading(plain, WALL)
    for celsius in (5.0, 40.0):
        other = surface_reading(plain.model_copy(update={"temperature_c": celsius}), WALL)
        corrected = other + 0.9e-3 * (celsius - 22.2)
        assert np.abs(corrected - reading).max() < 1e-9
        assert (other < reading).all() == (celsius > 22.2)


def test_warm_concrete_conducts_better() -> None:
    """Polder, RILEM TC 154-EMC: 3 to 5 % for each kelvin around 20 °C."""
    u, v = surface_nodes(specimen(sites=()), WALL)
    at = {
        celsius: float(resistivity_at(specimen(sites=(), temperature_c=celsius), u, v)[0, 0])
        for celsius in (19.5, 20.0, 20.5)
    }
    assert at[20.0] == pytest.approx(200.0)
    assert 0.03 < math.log(at[19.5] / at[20.5]) < 0.05


def test_saturated_concrete_is_negative_without_corrosion() -> None:
    """All of the wall starved: i₀ 10^((E − E₀)/β_a) = i_L, 480 mV below the rest.

    A wet spot in a dry wall shows little of it: the little current that its passive steel lacks
    comes from around.
    """
    wet = MoistSpot(at_m=(0.0, 0.0), radius_m=5e3, resistivity_factor=0.3, oxygen_factor=1e-4)
    cell = solved(sites=(), moisture=(wet,))
    expected = -0.12 + 0.30 * math.log10(0.05e-4 / 2e-4)
    assert cell.potentials.concrete == pytest.approx(expected, abs=2e-3)
    assert expected < -0.35
    assert cell.joint.steel_area[0].max() < 1e-12
    # With one polarisation curve for all passive steel no starved spot looks active.
    for radius_m, drawn_v in ((0.1, 1e-3), (0.3, 3e-3)):
        spot = solved(sites=(), moisture=(wet.model_copy(update={"radius_m": radius_m}),))
        assert -0.12 - drawn_v < spot.potentials.concrete.min() < -0.12


def test_moisture_and_chlorides_lower_the_resistivity_where_they_are() -> None:
    site = ActiveSite(at_m=(0.1, 0.0), radius_m=0.05, resistivity_factor=0.3)
    wet = MoistSpot(at_m=(-0.2, 0.1), radius_m=0.1, resistivity_factor=0.5)
    model = specimen(sites=(site,), moisture=(wet,), temperature_c=20.0)
    at = resistivity_at(model, np.array([0.1, -0.2, 0.4]), np.array([0.0, 0.1]))
    far = 1.0 - 0.5 * math.exp(-(0.3**2 + 0.1**2) / 0.02)
    assert at[0, 0] == pytest.approx(200.0 * 0.3 * far)
    assert at[1, 1] == pytest.approx(100.0, rel=1e-6)


def test_sites_keep_their_area_and_overlap_without_counting_twice() -> None:
    for at in ((0.0, 0.0), (0.0131, -0.0077)):
        for sites in ((0.05,), (0.05, 0.03)):
            model = specimen(sites=tuple(ActiveSite(at_m=at, radius_m=r) for r in sites))
            shares = active_shares(model, *surface_nodes(model, WALL))
            assert shares.sum() * 0.025**2 == pytest.approx(np.pi * 0.05**2, rel=0.03)


def test_branches_are_tafel_lines_with_a_limit() -> None:
    kinetics = Kinetics(
        rest_v=-0.6,
        current_apm2=0.01,
        anodic_slope_vpdec=0.06,
        cathodic_slope_vpdec=0.12,
        limit_apm2=0.5,
    )
    E = np.array([[-0.54, -0.72, -3.0]])
    anodic, cathodic, _ = branches(kinetics, E, np.ones_like(E))
    assert anodic[0] == pytest.approx([0.1, 1e-4, 0.0], abs=1e-12)
    assert cathodic[0, 1] == pytest.approx(1.0 / (1.0 / 0.1 + 1.0 / 0.5))
    assert cathodic[0, 2] == pytest.approx(0.5)
    above, below = (branches(kinetics, E + step, np.ones_like(E)) for step in (1e-6, -1e-6))
    numeric = (above[0] - above[1] - below[0] + below[1]) / 2e-6
    assert branches(kinetics, E, np.ones_like(E))[2] == pytest.approx(numeric, rel=1e-6, abs=1e-9)


def test_steel_that_never_settles_is_refused() -> None:
    cell = solved()

    class Restless(Steel):
        def current(self, E: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            return np.where(np.sin(1e9 * E) > 0.0, 1.0, -1.0), np.full_like(E, 1e-3)

    restless = Restless(cell.steel.kinetics, cell.steel.oxygen)
    joint = Joint(cell.joint.steel_area, cell.joint.conductance)
    with pytest.raises(InputError, match="did not settle"):
        solve_potentials(cell.concrete, joint, restless, bounds_v=(-1.0, 0.0))


def test_the_site_is_where_it_was_put() -> None:
    cell = solved(sites=(SITE.model_copy(update={"at_m": (-0.2, 0.1)}),))
    row, column = np.unravel_index(cell.potentials.concrete[0].argmin(), (33, 33))
    assert (cell.concrete.u[column], cell.concrete.v[row]) == pytest.approx((-0.2, 0.1))
