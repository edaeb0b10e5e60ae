"""A few readings with everything that exports have to carry."""

from __future__ import annotations

from inspect_cli.exchange.readings import HandedReadings
from inspect_cli.schema.result import PointResult


def point(index: int, **changes: object) -> PointResult:
    base: dict[str, object] = {
        "index": index,
        "label": f"P{index}",
        "valid": True,
        "reason": "",
        "p_W": (0.1 * index, 0.0, 0.3 + 0.1 * index),
        "surface": "deck" if index < 2 else "soffit",
        "uv_m": (0.1 * index, 0.3),
        "read_mv": -175.1 - 50 * index,
        "potential_mv": -250.1 - 50 * index,
        "potential_sd_mv": 4.5,
        "resistance_ohm": None,
        "resistivity_ohm_m": 100.0 / (index + 3),
        "probe_force_n": None,
        "contact_s": 0.0,
        "astm_class": "active" if index > 1 else "uncertain",
        "corrosion": "possible",
    }
    return PointResult.model_validate(base | changes)


def handed(*points: PointResult) -> HandedReadings:
    lost = point(
        3,
        label="=2+2",
        valid=False,
        reason="-50 mV of noise",
        uv_m=None,
        potential_mv=None,
        resistivity_ohm_m=None,
        astm_class=None,
        corrosion=None,
    )
    chosen = points or (point(0), point(1, label='Süd, "3"\n=1'), point(2), lost)
    return HandedReadings(
        chosen,
        title="Deck of the north ramp",
        structure="Brücke 12",
        date="2025-03-31",
        electrode="SCE",
    )
