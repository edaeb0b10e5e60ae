"""Estimates of pose and force against what measured them: tracker and force sensor in the wall.

After Fig. 12 and Table IV of Bodie et al., RSS 2019.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from inspect_cli.log.reader import RunLog
from inspect_cli.metrics.flight import FlightData, NotMeasured
from inspect_cli.metrics.force_sensor import signal
from inspect_cli.records import Estimate, Odometry, Reference, State, WallForce
from inspect_cli.reporting.content.blocks import Block, Column, Table
from inspect_cli.reporting.figures.figure import Figure
from inspect_cli.reporting.figures.palette import (
    ESTIMATE,
    ESTIMATION_ERROR,
    REFERENCE,
    SENSOR_FILTERED,
    SENSOR_RAW,
    TRUTH,
)
from inspect_cli.reporting.figures.rows import (
    attitude_difference_mrad,
    held_at,
    rows_of,
    turned_to_world,
)
from inspect_cli.reporting.figures.timeline import Line, Panel, Timeline, alike, stacked
from inspect_cli.reporting.words.published import SOURCE, TABLE_IV
from inspect_cli.reporting.words.recorded import recorded
from inspect_cli.reporting.words.text import NOTHING, Text, indexed, say, significant, together
from inspect_cli.schema.result import Result

PANEL_PX = 84
AXES: tuple[Text, ...] = ("x", "y", "z")
ANGLES: tuple[Text, ...] = (say("roll"), say("pitch"), say("yaw"))
POSITION = (
    say("Error of the estimated position, in the world. Panels have one scale."),
    say("Error of the estimated position on three axes over time."),
)
ATTITUDE = (
    say(
        "Error of the estimated attitude, as a rotation vector about the axes of the true body, "
        "not of the tracker's. Panels have one scale."
    ),
    say("Error of the estimated attitude on three axes over time."),
)


def has_ground_truth(log: RunLog) -> bool:
    """Whether the log holds a force sensor in the wall or an odometry."""
    return any(rows_of(log, record) is not None for record in (WallForce, Odometry))


def position_figure(log: RunLog, timeline: Timeline) -> Iterator[Figure]:
    """Set-point, estimate and truth along x_W, and the errors on six axes."""
    sources = ((State, TRUTH), (Estimate, ESTIMATE), (Reference, REFERENCE))
    found = [(rows_of(log, record), style) for record, style in sources]
    lines = [Line(r["t_s"], r["p_WB"][:, 0], style) for r, style in found if r is not None]
    if not lines:
        return
    yield stacked(
        "ground-truth-x",
        say(
            "Position of the body along x of the world: set-point, estimate and truth. Shaded: "
            "contact, in which the surface blocks the motion into it."
        ),
        say("Position along x over time: set-point, estimate and truth."),
        [Panel("x (m)", lines, height_px=200, off_ground=True)],
        timeline,
    )
    state, estimate = found[0][0], found[1][0]
    if state is None or estimate is None:
        return
    true = held_at(state, estimate["t_s"])
    position = 1e3 * (estimate["p_WB"] - true["p_WB"])
    attitude = attitude_difference_mrad(true["q_WB"], estimate["q_WB"])
    for name, errors, symbols, unit, (caption, description) in (
        ("position", position, AXES, "mm", POSITION),
        ("attitude", attitude, ANGLES, "mrad", ATTITUDE),
    ):
        panels = [
            Panel(
                together(symbol, f" ({unit})"),
                [Line(estimate["t_s"], errors[:, k], ESTIMATION_ERROR)],
            )
            for k, symbol in enumerate(symbols)
        ]
        yield stacked(
            f"ground-truth-{name}",
            caption,
            description,
            alike(panels, timeline.off_ground_s or (-np.inf, np.inf)),
            timeline,
        )


def force_figure(flight: FlightData, timeline: Timeline) -> Iterator[Figure]:
    """Estimated force against the sensor's, raw and filtered, along the axes of the world."""
    try:
        sensed = signal(flight)
    except NotMeasured:
        return
    raw_W, filtered_W = (-force[:, :3] @ sensed.R_WS.T for force in (sensed.raw, sensed.filtered))
    tracks = [(sensed.t_s, filtered_W, SENSOR_FILTERED)]
    estimate = rows_of(flight.log, Estimate)
    if estimate is not None:
        force_W = turned_to_world(estimate["q_WB"], estimate["wrench_B"][:, :3])
        tracks.append((estimate["t_s"], force_W, ESTIMATE))
    window = timeline.off_ground_s or (-np.inf, np.inf)
    smooth = [
        Panel(f"F<sub>{axis}</sub> (N)", [Line(t, f[:, k], style) for t, f, style in tracks])
        for k, axis in enumerate("xyz")
    ]
    panels = [
        Panel(p.title, [Line(sensed.t_s, raw_W[:, k], SENSOR_RAW), *p.lines], p.axis, 110)
        for k, p in enumerate(alike(smooth, window))
    ]
    yield stacked(
        "ground-truth-force",
        say(
            "Force on the vehicle in the world: by the momentum observer, and by the sensor in "
            "the wall, raw and filtered (Butterworth of order 5, 5 Hz, without a lag). The "
            "observer holds all other external force too. The scale is that of the smooth lines; "
            "the raw signal goes beyond it."
        ),
        say("Estimated and measured force on three axes over time."),
        panels,
        timeline,
    )


def rmse_table(result: Result) -> list[Block]:
    """Our root mean square errors beside the published ones; none if nothing was measured."""
    ours = {name: result.value(name) for name in TABLE_IV}
    if all(value is None for value in ours.values()):
        return []
    rows: list[list[Text]] = []
    for name, (what, published, unit) in TABLE_IV.items():
        value = ours[name]
        ratio = NOTHING if value is None else significant(value / published, 2)
        rows.append(
            [
                indexed(what) if "_" in what else recorded(what),
                significant(value, 3),
                significant(published),
                unit,
                ratio,
            ]
        )
    columns = [
        Column(say("Estimate")),
        Column(say("Ours, RMSE"), numeric=True),
        Column(say("Published, RMSE"), numeric=True),
        Column(say("Unit")),
        Column(say("Ratio"), numeric=True),
    ]
    caption = say(
        "Errors of the estimates beside Table IV of {source}: pose from take-off to landing, roll, "
        "pitch and yaw against the body frame of the tracker, force against the filtered sensor. "
        "That frame is turned against the body's by a constant of the platform that was chosen "
        "from the published errors: where it is, roll and pitch agree by construction. The "
        "published row of z is not legible.",
        source=SOURCE,
    )
    return [Table(caption, columns, rows)]
