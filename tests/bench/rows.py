"""One measured number and the limit that it is held against."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True)
class Row:
    """``bound`` says on which side of the limit the value has to be; the limit itself is good."""

    name: str
    value: float
    unit: str
    limit: float
    bound: Literal["max", "min"] = "max"

    @property
    def ok(self) -> bool:
        """Whether the limit is kept."""
        return self.value <= self.limit if self.bound == "max" else self.value >= self.limit

    def as_dict(self) -> dict[str, object]:
        """The row as it is written."""
        return {
            "name": self.name,
            "value": float(f"{self.value:.4g}"),
            "unit": self.unit,
            "bound": self.bound,
            "limit": self.limit,
            "ok": self.ok,
        }


def as_json(rows: Iterable[Row]) -> str:
    """One row per line."""
    lines = ",\n".join(json.dumps(row.as_dict(), ensure_ascii=False) for row in rows)
    return f"[\n{lines}\n]\n"
