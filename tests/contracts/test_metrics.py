"""What every entry of ``METRICS`` keeps to."""

from __future__ import annotations

from pathlib import Path

import pytest
from modes import TABLE_JSON

from inspect_cli.commands.plan import plan_loaded, vehicle_of
from inspect_cli.log.reader import RunLog
from inspect_cli.metrics.catalogue import METRICS
from inspect_cli.metrics.evaluate import measure
from inspect_cli.metrics.flight import FlightData
from inspect_cli.records import CORE_RECORDS, PointReading
from inspect_cli.schema.loading import load_mission

SUFFIXES = {
    "m": ("_m",),
    "m²": ("_area_m2",),
    "rad": ("_rad",),
    "°": ("_deg",),
    "N": ("_n",),
    "N·m": ("_nm",),
    "V": ("_v",),
    "s": ("_s",),
    "Wh": ("_wh_planned", "_wh_flown"),
    "m/s": ("_mps",),
    "m/N": ("_per_newton",),
    "rad/(N·m)": ("_per_nm",),
    "1": (
        *("_growth", "_min_point", "_over_hovering"),
        *("_cv", "_count", "_gaps", ".gaps", "_mask", "_mismatches", "_points", "_rel_max"),
        "_found",
        *("_share", "_total", "_valid", "_over_attitude", "_over_flown", "_over_z"),
    ),
}
"""How the names of metrics end, by their unit."""


@pytest.fixture(scope="module")
def without_channels(root: Path) -> RunLog:
    """A log that holds what was meant and nothing of what happened."""
    loaded = load_mission(root / "missions" / "nine_point_half_cell.yaml")
    plan = plan_loaded(loaded, vehicle_of(loaded))
    models = {"mission": loaded.mission, "platform": loaded.platform, "plan": plan}
    attachments = {
        f"{name}.json": model.model_dump_json(by_alias=True).encode()
        for name, model in models.items()
    }
    attachments["modes.json"] = TABLE_JSON
    return RunLog(Path("flight.mcap"), "interrupted", "", {}, attachments, (), ())


@pytest.mark.parametrize("name", METRICS)
def test_its_name_ends_in_its_unit(name: str) -> None:
    spec = METRICS[name]
    assert name.endswith(SUFFIXES[spec.unit]), spec.unit
    assert name.count(".") == 1
    assert spec.meaning
    assert not spec.meaning.endswith(".")
    assert set(spec.needs) <= {PointReading, *CORE_RECORDS}


@pytest.mark.parametrize("name", METRICS)
def test_it_is_not_measured_in_a_log_without_channels(name: str, without_channels: RunLog) -> None:
    spec = METRICS[name]
    metric = measure(spec, FlightData(without_channels))
    assert metric.unit == spec.unit
    if not spec.needs:
        assert metric.value is not None, "what needs no channel is told by the plan"
        return
    assert metric.value is None
    assert all(record.topic in metric.why for record in spec.needs)
