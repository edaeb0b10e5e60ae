"""The flight itself: tracking, forces, actuators, path, modes and events."""

from __future__ import annotations

from inspect_cli.metrics.instruments import INSTRUMENTS
from inspect_cli.reporting.chapters.chapter import Chapter
from inspect_cli.reporting.chapters.material import Material
from inspect_cli.reporting.content.blocks import Block, Heading, drawn
from inspect_cli.reporting.content.metrics_table import metrics_table
from inspect_cli.reporting.flight.events_table import events_table
from inspect_cli.reporting.flight.forces import actuator_figures, force_figures, surface_figures
from inspect_cli.reporting.flight.modes import modes_figure
from inspect_cli.reporting.flight.scene import scene_figure
from inspect_cli.reporting.flight.tracking import tracking_figures
from inspect_cli.reporting.words.text import say

ERROR_GROUPS = ("tracking", "estimation")
CONTACT_GROUPS = ("contact", *INSTRUMENTS)


def _blocks(material: Material) -> list[Block]:
    log, timeline, result = material.log, material.timeline, material.result
    modes = modes_figure(log)
    errors = say("Errors of tracking and estimation.")
    return [
        Heading(say("Pose tracking")),
        *drawn(tracking_figures(log, timeline), side_by_side=True),
        *metrics_table(errors, result, ERROR_GROUPS),
        *_forces(material),
        Heading(say("Actuators")),
        *drawn(actuator_figures(log, timeline)),
        Heading(say("Path in space")),
        *drawn([scene_figure(log, material.plan, material.scene_marks)]),
        Heading(say("Modes and events")),
        *drawn([modes] if modes else []),
        *events_table(log),
        *metrics_table(say("Other metrics."), result, _other_groups(material)),
    ]


def _forces(material: Material) -> list[Block]:
    """What it pressed with and what it saw; where nothing was touched, what it felt."""
    profile, timeline = material.profile, material.timeline
    forces = list(force_figures(material.log, material.plan, timeline))
    if not profile.touches:
        wrench = [figure for figure in forces if figure.name != "force"]
        return [Heading(say("External wrench")), *drawn(wrench, side_by_side=True)]
    caption = say("Contact and readings.") if profile.readings else say("Contact.")
    elsewhere = material.hidden_groups | material.own_groups
    groups = [group for group in CONTACT_GROUPS if group not in elsewhere]
    seen = drawn(surface_figures(material.log, timeline))
    return [
        Heading(say("Contact force and external wrench")),
        *drawn(forces[:1]),
        *drawn(forces[1:], side_by_side=True),
        *metrics_table(caption, material.result, groups),
        *([Heading(say("Surface seen by the depth camera")), *seen] if seen else []),
    ]


def _other_groups(material: Material) -> list[str]:
    """The groups of metrics that no other table shows and that concern this mission."""
    elsewhere = {*ERROR_GROUPS, *CONTACT_GROUPS, *material.own_groups, *material.hidden_groups}
    groups = (name.split(".")[0] for name in material.result.metrics)
    return [group for group in groups if group not in elsewhere]


CHAPTER = Chapter(
    heading=say("Flight"),
    applies=lambda material: material.coverage is None,
    blocks=_blocks,
    on_paper=False,
    appendix=True,
)
