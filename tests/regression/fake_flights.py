"""Flights that are not flown: their results stand in a file, so that worker processes see them.

``fake.json`` in the campaign folder holds, by mission, what comes out:
``{"metrics": {name: value}, "status": …, "raise": text, "refuse": [text, …], "die": true}``;
metrics may be keyed by seed.
"""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from inspect_cli.errors import InfeasibleError, Problem
from inspect_cli.schema.coverage import CoveragePlan
from inspect_cli.schema.loading import Loaded
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.result import Metric, Result

USUAL = {"contact.force_mean_n": 1.8, "contact.points_valid": 9.0, "contact.force_peak_n": 2.5}
UNITS = {
    "contact.force_mean_n": "N",
    "contact.force_peak_n": "N",
    "tracking.position_rmse_x_m": "m",
}


@dataclass(frozen=True)
class FakeFlown:
    result: Result
    folder: Path


def fly(
    loaded: Loaded, plan: Plan | CoveragePlan | None = None, *, seed: int, out: Path | None = None
) -> FakeFlown:
    """What ``commands.fly.fly_loaded`` is to the regression."""
    root, name = loaded.root, loaded.mission.name
    told = json.loads((root / "fake.json").read_text()).get(name, {})
    with (root / "flown.txt").open("a") as file:
        file.write(f"{name} {seed} {out}\n")
    if told.get("die"):
        os._exit(9)
    if "raise" in told:
        raise RuntimeError(told["raise"])
    if "refuse" in told:
        raise InfeasibleError([Problem(text) for text in told["refuse"]])
    metrics = USUAL | told.get("metrics", {})
    metrics |= told.get("seeds", {}).get(str(seed), {})
    result = Result(
        mission=name,
        platform="tilt_rotor_hexarotor",
        seed=seed,
        status=told.get("status", "completed"),
        status_reason=told.get("reason", ""),
        checks=(),
        metrics={key: _metric(key, value) for key, value in metrics.items()},
        points=(),
    )
    return FakeFlown(result, out or root / "reports" / name / f"seed{seed}")


def _metric(name: str, value: float | None) -> Metric:
    unit = UNITS.get(name, "1")
    return Metric(value=value, unit=unit, why="" if value is not None else "it was lost")


class Campaign:
    """A campaign folder with fake flights."""

    def __init__(self, root: Path) -> None:
        self.root = root
        (root / "missions").mkdir(parents=True)
        self.told: dict[str, Any] = {}
        self.save()

    def mission(self, name: str, **entries: Any) -> Path:
        data = {
            "schema": 1,
            "name": name,
            "platform": "tilt_rotor_hexarotor",
            "seeds": [1],
            "structure": [{"name": "wall", "surface": {"shape": WALL}}],
            "tasks": [{"contact_grid": {"on": "wall", "rows": 1, "columns": 9, "pitch_m": 0.05}}],
        }
        path = self.root / "missions" / f"{name}.yaml"
        path.write_text(yaml.safe_dump(data | entries))
        return path

    def tell(self, name: str, **told: Any) -> None:
        self.told[name] = told
        self.save()

    def save(self) -> None:
        (self.root / "fake.json").write_text(json.dumps(self.told))

    def flown(self) -> list[tuple[str, int]]:
        path = self.root / "flown.txt"
        lines = path.read_text().splitlines() if path.exists() else []
        return [(line.split()[0], int(line.split()[1])) for line in lines]

    def reference(self, name: str, seed: int = 1) -> Path:
        folder = self.root / "reports" / "reference" / name
        return folder / f"tilt_rotor_hexarotor-seed{seed}.json"


WALL = {"kind": "plane", "center_m": [2.0, 0.0, 1.5], "normal": [-1, 0, 0], "size_m": [2.0, 2.0]}
