"""Figures of studies: metrics against each quantity that was varied."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from inspect_cli.reporting.figures.figure import Figure, Json, words
from inspect_cli.reporting.figures.palette import BLUE, GREEN, INK, ORANGE
from inspect_cli.reporting.words.published import SOURCE, TABLE_IV
from inspect_cli.reporting.words.text import Text, say, significant, together
from inspect_cli.schema.study import Quantity, StudyResult, StudyVariant

PREDICTED = "study.lag_contact_rmse_fx_n"
"""Error from the observer's lag alone; the study ``force`` computes it."""
GAP = 0.09
"""Between panels, as a share of the figure."""
MARGIN = 1.15
"""Room beyond the outermost values of a logarithmic axis."""


@dataclass(frozen=True)
class Curve:
    """A metric as it is drawn in every panel of a row."""

    metric: str
    label: Text
    colour: str
    symbol: str
    dash: str = "solid"


@dataclass(frozen=True)
class Level:
    """A horizontal line to compare a row's curves with."""

    value: float
    label: Text
    dash: str = "dash"


@dataclass(frozen=True)
class Row:
    """Panels with one vertical axis, one for each quantity."""

    heading: Text
    curves: tuple[Curve, ...]
    level: Level | None
    share: float
    """Of the figure's height."""


def force_figure(study: StudyResult) -> Figure:
    """RMS error along the contact's direction, flown and predicted, and whether it stays calm."""
    whole = "force_sensor.rmse_fx_n"
    published = TABLE_IV[whole][1]
    errors = Row(
        say("RMSE of f<sub>x</sub> (N)"),
        (
            Curve("force_sensor.contact_rmse_fx_n", say("flown, in contact"), BLUE, "circle"),
            Curve(
                PREDICTED, say("predicted by the lag, in contact"), ORANGE, "x-thin-open", "dash"
            ),
            Curve(whole, say("flown, whole flight"), GREEN, "square", "dot"),
        ),
        Level(published, say("published, {value} N", value=significant(published))),
        0.62,
    )
    calm = Row(
        say("oscillation growth"),
        (Curve("contact.oscillation_growth", say("oscillation growth"), INK, "diamond"),),
        Level(1.0, say("neither grows nor dies out"), "dot"),
        0.38,
    )
    return Figure(
        "force-sweep",
        say(
            "Error of the estimated force along the contact's direction against the observer's "
            "gain K_I and against the speed v of the reference, the other held at what the mission "
            "says. Predicted is what a first-order lag alone errs by, given the measured force. "
            "Published: {source}, Table IV. Below, the oscillation of the true force in the second "
            "half of a dwell over that in the first; below 1 it dies out.",
            source=SOURCE,
        ),
        say("Force errors and growth of oscillations against observer gain and reference speed."),
        *sweep_panels(study, (errors, calm)),
        560,
    )


def sweep_panels(study: StudyResult, rows: Sequence[Row]) -> tuple[list[Json], Json]:
    """Traces and layout: a column for each quantity, with a logarithmic axis, a row each."""
    traces: list[Json] = []
    layout: Json = {"hovermode": "closest"}
    columns = len(study.quantities)
    height = (1.0 - GAP * (len(rows) - 1)) / sum(row.share for row in rows)
    top = 1.0
    for i, row in enumerate(rows):
        bottom = max(top - row.share * height, 0.0)
        first = _number(i * columns)
        for j, quantity in enumerate(study.quantities):
            n = _number(i * columns + j)
            traces += _panel(study, quantity, row, n, legend=j == 0)
            x_axis = _x_axis(study, quantity, j) | {"anchor": f"y{n}"}
            if i > 0:
                x_axis["matches"] = f"x{_number(j)}"
            if i < len(rows) - 1:
                x_axis |= {"title": {"text": ""}, "showticklabels": False}
            y_axis: Json = {"domain": [bottom, top], "anchor": f"x{n}", "rangemode": "tozero"}
            of_row = {"matches": f"y{first}"} if j else {"title": {"text": row.heading}}
            layout[f"xaxis{n}"], layout[f"yaxis{n}"] = x_axis, y_axis | of_row
        top = bottom - GAP
    return traces, layout


def error_bars(variants: Sequence[StudyVariant], metric: str, colour: str) -> Json:
    """Plotly's error bars from standard errors; none for a metric that is not a mean."""
    errors = [variant.standard_errors.get(metric) for variant in variants]
    if all(error is None for error in errors):
        return {}
    bars: Json = {"type": "data", "array": errors, "color": colour, "thickness": 1.2, "width": 4}
    return {"error_y": bars}


def _number(panel: int) -> str:
    """What plotly appends to the names of a panel's axes: nothing for the first."""
    return str(panel + 1) if panel else ""


def _panel(
    study: StudyResult, quantity: Quantity, row: Row, n: str, *, legend: bool
) -> Iterator[Json]:
    variants = study.sweep(quantity)
    x = [variant.values[quantity.name] for variant in variants]
    axes: Json = {"type": "scatter", "xaxis": f"x{n}", "yaxis": f"y{n}", "showlegend": legend}
    for curve in row.curves:
        yield axes | {
            "mode": "lines+markers",
            "name": curve.label,
            "legendgroup": curve.label,
            "x": x,
            "y": [variant.value(curve.metric) for variant in variants],
            "line": {"color": curve.colour, "dash": curve.dash, "width": 1.6},
            "marker": {
                "symbol": curve.symbol,
                "size": 9,
                "color": curve.colour,
                "line": {"width": 2, "color": curve.colour},
            },
            "hovertemplate": together(
                "%{x:g} ", words(quantity.unit), ": %{y:.3g}<extra>", curve.label, "</extra>"
            ),
            **error_bars(variants, curve.metric, curve.colour),
        }
    if x and row.level:
        yield axes | {
            "mode": "lines",
            "name": row.level.label,
            "legendgroup": row.level.label,
            "x": [x[0] / MARGIN, x[-1] * MARGIN],
            "y": [row.level.value] * 2,
            "line": {"color": INK, "dash": row.level.dash, "width": 1.2},
            "hoverinfo": "skip",
        }


def _x_axis(study: StudyResult, quantity: Quantity, column: int) -> Json:
    count = len(study.quantities)
    width = (1.0 - GAP * (count - 1)) / count
    start = column * (width + GAP)
    x = [variant.values[quantity.name] for variant in study.sweep(quantity)]
    symbol, _, index = quantity.symbol.partition("_")
    shown = together(words(symbol), "<sub>", words(index), "</sub>") if index else words(symbol)
    return {
        "domain": [start, min(start + width, 1.0)],
        "type": "log",
        "tickvals": x,
        "ticktext": [significant(value) for value in x],
        "title": {"text": together(shown, " (", words(quantity.unit), ")")},
    }
