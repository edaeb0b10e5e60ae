"""Sentences in results and plans, recognised by their templates so that they can be translated.

``metrics.json`` and ``plan.json`` are written once, in English: why a point is invalid, why a
metric is not measured, how a flight ended, which class a reading has. A report knows these
sentences by their templates. What it does not know is somebody else's and is shown as it stands.
"""

from __future__ import annotations

import re
from functools import cache

from inspect_cli.reporting.words.language import pieces
from inspect_cli.reporting.words.pitch_findings import PITCH_FINDINGS
from inspect_cli.reporting.words.recorded_findings import FINDINGS
from inspect_cli.reporting.words.recorded_pictures import PICTURES
from inspect_cli.reporting.words.text import Said, Text, number, say

PLAIN_NUMBER = re.compile(r"-?[0-9]+(?:\.([0-9]+))?")
NAMES = ("label", "labels", "topic", "other", "kind", "first", "second", "name")
"""Values that are somebody's names even where they look like numbers."""
SENTENCES = ("why", "status", "what")
"""Values that are sentences of this list themselves."""

RECORDED: tuple[Said, ...] = (
    # How a flight ended, and how much a line of its log weighs.
    *(say("completed"), say("aborted"), say("diverged"), say("interrupted"), say("not flown")),
    *(say("debug"), say("info"), say("warning"), say("error"), say("fatal")),
    *(say("sortie {n} was {status}: {why}"), say("sortie {n} was {status}")),
    say("only the first sortie was flown"),
    say("only the first {n} sorties were flown"),
    # Classes of readings.
    *(say("passive"), say("uncertain"), say("active"), say("none"), say("possible")),
    # Angles of an attitude.
    *(say("roll"), say("pitch"), say("yaw")),
    # Believed surfaces and the parameters of their fits.
    *(say("plane"), say("cylinder"), say("sphere"), say("given as a shape")),
    *(say("offset"), say("radius"), say("tilt"), say("tilt {n}"), say("center {name}")),
    # Why a point is invalid.
    say("not visited"),
    say("the flight ended before it was read"),
    say("the reading counts as valid but has no potential"),
    say("the reading counts as valid but has no {name}"),
    say("force: the probe never touched anything"),
    say("force: it did not stay at {force} N for {time} s"),
    say("the potential did not stay within {band} mV for {time} s"),
    say("open circuit between probe and reinforcement"),
    say("the probe sent nothing"),
    say("off target: the tool touched the surface too far from its point"),
    say("the flight was aborted"),
    say("reason {code}"),
    # Why a metric is not measured, and what a check that passes has to say.
    say("marked as a known failure, but it holds"),
    say("the log has no {topic}"),
    say("the log has nothing on {topic}"),
    say("the log holds numbers that are not finite"),
    say("the log holds no place that could be drawn"),
    say("{topic} and {other} are up to {apart} s apart; they must share ticks within {limit} s"),
    say("f_normal on {topic} is not known throughout the flight"),
    say("it belongs to a single flight and is in the report of each"),
    say("it was not measured"),
    say("there is no metric '{name}'"),
    say("there is no metric '{name}'; did you mean '{other}'?"),
    say("it compares with mission '{name}', which only `inspect regress` flies beside it"),
    say("mission '{name}' was not flown with the same seed"),
    say("in mission '{name}': {why}"),
    say("'{name}' is zero in mission '{other}'"),
    say("sortie {n}: {why}"),
    say("{name} is zero in every sortie"),
    say("the plan has nothing to touch"),
    say("the plan has no point to read"),
    say("the plan has no point to read with {name}"),
    say("the plan has no surface to follow"),
    say("the plan has no stroke to draw"),
    say("the flight never got to the phase that this is measured in"),
    say("the vehicle never left the ground"),
    say("a platform of kind '{kind}' states no rotor drives"),
    say("the log has {n} rotors, the platform {stated}"),
    say("no valid estimate of a surface during approach, press or retreat"),
    say("the tool never touched a surface"),
    say("the tool never touched anything"),
    say("no point was pressed"),
    say("never pressed: {labels}"),
    say("target {label} was never touched"),
    say("target {label} was never slid along"),
    say("the reference of target {label} did not move along the surface"),
    say("no dwell lasted longer than {time} s"),
    say("no contact lasted longer than {time} s"),
    say("no stroke is drawn twice"),
    say("strokes {first} and {second} are not equally long"),
    say("samples of the wall's force sensor are missing"),
    say("the wall's force sensor is too slow for a filter of {cutoff} Hz"),
    say("the error does not change at all in hover"),
    say("the flight was not flown on odometry"),
    say("the odometry truly drifted otherwise than its model says"),
    say("no reading is valid"),
    say("no valid reading has a resistance"),
    # Why a metric of the assessment has no value.
    say("no point to read lies on a known surface"),
    say("several surfaces have populations of their own"),
    say("there is no threshold between two populations"),
    say("the points of all sorties were not looked at together"),
    say("the log knows no specimen where readings were taken"),
    say("the log knows no specimen where the tool pressed"),
    say("nobody pulled at a rope during the flight"),
    say("the cord of a pull was never taut"),
    say("the cord pulled straight up or down"),
    say("a pull caused no {what} at all to compare with"),
    *(say("motion in z"), say("rotation"), say("torque about z_B")),
    say("every valid potential is in the passive class: none stands out"),
    say("the log does not hold what is truly so beneath a surface"),
    say("the log does not hold what is truly so beneath a surface where points were planned"),
    say("the platform has no instrument '{name}'"),
    say("the platform has no tracker, whose frame this is held against"),
    say("a single point on '{name}' does not say what area it stands for"),
    *PITCH_FINDINGS,
    *FINDINGS,
    *PICTURES,
)


def recorded(text: str) -> Text:
    """The sentence with its numbers and names as values, if its template is known; else
    unchanged."""
    for said, pattern in _patterns():
        found = pattern.fullmatch(text)
        if found:
            return Said(said.template, {n: _value(n, v) for n, v in found.groupdict().items()})
    return text


def _value(name: str, text: str) -> Text:
    if name in SENTENCES:
        return recorded(text)
    digits = PLAIN_NUMBER.fullmatch(text)
    if digits is None or name in NAMES:
        return text
    return number(float(text), len(digits[1] or ""))


@cache
def _patterns() -> tuple[tuple[Said, re.Pattern[str]], ...]:
    return tuple((said, _pattern(said.template)) for said in RECORDED)


def _pattern(template: str) -> re.Pattern[str]:
    """A regular expression that matches the template with any values."""
    parts = []
    for words, name in pieces(template):
        anything = ".+?" if name in NAMES or name in SENTENCES else "[-+0-9.e]+"
        parts.append(re.escape(words) + (f"(?P<{name}>{anything})" if name else ""))
    return re.compile("".join(parts), re.DOTALL)
