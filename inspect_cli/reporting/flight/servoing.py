"""A slide along a surface that only the depth camera knows: from the side, and over time.

After Figs. 8 and 9 of Bodie et al., RSS 2019.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from inspect_cli.metrics.flight import FlightData, NotMeasured, Rows
from inspect_cli.metrics.geometry import rotation_vectors, turned_by
from inspect_cli.metrics.slide import Slide, slides
from inspect_cli.records import Estimate, SurfaceEstimate, TrueContact
from inspect_cli.reporting.figures.figure import Figure, Json, numbers
from inspect_cli.reporting.figures.palette import (
    ESTIMATE,
    REFERENCE,
    SEEN_SURFACE,
    TRUE_SURFACE,
    TRUTH,
    LineStyle,
)
from inspect_cli.reporting.figures.rows import turned_to_body, turned_to_world
from inspect_cli.reporting.figures.timeline import Line, Mark, Panel, Span, Timeline, stacked
from inspect_cli.reporting.flight.drawing import extent
from inspect_cli.reporting.words.text import say, together
from inspect_cli.schema.modes import AT_SURFACE
from inspect_cli.spatial.arrays import Points, Structured, Vector

ARROW_EVERY_S = 0.2
ARROW_M = 0.05
NEAR_M = 0.15
"""Of the approach and the retreat only what is this near to the surface is drawn from the side."""
AROUND_S = 2.0
PANEL_PX = 96
OFF = say("along the normal, off the surface (m)")
INTO = say("along the normal, into the surface (m)")


@dataclass(frozen=True)
class SideView:
    """A plane to draw in: an origin in W and its two axes."""

    origin_W: Vector
    axes_W: Points
    """(2, 3): along the slide, and along the normal."""
    off_surface: bool
    """Whether the second axis points off the surface, which it does unless that is down."""

    def of(self, p_W: Points) -> Points:
        """Coordinates (n, 2) of points (n, 3), m."""
        seen: Points = (p_W - self.origin_W) @ self.axes_W.T
        return seen


def slides_of(flight: FlightData) -> list[Slide]:
    """The slides of the flight; none if the log does not show them."""
    try:
        return [slide for slide in slides(flight) if len(slide.contact)]
    except NotMeasured:
        return []


def servoing_figures(flight: FlightData, number: int, slide: Slide) -> list[Figure]:
    """One slide from the side, and its attitude, distance and force over time."""
    return [_from_the_side(flight, number, slide), _over_time(flight, number, slide)]


def _busy(flight: FlightData, slide: Slide) -> Rows:
    """Rows from the approach to the retreat of a slide."""
    at_hand = flight.reference["target"] == slide.target.index
    rows: Rows = np.flatnonzero(flight.during(*AT_SURFACE) & at_hand)
    return rows


def _side_view(flight: FlightData, slide: Slide) -> SideView:
    """The plane of x_T and the normal at the first touch."""
    first = slide.contact[:1]
    n_W = flight.on_state_ticks(TrueContact)["n_W"][first[0]]
    x_T = turned_by(flight.state["q_WT"][first], np.array([[1.0, 0.0, 0.0]]))[0]
    along = x_T - (x_T @ n_W) * n_W
    along /= np.linalg.norm(along)
    tip_W = flight.state["p_WT"][slide.moving]
    if (tip_W[-1] - tip_W[0]) @ along < 0.0:
        along = -along
    off = bool(n_W[2] > -0.1)
    return SideView(flight.state["p_WT"][first[0]], np.array([along, n_W if off else -n_W]), off)


def _from_the_side(flight: FlightData, number: int, slide: Slide) -> Figure:
    view, rows = _side_view(flight, slide), _busy(flight, slide)
    state, contact = flight.state, flight.on_state_ticks(TrueContact)
    rows = rows[np.abs(contact["distance"][rows]) < NEAR_M]
    foot_W = state["p_WT"] - contact["distance"][:, None] * contact["n_W"]
    known = rows[contact["surface"][rows] >= 0.0]
    traces = [
        _path(view.of(foot_W[known]), TRUE_SURFACE),
        _path(view.of(flight.reference["p_WT"][rows]), REFERENCE),
        _path(view.of(state["p_WT"][rows]), LineStyle(say("tool's tip (truth)"), TRUTH.colour)),
    ]
    estimate = flight.log.rows(Estimate)
    if estimate is not None:
        tip_W = _believed_tip(flight)[rows]
        traces.append(
            _path(view.of(tip_W), LineStyle(say("tool's tip (estimate)"), ESTIMATE.colour))
        )
    seen = _seen(flight, slide)
    if seen is not None:
        traces += _arrows(view, seen)
    layout: Json = {
        "hovermode": "closest",
        "margin": {"t": 72},
        "xaxis": {"title": {"text": say("along the slide (m)")}, "constrain": "domain"},
        "yaxis": {
            "title": {"text": OFF if view.off_surface else INTO},
            "scaleanchor": "x",
            "constrain": "domain",
        },
    }
    return Figure(
        f"slide-{number}-side",
        say(
            "The slide from the side, in the plane of x_T and the normal at the first touch, "
            "which is the origin; equal scales. Arrows, one every 0.2 s in contact: the point on "
            "the tool's axis and the normal as the depth camera gave them, in the world as it was"
            " estimated. The set-point lies behind the surface on purpose."
        ),
        say("Side view of the slide: set-point, tip, seen points with normals, true surface."),
        traces,
        layout,
        460,
        slope=_slope(view, [state["p_WT"][rows], flight.reference["p_WT"][rows]]),
    )


def _slope(view: SideView, tracks: Sequence[Points]) -> float:
    """Height over width of what is seen of the tracks."""
    low, high = extent(np.vstack([view.of(p_W) for p_W in tracks]))
    width, height = high - low
    return float(height / max(width, 1e-6))


def _believed_tip(flight: FlightData) -> Points:
    """Where the tip was by the estimate of the body and the true place of the tip on it, (n, 3)."""
    state, estimate = flight.state, flight.on_state_ticks(Estimate)
    p_BT = turned_to_body(state["q_WB"], state["p_WT"] - state["p_WB"])
    tip_W: Points = estimate["p_WB"] + turned_to_world(estimate["q_WB"], p_BT)
    return tip_W


def _seen(flight: FlightData, slide: Slide) -> Structured | None:
    """The valid estimates of the surface during the contact, one every 0.2 s."""
    rows = flight.log.rows(SurfaceEstimate)
    if rows is None:
        return None
    t_s = flight.state["t_s"][slide.contact]
    held = rows[(rows["valid"] > 0.5) & (rows["t_s"] >= t_s[0]) & (rows["t_s"] <= t_s[-1])]
    if len(held) == 0:
        return None
    slot = np.floor((held["t_s"] - held["t_s"][0]) / ARROW_EVERY_S + 1e-6)
    first_in_slot: Structured = held[np.concatenate([[True], np.diff(slot) > 0.0])]
    return first_in_slot


def _arrows(view: SideView, seen: Structured) -> list[Json]:
    """A dot on the surface as it was seen, and an arrow along the seen normal."""
    base, tip = view.of(seen["p_WC"]), view.of(seen["p_WC"] + ARROW_M * seen["n_W"])
    gap = np.full(len(base), np.nan)
    x = np.column_stack([base[:, 0], tip[:, 0], gap]).ravel()
    y = np.column_stack([base[:, 1], tip[:, 1], gap]).ravel()
    style = SEEN_SURFACE
    return [
        {
            "type": "scatter",
            "mode": "lines+markers",
            "name": style.label,
            "x": numbers(x),
            "y": numbers(y),
            "connectgaps": False,
            "line": {"color": style.colour, "width": style.width},
            "marker": {
                "color": style.colour,
                "symbol": ["circle", "arrow", "circle"] * len(base),
                "size": [4, 9, 0] * len(base),
                "angleref": "previous",
                "opacity": 1.0,
            },
            "hoverinfo": "name",
        }
    ]


def _path(xy: Points, style: LineStyle) -> Json:
    return {
        "type": "scatter",
        "mode": "lines",
        "name": style.label,
        "x": numbers(xy[:, 0]),
        "y": numbers(xy[:, 1]),
        "line": {"color": style.colour, "dash": style.dash, "width": style.width},
        "hovertemplate": together(style.label, "<br>%{x:.3f}, %{y:.3f} m<extra></extra>"),
    }


def _over_time(flight: FlightData, number: int, slide: Slide) -> Figure:
    t_s = flight.state["t_s"]
    busy = t_s[_busy(flight, slide)]
    moving, contact = t_s[slide.moving], t_s[slide.contact]
    timeline = Timeline(
        phases=(Span(float(contact[0]), float(contact[-1]), ""),),
        marks=(
            Mark(float(moving[0]), say("moves"), "right"),
            Mark(float(moving[-1]), say("stops"), "left"),
        ),
    ).within((float(busy[0]) - AROUND_S, float(busy[-1]) + AROUND_S))
    panels = [
        *_rotations(flight, slide),
        Panel(say("distance (m)"), _distances(flight), None, PANEL_PX, off_ground=True),
        Panel(
            say("force (N)"),
            [Line(t_s, flight.state["f_normal"], TRUTH)],
            None,
            PANEL_PX,
            off_ground=True,
        ),
    ]
    return stacked(
        f"slide-{number}-time",
        say(
            "Attitude of the tool as rotations about its own axes since the slide began: set-"
            "point by the seen normal, and truth; the set-point is in the world as it was "
            "estimated, so that an error of the estimate stands between the two. Below: distance "
            "from the tip to the surface, by the depth camera along the tool and in truth along "
            "the normal, and the true normal force. Shaded: contact. Between the marks the set-"
            "point moves along the surface."
        ),
        say("Rotation about the tool's three axes, distance and normal force over time."),
        panels,
        timeline,
    )


def _rotations(flight: FlightData, slide: Slide) -> list[Panel]:
    """Log(R_0ᵀ R_WT) of set-point and truth, R_0 the true one when the slide began, degrees."""
    state = flight.state
    conjugate = np.array([1.0, -1.0, -1.0, -1.0])
    q_BT = _products(state["q_WB"] * conjugate, state["q_WT"])
    wanted = _products(flight.reference["q_WB"], q_BT)
    start = np.tile(state["q_WT"][slide.moving[0]], (len(state), 1))
    tracks = [(wanted, REFERENCE), (state["q_WT"], TRUTH)]
    turns = [(np.degrees(rotation_vectors(start, q)), style) for q, style in tracks]
    return [
        Panel(
            say("about {axis} (°)", axis=f"{axis}<sub>T</sub>"),
            [Line(state["t_s"], turn[:, k], style) for turn, style in turns],
            None,
            PANEL_PX,
            off_ground=True,
        )
        for k, axis in enumerate("xyz")
    ]


def _products(a: Points, b: Points) -> Points:
    """The Hamilton products of rows of quaternions, (n, 4) wxyz."""
    u, v = a[:, 1:], b[:, 1:]
    w = a[:, :1] * b[:, :1] - np.sum(u * v, axis=1, keepdims=True)
    product: Points = np.hstack([w, a[:, :1] * v + b[:, :1] * u + np.cross(u, v)])
    return product


def _distances(flight: FlightData) -> Sequence[Line]:
    seen, true = flight.log.rows(SurfaceEstimate), flight.log.rows(TrueContact)
    lines = []
    if true is not None:
        near = np.where(true["surface"] >= 0.0, true["distance"], np.nan)
        lines.append(Line(true["t_s"], near, TRUTH))
    if seen is not None:
        usable = np.where(seen["valid"] > 0.5, seen["distance"], np.nan)
        lines.append(Line(seen["t_s"], usable, ESTIMATE))
    return lines
