"""The table of the surfaces that the planner fitted, and how well each fits."""

from __future__ import annotations

from inspect_cli.reporting.content.blocks import Column, Table
from inspect_cli.reporting.words.recorded import recorded
from inspect_cli.reporting.words.text import (
    NOTHING,
    Text,
    number,
    say,
    separated,
    significant,
    together,
)
from inspect_cli.schema.plan import Plan, PlannedSurface


def fits_table(plan: Plan) -> Table:
    """How well each fitted surface explains its points."""
    columns = [
        Column(say("Surface")),
        Column(say("Shape")),
        Column(say("Source and method"), prose=True),
        Column(say("Points"), numeric=True),
        Column(say("Inliers"), "%", numeric=True),
        Column("RMS", "mm", numeric=True),
        Column(say("Standard deviations of the parameters"), prose=True),
    ]
    rows = [_fit_row(surface) for surface in plan.surfaces]
    return Table(say("Surfaces as the planner believed them."), columns, rows)


def _fit_row(surface: PlannedSurface) -> list[Text]:
    fit, shape = surface.fit, recorded(surface.shape.kind)
    if fit is None:
        return [surface.name, shape, say("given"), *[NOTHING] * 4]
    deviations = [_deviation(name, sd) for name, sd in fit.parameter_sd.items()]
    return [
        surface.name,
        shape,
        f"{surface.source}; {fit.method}",
        number(fit.points, 0),
        number(100.0 * fit.inlier_share, 1),
        number(1e3 * fit.rms_m, 2),
        separated(deviations, ", ") if deviations else NOTHING,
    ]


def _deviation(parameter: str, sd: float) -> Text:
    """``offset_m`` and 1.8e-5 as "offset ± 0.018 mm"."""
    name, _, unit = parameter.rpartition("_")
    if unit not in ("m", "rad"):
        return together(parameter, " ± ", significant(sd, 2))
    return together(recorded(name.replace("_", " ")), " ± ", significant(1e3 * sd, 2), f" m{unit}")
