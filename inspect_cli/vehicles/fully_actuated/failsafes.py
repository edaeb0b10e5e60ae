"""The failsafes of a fully actuated vehicle: each ends the mission in a hover.

The milder fallback backs off from the surface to the standoff first. Each condition is written so
that a NaN violates it.
"""

from __future__ import annotations

from inspect_cli.autonomy.failsafe import Failsafe
from inspect_cli.vehicles.fully_actuated.context import POSE_AGE_S, STALE_S
from inspect_cli.vehicles.fully_actuated.modes import back_off, stop

FLYING = frozenset({"takeoff", "transit", "hold", "approach", "press", "slide", "retreat", "land"})
NEAR_SURFACE = frozenset({"approach", "press", "slide"})
FREE = frozenset({"transit", "approach"})
BACK_OFF, STOP = 1, 2
"""Severities."""

FAILSAFES: tuple[Failsafe, ...] = (
    Failsafe(
        "pose measurements lost",
        FLYING,
        lambda i: not i.t_s - i.pose_heard_s <= POSE_AGE_S,
        0.0,
        BACK_OFF,
        (back_off,),
    ),
    Failsafe(
        "surface not seen by the depth camera",
        NEAR_SURFACE,
        lambda i: not i.t_s - i.surface_seen_s <= STALE_S,
        1.5,
        BACK_OFF,
        (back_off,),
    ),
    Failsafe(
        "surface lost while sliding",
        frozenset({"slide"}),
        lambda i: not i.t_s - i.surface_seen_s <= STALE_S,
        0.0,
        BACK_OFF,
        (back_off,),
    ),
    Failsafe(
        "surface contradicts the plan",
        NEAR_SURFACE,
        lambda i: not i.surface_seen_s - i.surface_agreed_s <= STALE_S,
        0.5,
        BACK_OFF,
        (back_off,),
    ),
    Failsafe(
        "surface nearer than planned on the way",
        frozenset({"transit"}),
        lambda i: not i.surface_distance_m >= i.least_distance_m + i.stopping_m,
        0.0,
        STOP,
        (stop,),
    ),
    Failsafe(
        "unexpected force above 12 N",
        FREE,
        lambda i: not i.force_n <= 12.0,
        0.1,
        BACK_OFF,
        (back_off,),
    ),
    Failsafe(
        "position error above 0.6 m",
        FLYING,
        lambda i: not i.position_error_m <= 0.6 + i.press_m,
        0.5,
        BACK_OFF,
        (back_off,),
    ),
    Failsafe(
        "attitude error above 0.6 rad",
        FLYING,
        lambda i: not i.attitude_error_rad <= 0.6,
        0.3,
        BACK_OFF,
        (back_off,),
    ),
)
