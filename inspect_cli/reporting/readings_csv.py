"""``readings.csv``: one line per point, with every digit that the Result holds."""

from __future__ import annotations

import csv
import io

from inspect_cli.schema.plan import Plan
from inspect_cli.schema.result import PointResult, Result

COLUMNS = (
    "index",
    "label",
    "surface",
    "u_m",
    "v_m",
    "x_m",
    "y_m",
    "z_m",
    *(name for name in PointResult.model_fields if name not in ("index", "label", "p_W", "uv_m")),
)
"""Place first, then the fields of a PointResult under their own names, which hold the unit."""


def readings_csv(result: Result, plan: Plan) -> str:
    """The points as CSV (RFC 4180 with bare line feeds); a number that does not exist is empty.

    Numbers are written so that reading them back gives the same float; booleans as true, false.
    """
    surfaces = {target.index: target.surface for target in plan.targets}
    text = io.StringIO()
    writer = csv.DictWriter(text, COLUMNS, lineterminator="\n")
    writer.writeheader()
    for point in result.points:
        row = point.model_dump(exclude={"p_W", "uv_m"})
        row["valid"] = "true" if point.valid else "false"
        row["surface"] = surfaces.get(point.index)
        row |= dict(zip(("x_m", "y_m", "z_m"), point.p_W, strict=True))
        row |= dict(zip(("u_m", "v_m"), point.uv_m or (None, None), strict=True))
        writer.writerow(row)
    return text.getvalue()
