"""``specimen: {model: macro_cell}``: what it refuses, where, and that it comes back."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from inspect_cli.schema.truth import TrueSurface

Refusal = Callable[[str, str], list[str]]

WHOLE = "specimen: {model: grid, potential_mv: ../data/p.csv, resistivity_kohm_cm: ../data/r.csv,"
PLACE = "truth.structure.wall.specimen"


@pytest.mark.parametrize(
    ("entries", "message"),
    [
        ("", f"m.yaml:25:7: {PLACE}: missing key 'cover_m'"),
        ("cover_mm: 30", f"m.yaml:25:37: {PLACE}.cover_mm: unknown key 'cover_mm'\n"),
        ("cover_m: 0.3", f"m.yaml:25:17: {PLACE}: cover_m 0.3 must leave the bars of 0.012 m"),
        ("cover_m: 0.005", f"{PLACE}: cover_m 0.005 must leave the bars of 0.012 m inside"),
        ("cover_m: -0.1", f"m.yaml:25:46: {PLACE}.cover_m: must be above 0; found -0.1"),
        (
            "cover_m: 0.03, bars: {spacing_m: 0.02}",
            f"{PLACE}.bars: spacing_m 0.02 must be above π times diameter_m, 0.0377",
        ),
        ("cover_m: 0.03, bars: {directions: 3}", f"m.yaml:25:71: {PLACE}.bars.directions: "),
        ("cover_m: 0.03, temperature_c: 60", f"{PLACE}.temperature_c: must be at most 49"),
        (
            "cover_m: 0.03, sites: [{at_m: [0, 0], radius_m: 0.01}]",
            f"{PLACE}: a site of radius_m 0.01 lies between nodes 0.02 m apart",
        ),
        (
            "cover_m: 0.03, sites: [{at_m: [0, 0], radius_m: 0}]",
            f"m.yaml:25:85: {PLACE}.sites[0].radius_m: must be above 0; found 0",
        ),
        (
            "cover_m: 0.03, size_m: [1, 1], sites: [{at_m: [0, 0.6], radius_m: 0.1}]",
            f"{PLACE}: the site at [0.0, 0.6] lies outside of the modelled 1 m × 1 m",
        ),
        (
            "cover_m: 0.03, size_m: [20, 20]",
            "every 0.02 m are too many nodes: give a resolution_m of at least 0.052",
        ),
        (
            "cover_m: 0.03, active: {rest_v: -0.6, current_uapcm2: 1, anodic_slope_vpdec: 0.06,"
            " cathodic_slope_vpdec: 0.1}",
            "the key is 'current_apm2', in A/m²: write current_apm2: 0.01",
        ),
        (
            "cover_m: 0.03, active: {rest_v: -0.6, current_apm2: 1, anodic_slope_vpdec: 0.001,"
            " cathodic_slope_vpdec: 0.1}",
            f"{PLACE}.active.anodic_slope_vpdec: must be at least 0.02; found 0.001",
        ),
        (
            "cover_m: 0.03, resistivity_ohm_m: 1e-9",
            f"m.yaml:25:71: {PLACE}.resistivity_ohm_m: must be at least 1; found 1e-09",
        ),
        (
            "cover_m: 0.03, resistivity_ohm_m: 1e7",
            f"{PLACE}.resistivity_ohm_m: must be at most 1e+06",
        ),
        ("cover_m: 1.2, thickness_m: 3", f"{PLACE}.cover_m: must be at most 1; found 1.2"),
        ("cover_m: 0.03, thickness_m: 1e9", f"{PLACE}.thickness_m: must be at most 10; found"),
        (
            "cover_m: 0.03, bars: {diameter_m: 1e-9}",
            f"{PLACE}.bars.diameter_m: must be at least 0.001",
        ),
        (
            "cover_m: 0.03, sites: [{at_m: [0, 0], radius_m: 0.1, resistivity_factor: 1e-9}]",
            f"{PLACE}: resistivity_factor 1e-09 at [0.0, 0.0] makes 2e-07 Ω·m of resistivity_ohm_m",
        ),
        (
            "cover_m: 0.03, resistivity_ohm_m: 1e3,"
            " moisture: [{at_m: [0, 0], radius_m: 0.1, resistivity_factor: 1e4}]",
            "makes 1e+07 Ω·m of resistivity_ohm_m 1000: concrete has 1 to 1e+06",
        ),
        (
            "cover_m: 0.03, thickness_m: 10, size_m: [0.3, 0.3], resolution_m: 0.002",
            "0.3 m × 0.3 m every 0.002 m are too many nodes: give a resolution_m of at least",
        ),
        ("cover_m: 0.03, spots: []", f"{PLACE}.spots: unknown key 'spots'"),
    ],
)
def test_what_is_wrong_is_said_where_it_stands(
    refusal: Refusal, entries: str, message: str
) -> None:
    new = f"specimen: {{model: macro_cell, {entries}}}\n      moved: {{translate_m:"
    found = refusal(WHOLE + "\n                 pitch_m: 0.1}", new + " [0, 0, 0]}")
    assert any(message in problem for problem in found), found


def test_concrete_thicker_than_the_pier_is_refused_with_its_geometry(refusal: Refusal) -> None:
    new = (
        "geometry: {kind: cylinder, center_m: [3, 0, 1], axis: [0, 0, 1], radius_m: 0.2,"
        " facing: [-1, 0, 0], size_m: [0.5, 0.5]}\n"
        "      specimen: {model: macro_cell, cover_m: 0.03}"
    )
    (found,) = refusal(WHOLE + "\n                 pitch_m: 0.1}", new)
    assert "m.yaml:24:7: truth.structure.wall: thickness_m 0.2 must be at most 0.9 times" in found
    assert "the cylinder's radius_m 0.2" in found


def test_it_comes_back() -> None:
    text = """{"specimen": {"model": "macro_cell", "cover_m": 0.04, "size_m": [2, 1],
        "bars": {"spacing_m": 0.2, "directions": 1},
        "sites": [{"at_m": [0.1, 0], "radius_m": 0.05, "resistivity_factor": 0.3}],
        "moisture": [{"at_m": [0, 0], "radius_m": 0.3, "resistivity_factor": 0.5}],
        "active": {"rest_v": -0.6, "current_apm2": 0.02, "anodic_slope_vpdec": 0.07,
                   "cathodic_slope_vpdec": 0.12, "limit_apm2": null}}}"""
    surface = TrueSurface.model_validate_json(text)
    assert TrueSurface.model_validate_json(surface.model_dump_json()) == surface
