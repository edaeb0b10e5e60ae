"""Captions of pictures, recognised by their templates; see ``recorded``."""

from __future__ import annotations

from inspect_cli.reporting.words.text import Said, say

PICTURES: tuple[Said, ...] = (
    say("{name} touching the structure, {n} s after the log begins ({what})."),
    say("{name} touching the structure, {n} s after the log begins."),
    say("{name}, {n} s after the log begins ({what})."),
    say("{name}, {n} s after the log begins."),
    say("{name}: {n} s of flight ({what}), shown in real time."),
    say("{name}: {n} s of flight, shown in real time."),
    say("{name}: {n} s of flight ({what}), shown {speed} times as fast."),
    say("{name}: {n} s of flight, shown {speed} times as fast."),
    say("sortie {n} of {total}"),
    say("Rendered from the log."),
    say("Poses are the simulation's true ones, the structure is as the planner believed it."),
    say("Poses are the vehicle's own estimate, the structure is as the planner believed it."),
    say("The log was interrupted."),
    say("What the log holds after that cannot be drawn: the flight diverged."),
    # Why there are none.
    say("No pictures: {why}; 'inspect doctor' says what is missing."),
    say("No film: {why}; 'inspect doctor' says what is missing."),
    say("No pictures: {why}."),
    say("MuJoCo cannot be loaded ({name})"),
    say("the scene cannot be built ({name})"),
    say("the log holds no poses of the vehicle to draw"),
    say("rendering took longer than {time} s"),
    say("the renderer cannot be started: {name}"),
    say("the renderer was ended by signal {n}"),
    say("the renderer failed ({name})"),
    say("the renderer left no file"),
)
