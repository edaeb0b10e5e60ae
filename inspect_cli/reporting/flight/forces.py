"""Figures of contact force, external wrench, seen surface and actuators."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from inspect_cli.log.reader import RunLog
from inspect_cli.records import (
    Command,
    Estimate,
    Probe,
    Reference,
    State,
    SurfaceEstimate,
    TrueContact,
)
from inspect_cli.reporting.figures.figure import Figure, Json
from inspect_cli.reporting.figures.palette import (
    COMMAND,
    ESTIMATE,
    ESTIMATION_ERROR,
    SATURATED,
    SENSOR,
    TRUTH,
    LineStyle,
)
from inspect_cli.reporting.figures.rows import held_at, rows_of, turned_to_world
from inspect_cli.reporting.figures.timeline import Line, Panel, Timeline, stacked
from inspect_cli.reporting.words.text import Text, say, together
from inspect_cli.schema.modes import AT_SURFACE, ModeTable
from inspect_cli.schema.plan import Plan
from inspect_cli.spatial.arrays import Points, Structured, Vector

FORCE = (
    say(
        "External force about the body's origin, in the body frame: observer against truth. "
        "The axes are scaled to the time between take-off and landing."
    ),
    say("Three components of the external force over time, estimated and true."),
)
TORQUE = (
    say(
        "External torque about the body's origin, in the body frame: observer against truth. "
        "The axes are scaled to the time between take-off and landing."
    ),
    say("Three components of the external torque over time, estimated and true."),
)


def force_figures(log: RunLog, plan: Plan, timeline: Timeline) -> Iterator[Figure]:
    """The contact force three ways, and the estimated against the true wrench."""
    yield from _drawn(
        "force",
        say(
            "Force along the surface's normal, pressing is positive. The estimate is the momentum "
            "observer's force along the planned normal, drawn near a surface; it holds all other "
            "external force too."
        ),
        say("Normal contact force over time: true, by the probe's load cell, and estimated."),
        [Panel(say("normal force (N)"), _normal_forces(log, plan), height_px=240, off_ground=True)],
        timeline,
    )
    for name, first, unit, symbol, (caption, description) in (
        ("force", 0, "N", "F", FORCE),
        ("torque", 3, "N·m", "τ", TORQUE),
    ):
        yield from _drawn(
            f"wrench-{name}",
            caption,
            description,
            [
                Panel(
                    f"{symbol}<sub>{axis}</sub> ({unit})",
                    _wrench(log, first + k),
                    off_ground=True,
                )
                for k, axis in enumerate("xyz")
            ],
            timeline,
        )


def surface_figures(log: RunLog, timeline: Timeline) -> Iterator[Figure]:
    """What the depth camera saw of the surface, against the truth where there is one."""
    surface, contact = rows_of(log, SurfaceEstimate), rows_of(log, TrueContact)
    if surface is None:
        return
    usable = surface["valid"] > 0.5
    distances = [Line(surface["t_s"], np.where(usable, surface["distance"], np.nan), ESTIMATE)]
    panels = [Panel(say("distance (m)"), distances)]
    if contact is not None:
        near = np.where(contact["surface"] >= 0, contact["distance"], np.nan)
        distances.insert(0, Line(contact["t_s"], near, TRUTH))
        true_n_W = held_at(contact, surface["t_s"])["n_W"]
        angle = np.where(usable, _angle_deg(surface["n_W"], true_n_W), np.nan)
        lines = [Line(surface["t_s"], angle, ESTIMATION_ERROR)]
        panels.append(Panel(say("normal error (°)"), lines, {"rangemode": "tozero"}))
    yield from _drawn(
        "tof",
        say(
            "Depth camera: distance from the tool's tip to the surface (estimated along the tool, "
            "true along the normal), and the angle between estimated and true normal. Gaps are "
            "estimates that were not to be used."
        ),
        say(
            "Estimated and true distance to the surface, and angle between the normals, over time."
        ),
        panels,
        timeline,
    )


def actuator_figures(log: RunLog, timeline: Timeline) -> Iterator[Figure]:
    """Thrust of every rotor, angle of every joint, and where the allocation saturated."""
    command = rows_of(log, Command)
    panels = [
        Panel(
            say("thrust (N)"), _per_actuator(log, "rotor_thrust", say("rotor"), 1.0), height_px=170
        ),
        Panel(
            say("joint angle (°)"), _per_actuator(log, "joint_angle", say("joint"), 180.0 / np.pi)
        ),
    ]
    if command is not None:
        filled = {"fill": "tozeroy", "line": {"shape": "hv"}}
        lines = [Line(command["t_s"], command["saturated"], SATURATED, filled)]
        axis = {"range": [-0.1, 1.1], "tickvals": [0, 1], "ticktext": [say("no"), say("yes")]}
        panels.append(Panel(say("saturated"), lines, axis, 44))
    yield from _drawn(
        "actuators",
        say(
            "Thrust of each rotor and angle of each tilt and arm joint, as they were and as they "
            "were commanded, and where the allocation had to scale the wrench down."
        ),
        say("Rotor thrusts, joint angles and saturation over time."),
        panels,
        timeline,
    )


def _drawn(
    name: str, caption: Text, description: Text, panels: Sequence[Panel], timeline: Timeline
) -> Iterator[Figure]:
    """The figure of the panels that have a line, if there is any."""
    filled = [panel for panel in panels if panel.lines]
    if filled:
        yield stacked(name, caption, description, filled, timeline)


def _normal_forces(log: RunLog, plan: Plan) -> list[Line]:
    state, probe, estimate = (rows_of(log, r) for r in (State, Probe, Estimate))
    reference = rows_of(log, Reference)
    lines = []
    if probe is not None:
        lines.append(Line(probe["t_s"], probe["force"], SENSOR))
    if state is not None:
        lines.append(Line(state["t_s"], state["f_normal"], TRUTH))
    if estimate is not None and reference is not None:
        held = held_at(reference, estimate["t_s"])
        force = _felt_normal_force(estimate, held, plan, log.modes())
        lines.append(Line(estimate["t_s"], force, ESTIMATE))
    return lines


def _felt_normal_force(
    estimate: Structured, reference: Structured, plan: Plan, modes: ModeTable
) -> Vector:
    """n_Wᵀ R_WB f̂_B with the planned normal of the target at hand; NaN away from surfaces."""
    normals = np.full((len(plan.targets) + 1, 3), np.nan)  # the last row answers for target −1
    for k, target in enumerate(plan.targets):
        normals[k] = target.n_W
    at_hand = np.clip(reference["target"].astype(int), -1, len(plan.targets) - 1)
    near = modes.within(reference["mode"], AT_SURFACE)
    n_W = np.where(near[:, None], normals[at_hand], np.nan)
    f_W = turned_to_world(estimate["q_WB"], estimate["wrench_B"][:, :3])
    force: Vector = np.einsum("ij,ij->i", n_W, f_W)
    return force


def _wrench(log: RunLog, component: int) -> list[Line]:
    sources = ((State, "wrench_ext_B", TRUTH), (Estimate, "wrench_B", ESTIMATE))
    found = [(rows_of(log, record), field, style) for record, field, style in sources]
    return [
        Line(rows["t_s"], rows[field][:, component], style)
        for rows, field, style in found
        if rows is not None
    ]


def _angle_deg(a: Points, b: Points) -> Vector:
    """Between rows of unit vectors; the arctangent stays exact for small angles."""
    sine = np.linalg.norm(np.cross(a, b), axis=1)
    angle: Vector = np.rad2deg(np.arctan2(sine, np.einsum("ij,ij->i", a, b)))
    return angle


def _per_actuator(log: RunLog, field: str, noun: Text, scale: float) -> list[Line]:
    """One line per rotor or joint and source; the legend shows each source once."""
    sources: tuple[tuple[Structured | None, LineStyle], ...] = (
        (rows_of(log, Command), COMMAND),
        (rows_of(log, State), TRUTH),
    )
    lines = []
    for rows, style in sources:
        if rows is None:
            continue
        for k in range(rows[field].shape[1]):
            hover: Json = {
                "opacity": 0.6,
                "line": {"width": 1.0},
                "hovertemplate": together(noun, f" {k + 1}: %{{y:.2f}}"),
            }
            lines.append(Line(rows["t_s"], scale * rows[field][:, k], style, hover))
    return lines
