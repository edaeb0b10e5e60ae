"""What a mission was for, in the words of its report: title and key figures.

A report of readings speaks of readings; this module speaks for holds, drawings, slides, contacts
without a reading, and for estimates against ground truth.
"""

from __future__ import annotations

from dataclasses import dataclass

from inspect_cli.log.reader import RunLog
from inspect_cli.reporting.content.blocks import Box
from inspect_cli.reporting.flight.ground_truth import has_ground_truth
from inspect_cli.reporting.flight.pulls import pull_phases
from inspect_cli.reporting.words.text import Text, say, separated, significant, together
from inspect_cli.schema.plan import Plan, Target
from inspect_cli.schema.result import Result


@dataclass(frozen=True)
class Works:
    """What a mission asks for, by kind."""

    readings: tuple[Target, ...]
    contacts: tuple[Target, ...]
    """Points that are touched and not read."""
    strokes: tuple[Target, ...]
    followings: tuple[Target, ...]
    poses: tuple[Target, ...]
    pulls: int
    """How often somebody pulled at a cord."""
    ground_truth: bool
    """Whether estimates can be held against a sensor in the wall or follow an odometry."""

    @property
    def touches(self) -> bool:
        """Whether anything is touched."""
        return bool(self.readings or self.contacts or self.strokes or self.followings)

    @property
    def foreign_groups(self) -> tuple[str, ...]:
        """Groups of metrics that do not concern this mission, by the part before the dot."""
        foreign = [
            *(() if self.readings else ("half_cell",)),
            *(() if self.strokes else ("drawing",)),
            *(() if self.followings else ("slide",)),
            *(() if self.pulls else ("pull",)),
            *(() if self.ground_truth else ("force_sensor",)),
            *(() if self.touches else ("contact", "guidance")),
        ]
        return tuple(foreign)


def works_of(log: RunLog, plan: Plan) -> Works:
    """What the plan asks for, and what the log says was done to the vehicle."""

    def of(kind: str) -> tuple[Target, ...]:
        return tuple(t for t in plan.targets if t.kind == kind and t.sensor is None)

    return Works(
        readings=tuple(t for t in plan.targets if t.sensor is not None),
        contacts=of("contact"),
        strokes=of("stroke"),
        followings=of("following"),
        poses=of("pose"),
        pulls=len(pull_phases(log)),
        ground_truth=has_ground_truth(log),
    )


def kicker(works: Works) -> Text:
    """The line over the title."""
    parts = []
    if works.readings:
        parts.append(say("half-cell potential by contact"))
    if works.strokes:
        parts.append(say("push-and-slide drawing"))
    if works.followings:
        parts.append(say("depth servoing"))
    if works.contacts:
        parts.append(say("contact"))
    if works.pulls:
        parts.append(say("rope pulls in free flight") if works.poses else say("rope pulls"))
    elif works.poses:
        parts.append(say("holding a pose"))
    if works.ground_truth:
        parts.append(say("estimates against ground truth"))
    kind = say("Inspection report") if works.readings else say("Flight report")
    return together(kind, " · ", separated(parts, ", ")) if parts else kind


def boxes(works: Works, result: Result) -> list[Box]:
    """Key figures besides those of readings."""
    found: list[Box] = []

    def add(name: Text, metric: str, unit: str, scale: float = 1.0, digits: int = 3) -> None:
        value = result.value(metric)
        if value is not None:
            found.append(Box(name, significant(scale * value, digits), unit))

    if works.strokes:
        add(say("between trials, RMS in the plane"), "drawing.repeat_rms_m", "mm", 1e3)
        add(say("tip off its reference, RMS"), "drawing.tracking_rms_m", "mm", 1e3)
        add(say("largest attitude error"), "drawing.attitude_error_max_rad", "rad")
    if works.followings:
        add(say("on the surface"), "slide.distance_m", "m")
        add(say("mean speed"), "slide.speed_mean_mps", "m/s")
        add(say("tool off the normal"), "slide.axis_error_mean_deg", "°", 1.0, 2)
    if works.strokes or works.followings:
        add(say("variation of the force"), "contact.force_cv", "%", 100.0, 2)
    if works.pulls:
        add(say("largest pull"), "pull.force_peak_n", "N")
        add(say("largest displacement"), "pull.displacement_max_m", "mm", 1e3)
        add(say("largest yaw"), "pull.yaw_max_rad", "rad")
    elif works.poses:
        add(say("tip off its reference, 95 %"), "tracking.tool_error_p95_m", "mm", 1e3)
        add(say("largest attitude error"), "tracking.attitude_max_rad", "rad")
    if works.contacts:
        add(say("mean contact force"), "contact.force_mean_n", "N")
    if works.ground_truth:
        add(say("force error along x, RMS"), "force_sensor.rmse_fx_n", "N")
    return found
