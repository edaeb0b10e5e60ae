"""From a task to the points on the believed surface that shall be touched."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from inspect_cli.schema.base import Triple
from inspect_cli.schema.tasks import Task
from inspect_cli.schema.tasks.base import Instrument, Pressing
from inspect_cli.schema.tasks.contact_grid import ContactGrid
from inspect_cli.schema.tasks.contact_points import ContactPoints
from inspect_cli.spatial.arrays import Structured, Vector
from inspect_cli.spatial.primitives import normal_at, point_at, project

EDGE_M = 1e-9
"""Rounding that is forgiven at the edge of a patch."""


@dataclass(frozen=True)
class ContactPoint:
    """A point to touch, on the surface as it is believed to be.

    ``p_WC`` (3,) m and the outward normal ``n_W`` (3,) in W. ``fault`` says why the surface
    cannot be touched there; empty when it can.
    """

    label: str
    surface: str
    uv_m: tuple[float, float]
    p_WC: Vector
    n_W: Vector
    options: Pressing
    impedance: str
    sensor: Instrument | None = None
    fault: str = ""
    cell_m: tuple[float, float] | None = None
    """Widths along u and v of what it stands for (``point_cells``)."""

    def in_front(self, distance_m: float) -> Vector:
        """The point (3,) m in W at this distance from the surface; negative lies behind it."""
        ahead: Vector = self.p_WC + distance_m * self.n_W
        return ahead


def points_of_task(
    task: Task,
    prim: Structured,
    first_number: int,
    impedance: str,
    cell_m: tuple[float, float] | None,
) -> list[ContactPoint]:
    """The points of a task of contacts in the order in which the mission gives them.

    ``prim`` is the surface's PRIMITIVE array of length 1. Points are labelled with numbers
    from ``first_number`` on. Points that cannot be touched are returned with their fault.
    ``impedance`` is the profile that they are touched with, ``cell_m`` what each stands for.
    """
    contact = task.work
    assert isinstance(contact, ContactGrid | ContactPoints)  # the planner sorts tasks by kind
    sensor = task.instrument
    return [
        point_on(prim, (u, v), str(number), contact.on, contact, impedance, sensor, fault, cell_m)
        for number, (u, v, fault) in enumerate(places_of_task(contact, prim), first_number)
    ]


def places_of_task(
    contact: ContactGrid | ContactPoints, prim: Structured
) -> list[tuple[float, float, str]]:
    """(u, v) m of a task's points on the surface, and what is wrong with each."""
    if isinstance(contact, ContactGrid):
        return [(u, v, "") for u, v in grid_uv(contact)]
    return [_projected(prim, p_W, contact.tolerance_m) for p_W in contact.at_m]


def point_on(
    prim: Structured,
    uv_m: tuple[float, float],
    label: str,
    surface: str,
    options: Pressing,
    impedance: str,
    sensor: Instrument | None = None,
    fault: str = "",
    cell_m: tuple[float, float] | None = None,
) -> ContactPoint:
    """The point at (u, v) m of a surface, with its fault where it lies outside of the patch."""
    u, v = uv_m
    return ContactPoint(
        label=label,
        surface=surface,
        uv_m=uv_m,
        p_WC=point_at(prim, 0, u, v),
        n_W=normal_at(prim, 0, u, v),
        options=options,
        impedance=impedance,
        sensor=sensor,
        fault=fault or outside(prim, u, v),
        cell_m=cell_m,
    )


def in_words(vector: Iterable[float]) -> str:
    """A vector as messages show it: two decimals, no negative zero."""
    return "(" + ", ".join(f"{round(float(x), 2) + 0.0:.2f}" for x in vector) + ")"


def grid_uv(grid: ContactGrid) -> list[tuple[float, float]]:
    """(u, v) m of a grid's points, row by row from the top, each from the lowest u to the highest.

    The grid's middle lies ``offset_m`` from the middle of the surface; row 0 has the largest v.
    """
    u_middle, v_middle = grid.offset_m
    return [
        (
            u_middle + (column - 0.5 * (grid.columns - 1)) * grid.pitch_m,
            v_middle - (row - 0.5 * (grid.rows - 1)) * grid.pitch_m,
        )
        for row in range(grid.rows)
        for column in range(grid.columns)
    ]


def _projected(prim: Structured, p_W: Triple, tolerance_m: float) -> tuple[float, float, str]:
    """(u, v) m of a given point's foot on the surface, and what is wrong with the point."""
    u, v, height_m = (float(x) for x in project(prim, 0, np.array(p_W)))
    if abs(height_m) <= tolerance_m:
        return u, v, ""
    fault = (
        f"a point off the surface: {in_words(p_W)} is {abs(height_m):.3f} m from it, "
        f"tolerance_m is {tolerance_m:.3f}"
    )
    return u, v, fault


def outside(prim: Structured, u: float, v: float) -> str:
    """Why a point at (u, v) m cannot be touched: it lies beyond the patch. Empty if it does not."""
    half_u, half_v = (float(x) for x in prim["half_size"][0])
    if abs(u) <= half_u + EDGE_M and abs(v) <= half_v + EDGE_M:
        return ""
    return (
        f"outside the patch: it lies at u {u:.3f} m, v {v:.3f} m, "
        f"the patch ends at ±{half_u:.3f} m, ±{half_v:.3f} m"
    )
