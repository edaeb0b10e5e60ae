"""What a mission was for, in the words of its report: title, finding, key figures.

A report of readings speaks of readings; this module speaks for holds, drawings, slides, contacts
without a reading, and for estimates against ground truth.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from inspect_cli.log.reader import RunLog
from inspect_cli.reporting.figures_ground_truth import has_ground_truth
from inspect_cli.reporting.figures_pulls import pull_phases
from inspect_cli.reporting.table import number, significant
from inspect_cli.schema.plan import Plan, Target
from inspect_cli.schema.result import Result

SMALL_NUMBERS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine")
Box = tuple[str, str, str]
"""Name, value and unit of a key figure."""


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


def kicker(works: Works) -> str:
    """The line over the title."""
    parts = []
    if works.readings:
        parts.append("half-cell potential by contact")
    if works.strokes:
        parts.append("push-and-slide drawing")
    if works.followings:
        parts.append("depth servoing")
    if works.contacts:
        parts.append("contact")
    if works.pulls:
        parts.append("rope pulls in free flight")
    elif works.poses:
        parts.append("holding a pose")
    if works.ground_truth:
        parts.append("estimates against ground truth")
    kind = "Inspection report" if works.readings else "Flight report"
    return " · ".join([kind, ", ".join(parts)] if parts else [kind])


def told(works: Works, result: Result) -> list[str]:
    """What was done and what came out, in sentences; nothing about readings."""
    sentences = [*_drawn(works, result), *_slid(works, result), *_held(works, result)]
    sentences += [*_pressed(works, result), *_estimated(works, result)]
    return [sentence[0].upper() + sentence[1:] for sentence in sentences]


def _drawn(works: Works, result: Result) -> Iterator[str]:
    if not works.strokes:
        return
    strokes = [target.stroke for target in works.strokes if target.stroke]
    drawings = {stroke.drawing for stroke in strokes}
    trials = {(stroke.drawing, stroke.trial) for stroke in strokes}
    what = f"{_count(len(trials), 'trial')} of {_count(len(drawings), 'drawing')}"
    apart = _millimetres(result, "drawing.repeat_rms_m")
    if apart:
        yield f"{what}; they differ by {apart} RMS in the plane."
    elif len(trials) > len(drawings):
        yield f"{what}; their difference was not measured."
    else:
        yield f"{what}."
    error, turn = _millimetres(result, "drawing.tracking_rms_m"), _attitude(result)
    if error:
        yield f"the tip kept to its reference within {error} RMS{turn}."
    yield from _contact(result, "contact.bounce_gaps")


def _attitude(result: Result) -> str:
    turn = _value(result, "drawing.attitude_error_max_rad")
    return f", the attitude within {significant(turn, 2)} rad" if turn is not None else ""


def _slid(works: Works, result: Result) -> Iterator[str]:
    if not works.followings:
        return
    way, speed = _value(result, "slide.distance_m"), _value(result, "slide.speed_mean_mps")
    if way is None:
        yield "a surface that the plan does not describe was to be followed."
        return
    pace = f" at {significant(speed, 2)} m/s on average" if speed is not None else ""
    yield f"the tool slid {number(way, 2)} m along a surface known by the depth camera alone{pace}."
    yield from _contact(result, "slide.gaps")
    drift = _millimetres(result, "estimation.drift_at_first_contact_m")
    if drift:
        yield f"at the first touch the estimate was {drift} off."


def _contact(result: Result, metric: str) -> Iterator[str]:
    """Whether contact was kept."""
    gaps = _value(result, metric)
    if gaps == 0.0:
        yield "contact was kept from touch to release."
    elif gaps is not None:
        yield f"contact was lost {_times(int(gaps))} for more than 50 ms."


def _held(works: Works, result: Result) -> Iterator[str]:
    if works.pulls:
        yield from _pulled(works, result)
    if works.poses:
        longest = sum(target.dwell_s for target in works.poses)
        yield f"{_count(len(works.poses), 'pose')} held in free flight for {longest:g} s."
    if works.poses and not works.pulls:
        error = _millimetres(result, "tracking.tool_error_p95_m")
        if error:
            yield f"out of contact the tip was within {error} of its reference 95 % of the time."


def _pulled(works: Works, result: Result) -> Iterator[str]:
    force = _value(result, "pull.force_peak_n")
    moved = _millimetres(result, "pull.displacement_max_m")
    yaw = _value(result, "pull.yaw_max_rad")
    strength = f" with up to {significant(force, 2)} N" if force is not None else ""
    effect = f" moved the body by up to {moved}" if moved else ""
    turn = f" and turned it by up to {significant(yaw, 2)} rad" if yaw is not None and moved else ""
    yield f"{_count(works.pulls, 'pull')} at a cord{strength}{effect}{turn}."


def _pressed(works: Works, result: Result) -> Iterator[str]:
    if not works.contacts:
        return
    force = _value(result, "contact.force_mean_n")
    mean = f", on average with {significant(force, 3)} N" if force is not None else ""
    verb = "was" if len(works.contacts) == 1 else "were"
    yield f"{_count(len(works.contacts), 'point')} {verb} pressed without a reading{mean}."


def _estimated(works: Works, result: Result) -> Iterator[str]:
    if not works.ground_truth:
        return
    force = [_value(result, f"force_sensor.rmse_f{axis}_n") for axis in "xyz"]
    if all(value is not None for value in force):
        errors = ", ".join(significant(value, 2) for value in force)
        yield f"the estimated force is off the wall's sensor by {errors} N RMS along x, y, z."
    place = [_value(result, f"estimation.rmse_{axis}_m") for axis in "xyz"]
    if all(value is not None for value in place):
        errors = ", ".join(number(1e3 * (value or 0.0), 1) for value in place)
        yield f"the estimated position is off by {errors} mm RMS."


def boxes(works: Works, result: Result) -> list[Box]:
    """Key figures besides those of readings."""
    found: list[Box] = []

    def add(name: str, metric: str, unit: str, scale: float = 1.0, digits: int = 3) -> None:
        value = _value(result, metric)
        if value is not None:
            found.append((name, significant(scale * value, digits), unit))

    if works.strokes:
        add("between trials, RMS in the plane", "drawing.repeat_rms_m", "mm", 1e3)
        add("tip off its reference, RMS", "drawing.tracking_rms_m", "mm", 1e3)
        add("largest attitude error", "drawing.attitude_error_max_rad", "rad")
    if works.followings:
        add("on the surface", "slide.distance_m", "m")
        add("mean speed", "slide.speed_mean_mps", "m/s")
        add("tool off the normal", "slide.axis_error_mean_deg", "°", 1.0, 2)
    if works.strokes or works.followings:
        add("variation of the force", "contact.force_cv", "%", 100.0, 2)
    if works.pulls:
        add("largest pull", "pull.force_peak_n", "N")
        add("largest displacement", "pull.displacement_max_m", "mm", 1e3)
        add("largest yaw", "pull.yaw_max_rad", "rad")
    elif works.poses:
        add("tip off its reference, 95 %", "tracking.tool_error_p95_m", "mm", 1e3)
        add("largest attitude error", "tracking.attitude_max_rad", "rad")
    if works.contacts:
        add("mean contact force", "contact.force_mean_n", "N")
    if works.ground_truth:
        add("force error along x, RMS", "force_sensor.rmse_fx_n", "N")
    return found


def _count(n: int, noun: str) -> str:
    words = SMALL_NUMBERS[n] if n < len(SMALL_NUMBERS) else str(n)
    return f"{words} {noun}{'' if n == 1 else 's'}"


def _times(n: int) -> str:
    return {1: "once", 2: "twice"}.get(n, f"{n} times")


def _millimetres(result: Result, metric: str) -> str:
    """The metric in words, empty where it was not measured."""
    value = _value(result, metric)
    if value is None:
        return ""
    return f"{number(1e3 * value, 1 if 1e3 * value < 9.95 else 0)} mm"


def _value(result: Result, name: str) -> float | None:
    metric = result.metrics.get(name)
    return metric.value if metric else None
