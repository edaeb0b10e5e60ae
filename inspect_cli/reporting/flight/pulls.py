"""Figures of pulls at a cord: the motion above, the wrench that caused it below.

After Figs. 5 and 6 of Bodie et al., RSS 2019. Motion and wrench are in the body's axes, in which
the rope-pull profiles of impedance are given.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from inspect_cli.log.reader import RunLog
from inspect_cli.metrics.flight import FlightData
from inspect_cli.metrics.pull import Pull, pulls
from inspect_cli.records import Estimate, Reference, State, TrueDisturbance
from inspect_cli.reporting.content.blocks import Column, Table
from inspect_cli.reporting.figures.figure import Figure
from inspect_cli.reporting.figures.palette import (
    BELIEVED_ERROR,
    CORD,
    ESTIMATE,
    TRACKING_ERROR,
    LineStyle,
)
from inspect_cli.reporting.figures.rows import (
    attitude_difference_mrad,
    held_at,
    rows_of,
    turned_to_body,
)
from inspect_cli.reporting.figures.timeline import (
    Line,
    Panel,
    Span,
    Timeline,
    alike,
    stacked,
    stretches,
)
from inspect_cli.reporting.words.text import Text, number, say
from inspect_cli.spatial.arrays import Points, Structured, Vector

BEFORE_S = 2.0
AFTER_S = 5.0
"""Drawn before the first and after the last pull."""
PANEL_PX = 84
POSITION = (
    say(
        "Position error against the held reference, along the axes of the body, and below it the "
        "external force: the momentum observer's estimate, which holds all external force, and "
        "the cord's. Shaded and numbered: the pulls. Panels of one kind have one scale."
    ),
    say("Position error and external force over time during pulls at a cord."),
)
ATTITUDE = (
    say(
        "Attitude error against the held reference, along the axes of the body, and below it the "
        "external torque about the body's origin: the momentum observer's estimate, which holds "
        "all external force, and the cord's. Shaded and numbered: the pulls. Panels of one kind "
        "have one scale."
    ),
    say("Attitude error and external torque over time during pulls at a cord."),
)


def pull_phases(log: RunLog) -> tuple[Span, ...]:
    """The times of the pulls with their numbers; none in a log without a cord."""
    felt = rows_of(log, TrueDisturbance)
    if felt is None:
        return ()
    t_s, pull = felt["t_s"], felt["pull"]
    found = []
    for k in np.unique(pull[pull > 0.0]):
        for first, end in stretches(pull == k):
            until = float(t_s[min(end, len(t_s) - 1)])
            found.append(Span(float(t_s[first]), until, f"{int(k)}"))
    return tuple(sorted(found, key=lambda phase: phase.start_s))


def pull_figures(log: RunLog, phases: Sequence[Span]) -> list[Figure]:
    """Position above force, attitude above torque; nothing without pulls."""
    moved = _moved(log)
    if not phases or moved is None:
        return []
    window = (phases[0].start_s - BEFORE_S, phases[-1].end_s + AFTER_S)
    timeline = Timeline(phases=tuple(phases)).within(window)
    rows, reference, style = moved
    shift_B = turned_to_body(reference["q_WB"], rows["p_WB"] - reference["p_WB"])
    turn = 1e-3 * attitude_difference_mrad(reference["q_WB"], rows["q_WB"])
    motions = {
        "position": ([Line(rows["t_s"], shift_B[:, k], style) for k in range(3)], "Δ", "m"),
        "attitude": ([Line(rows["t_s"], turn[:, k], style) for k in range(3)], "θ", "rad"),
    }
    wrenches = {"position": (0, "F", "N"), "attitude": (3, "τ", "N·m")}
    return [
        _figure(name, *motions[name], *wrenches[name], log, timeline)
        for name in ("position", "attitude")
    ]


def _moved(log: RunLog) -> tuple[Structured, Structured, LineStyle] | None:
    """(motion, the reference at its times, style): the truth, or else what was believed."""
    reference = rows_of(log, Reference)
    for record, style in ((State, TRACKING_ERROR), (Estimate, BELIEVED_ERROR)):
        rows = rows_of(log, record)
        if rows is not None and reference is not None:
            return rows, held_at(reference, rows["t_s"]), style
    return None


def _figure(
    name: str,
    motion: Sequence[Line],
    symbol: str,
    unit: str,
    first: int,
    wrench: str,
    wrench_unit: str,
    log: RunLog,
    timeline: Timeline,
) -> Figure:
    window = timeline.window_s or (-np.inf, np.inf)
    above = [
        Panel(f"{symbol}<sub>{axis}</sub> ({unit})", [line], height_px=PANEL_PX)
        for axis, line in zip("xyz", motion, strict=True)
    ]
    below = [
        Panel(f"{wrench}<sub>{axis}</sub> ({wrench_unit})", _wrench(log, first + k), None, PANEL_PX)
        for k, axis in enumerate("xyz")
    ]
    caption, description = POSITION if first == 0 else ATTITUDE
    return stacked(
        f"pull-{name}",
        caption,
        description,
        [*alike(above, window), *alike([p for p in below if p.lines], window)],
        timeline,
    )


def _wrench(log: RunLog, component: int) -> list[Line]:
    lines = []
    cord = _cord_wrench(log)
    if cord is not None:
        lines.append(Line(cord[0], cord[1][:, component], CORD))
    estimate = rows_of(log, Estimate)
    if estimate is not None:
        lines.append(Line(estimate["t_s"], estimate["wrench_B"][:, component], ESTIMATE))
    return lines


def _cord_wrench(log: RunLog) -> tuple[Vector, Points] | None:
    """(times, force and torque (n, 6) of the cord about O_b in B)."""
    felt, state = rows_of(log, TrueDisturbance), rows_of(log, State)
    if felt is None or state is None:
        return None
    true = held_at(state, felt["t_s"])
    force_W = felt["f_rope_W"]
    torque_W = np.cross(true["p_WT"] - true["p_WB"], force_W)
    turned = [turned_to_body(true["q_WB"], x_W) for x_W in (force_W, torque_W)]
    return felt["t_s"], np.hstack(turned)


def pull_table(flight: FlightData) -> Table:
    """One row for each pull.

    Raises:
        NotMeasured: the log does not show the pulls.
    """
    rows = [_row(k + 1, pull) for k, pull in enumerate(pulls(flight))]
    columns = [
        Column(say("Pull")),
        Column(say("Peak force"), "N", numeric=True),
        Column(say("From ±x_B"), "°", numeric=True),
        Column(say("Along"), "mm", numeric=True),
        Column(say("Across"), "mm", numeric=True),
        Column(say("In z"), "mm", numeric=True),
        Column(say("By attitude"), say("mm at the tip"), numeric=True),
        Column(say("Compliance"), "mm/N", numeric=True),
        Column(say("Yaw"), "rad", numeric=True),
        Column(say("Torque"), say("N·m about z_B"), numeric=True),
    ]
    caption = say(
        "Pulls at the cord. Along, across and in z: the body's largest displacement in the "
        "direction of the cord's peak force, level and square to it, and up or down, from the "
        "beginning of the pull to three seconds after it. By attitude: how far the tip moved "
        "because the body turned."
    )
    return Table(caption, columns, rows, wide=True)


def _row(place: int, pull: Pull) -> list[Text]:
    return [
        str(place),
        number(pull.peak, 1),
        number(float(np.degrees(pull.angle_to_x_B)), 1),
        number(1e3 * pull.along, 1),
        number(1e3 * pull.across, 1),
        number(1e3 * pull.upwards, 1),
        number(1e3 * pull.attitude_motion, 1),
        number(1e3 * pull.along / pull.peak, 1),
        number(pull.yaw, 3),
        number(pull.torque, 2),
    ]
