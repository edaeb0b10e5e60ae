"""What a flight did besides taking readings, and what came of it, in sentences."""

from __future__ import annotations

from collections.abc import Iterator

from inspect_cli.reporting.flight.mission_profile import Works
from inspect_cli.reporting.words.text import Amount, Text, count, number, say, significant
from inspect_cli.schema.result import Result

SMALL_NUMBERS = {
    2: (say("Two"), say("two")),
    3: (say("Three"), say("three")),
    4: (say("Four"), say("four")),
    5: (say("Five"), say("five")),
    6: (say("Six"), say("six")),
    7: (say("Seven"), say("seven")),
    8: (say("Eight"), say("eight")),
    9: (say("Nine"), say("nine")),
}
"""As a sentence begins with them, and as they stand within it; one has a sentence of its own."""


def told(works: Works, result: Result) -> list[Text]:
    """What was done and what came out, in sentences; nothing about readings."""
    return [
        *_drawn(works, result),
        *_slid(works, result),
        *_held(works, result),
        *_pressed(works, result),
        *_estimated(works, result),
    ]


def _drawn(works: Works, result: Result) -> Iterator[Text]:
    if not works.strokes:
        return
    strokes = [target.stroke for target in works.strokes if target.stroke]
    drawings = {stroke.drawing for stroke in strokes}
    trials = {(stroke.drawing, stroke.trial) for stroke in strokes}
    yield from _trials(len(trials), len(drawings), _millimetres(result, "drawing.repeat_rms_m"))
    error = _millimetres(result, "drawing.tracking_rms_m")
    turn = result.value("drawing.attitude_error_max_rad")
    if error and turn is not None:
        yield say(
            "The tip kept to its reference within {error} mm RMS, the attitude within {turn} rad.",
            error=error,
            turn=significant(turn, 2),
        )
    elif error:
        yield say("The tip kept to its reference within {error} mm RMS.", error=error)
    yield from _contact(result, "contact.bounce_gaps")


def _trials(trials: int, drawings: int, apart: Amount | None) -> Iterator[Text]:
    of = count(drawings, "one drawing", "{amount} drawings", amount=_amount(drawings, 1))
    words = _amount(trials)
    if apart:
        yield count(
            trials,
            "One trial of {drawings}; they differ by {apart} mm RMS in the plane.",
            "{amount} trials of {drawings}; they differ by {apart} mm RMS in the plane.",
            amount=words,
            drawings=of,
            apart=apart,
        )
    elif trials > drawings:
        yield say(
            "{amount} trials of {drawings}; their difference was not measured.",
            amount=words,
            drawings=of,
        )
    else:
        yield count(
            trials,
            "One trial of {drawings}.",
            "{amount} trials of {drawings}.",
            amount=words,
            drawings=of,
        )


def _slid(works: Works, result: Result) -> Iterator[Text]:
    if not works.followings:
        return
    way, speed = result.value("slide.distance_m"), result.value("slide.speed_mean_mps")
    if way is None:
        yield say("A surface that the plan does not describe was to be followed.")
        return
    if speed is None:
        yield say(
            "The tool slid {way} m along a surface known by the depth camera alone.",
            way=number(way, 2),
        )
    else:
        yield say(
            "The tool slid {way} m along a surface known by the depth camera alone at {speed} m/s "
            "on average.",
            way=number(way, 2),
            speed=significant(speed, 2),
        )
    yield from _contact(result, "slide.gaps")
    drift = _millimetres(result, "estimation.drift_at_first_contact_m")
    if drift:
        yield say("At the first touch the estimate was {drift} mm off.", drift=drift)


def _contact(result: Result, metric: str) -> Iterator[Text]:
    """Whether contact was kept."""
    gaps = result.value(metric)
    if gaps == 0.0:
        yield say("Contact was kept from touch to release.")
    elif gaps == 2.0:
        yield say("Contact was lost twice for more than 50 ms.")
    elif gaps is not None:
        yield count(
            int(gaps),
            "Contact was lost once for more than 50 ms.",
            "Contact was lost {n} times for more than 50 ms.",
        )


def _held(works: Works, result: Result) -> Iterator[Text]:
    if works.pulls:
        yield _pulled(works, result)
    if works.poses:
        yield count(
            len(works.poses),
            "One pose held in free flight for {time} s.",
            "{amount} poses held in free flight for {time} s.",
            amount=_amount(len(works.poses)),
            time=significant(sum(target.dwell_s for target in works.poses), 6),
        )
    error = _millimetres(result, "tracking.tool_error_p95_m")
    if not works.poses or works.pulls or not error:
        return
    if works.touches:
        yield say(
            "Out of contact the tip was within {error} mm of its reference 95 % of the time.",
            error=error,
        )
    else:
        yield say(
            "From take-off to landing the tip was within {error} mm of its reference 95 % of the "
            "time.",
            error=error,
        )


def _pulled(works: Works, result: Result) -> Text:
    force = result.value("pull.force_peak_n")
    moved = _millimetres(result, "pull.displacement_max_m")
    yaw = result.value("pull.yaw_max_rad")
    amount = _amount(works.pulls)
    if force is None:
        return count(works.pulls, "One pull at a cord.", "{amount} pulls at a cord.", amount=amount)
    strength = significant(force, 2)
    if not moved or yaw is None:
        return count(
            works.pulls,
            "One pull at a cord with up to {force} N.",
            "{amount} pulls at a cord with up to {force} N.",
            amount=amount,
            force=strength,
        )
    return count(
        works.pulls,
        "One pull at a cord with up to {force} N moved the body by up to {moved} mm and turned it "
        "by up to {yaw} rad.",
        "{amount} pulls at a cord with up to {force} N moved the body by up to {moved} mm and "
        "turned it by up to {yaw} rad.",
        amount=amount,
        force=strength,
        moved=moved,
        yaw=significant(yaw, 2),
    )


def _pressed(works: Works, result: Result) -> Iterator[Text]:
    if not works.contacts:
        return
    force, amount = result.value("contact.force_mean_n"), _amount(len(works.contacts))
    if force is None:
        yield count(
            len(works.contacts),
            "One point was pressed without a reading.",
            "{amount} points were pressed without a reading.",
            amount=amount,
        )
    else:
        yield count(
            len(works.contacts),
            "One point was pressed without a reading, on average with {force} N.",
            "{amount} points were pressed without a reading, on average with {force} N.",
            amount=amount,
            force=significant(force, 3),
        )


def _estimated(works: Works, result: Result) -> Iterator[Text]:
    if not works.ground_truth:
        return
    force = {axis: result.value(f"force_sensor.rmse_f{axis}_n") for axis in "xyz"}
    if all(value is not None for value in force.values()):
        yield say(
            "The estimated force is off the wall's sensor by {x}, {y}, {z} N RMS along x, y, z.",
            **{axis: significant(value, 2) for axis, value in force.items()},
        )
    place = {axis: result.value(f"estimation.rmse_{axis}_m") for axis in "xyz"}
    if all(value is not None for value in place.values()):
        yield say(
            "The estimated position is off by {x}, {y}, {z} mm RMS.",
            **{axis: number(1e3 * (value or 0.0), 1) for axis, value in place.items()},
        )


def _amount(n: int, place: int = 0) -> Text:
    """A small number in words; at the beginning of a sentence, or (1) within it."""
    return SMALL_NUMBERS[n][place] if n in SMALL_NUMBERS else number(n, 0)


def _millimetres(result: Result, metric: str) -> Amount | None:
    """The metric in mm; None where it was not measured."""
    value = result.value(metric)
    return None if value is None else number(1e3 * value, 1 if 1e3 * value < 9.95 else 0)
