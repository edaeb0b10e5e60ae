"""Figures of pose tracking and of the pose estimate's error."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from inspect_cli.log.reader import RunLog
from inspect_cli.records import Estimate, Reference, State
from inspect_cli.reporting.figures.figure import Figure
from inspect_cli.reporting.figures.palette import (
    BELIEVED_ERROR,
    ESTIMATE,
    ESTIMATION_ERROR,
    REFERENCE,
    TRACKING_ERROR,
    TRUTH,
    LineStyle,
)
from inspect_cli.reporting.figures.rows import (
    attitude_difference_mrad,
    held_at,
    roll_pitch_yaw_deg,
    rows_of,
)
from inspect_cli.reporting.figures.timeline import Line, Panel, Timeline, stacked
from inspect_cli.reporting.words.text import Text, say, sentences, together
from inspect_cli.spatial.arrays import Points, Structured, Vector

Track = tuple[Vector, Points, LineStyle]
"""Times (n,), three components (n, 3), and how their lines look."""

AXES: tuple[Text, ...] = ("x", "y", "z")
ANGLES: tuple[Text, ...] = (say("roll"), say("pitch"), say("yaw"))
IN_CONTACT = say(
    "Shaded and numbered: contact phases, in which the set-point lies behind the surface on "
    "purpose."
)
SPRING = say(
    "In contact the distance to the reference is the compression of the virtual spring that makes "
    "the force; it is no tracking error."
)
SCALED = say("The axes are scaled to the time between take-off and landing.")


def tracking_figures(log: RunLog, timeline: Timeline) -> Iterator[Figure]:
    """Position and attitude with their errors; only what the log holds."""
    poses = _poses(log)
    if not poses:
        return
    in_contact = (IN_CONTACT, SPRING) if timeline.phases else ()
    yield stacked(
        "position",
        sentences([say("Position of the body in the world."), *(in_contact[:1])]),
        say("Position x, y, z of the body over time: reference, estimate and truth."),
        _panels([(rows["t_s"], rows["p_WB"], style) for rows, style in poses], AXES, "m"),
        timeline,
    )
    yield from _error_figure(
        "position-error",
        sentences([say("Position errors per axis of the world."), *in_contact[1:], SCALED]),
        say("Position errors along x, y and z over time."),
        _panels(_errors(log, _position_difference_mm), AXES, "mm", off_ground=True),
        timeline,
    )
    yield stacked(
        "attitude",
        say("Attitude of the body as roll, pitch and yaw (R = R_z R_y R_x)."),
        say("Roll, pitch and yaw of the body over time: reference, estimate and truth."),
        _panels(
            [(rows["t_s"], roll_pitch_yaw_deg(rows["q_WB"]), style) for rows, style in poses],
            ANGLES,
            "°",
        ),
        timeline,
    )
    yield from _error_figure(
        "attitude-error",
        say(
            "Attitude errors as rotation vectors, in the frame of the body that they start from. "
            "The axes are scaled to the time between take-off and landing."
        ),
        say("Components of the attitude error over time."),
        _panels(
            _errors(log, _attitude_difference_mrad),
            [f"θ<sub>{axis}</sub>" for axis in AXES],
            "mrad",
            off_ground=True,
        ),
        timeline,
    )


def _poses(log: RunLog) -> list[tuple[Structured, LineStyle]]:
    """Sources of a pose in the order of drawing: the reference is on top."""
    sources = ((State, TRUTH), (Estimate, ESTIMATE), (Reference, REFERENCE))
    found = [(rows_of(log, record), style) for record, style in sources]
    return [(rows, style) for rows, style in found if rows is not None]


def _error_figure(
    name: str, caption: Text, description: Text, panels: Sequence[Panel], timeline: Timeline
) -> Iterator[Figure]:
    if panels[0].lines:
        yield stacked(name, caption, description, panels, timeline)


def _panels(
    tracks: Sequence[Track], names: Sequence[Text], unit: str, *, off_ground: bool = False
) -> list[Panel]:
    return [
        Panel(
            together(name, f" ({unit})"),
            [Line(t_s, xyz[:, k], style) for t_s, xyz, style in tracks],
            off_ground=off_ground,
        )
        for k, name in enumerate(names)
    ]


def _errors(log: RunLog, difference: Callable[[Structured, Structured], Points]) -> list[Track]:
    """Errors of tracking (truth against reference) and of estimation (estimate against truth).

    Without truth the estimate stands against the reference: all that a real flight can say.
    """
    truth, estimate, reference = (rows_of(log, r) for r in (State, Estimate, Reference))
    pairs = [
        (truth, estimate, ESTIMATION_ERROR),
        (reference, truth, TRACKING_ERROR),
        (reference, estimate if truth is None else None, BELIEVED_ERROR),
    ]
    return [
        (after["t_s"], difference(held_at(before, after["t_s"]), after), style)
        for before, after, style in pairs
        if before is not None and after is not None
    ]


def _position_difference_mm(before: Structured, after: Structured) -> Points:
    difference: Points = 1e3 * (after["p_WB"] - before["p_WB"])
    return difference


def _attitude_difference_mrad(before: Structured, after: Structured) -> Points:
    return attitude_difference_mrad(before["q_WB"], after["q_WB"])
