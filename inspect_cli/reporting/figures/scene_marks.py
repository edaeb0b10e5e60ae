"""What a chapter adds to the view of the structure in three dimensions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from inspect_cli.reporting.figures.figure import Json, numbers
from inspect_cli.reporting.figures.palette import INK
from inspect_cli.reporting.words.text import Text


@dataclass(frozen=True)
class SceneMarks:
    """Traces for the view, with what they need of its layout and its caption."""

    traces: Sequence[Json]
    layout: Mapping[str, Json] = field(default_factory=dict)
    """Such as a colour axis, under a name that no other chapter has."""
    sentence: Text = ""
    """What the caption says of them."""


def point_marks(
    name: Text, places_W: Sequence[Sequence[float]], marker: Json, hover: Sequence[Text]
) -> Json:
    """A trace of marks at places (n, 3) in W, m, each with the text under the pointer."""
    x, y, z = (numbers([p_W[k] for p_W in places_W]) for k in range(3))
    return {
        "type": "scatter3d",
        "mode": "markers",
        "name": name,
        "x": x,
        "y": y,
        "z": z,
        "marker": marker,
        "customdata": hover,
        "hovertemplate": "%{customdata}<extra></extra>",
    }


def invalid_marks(
    name: Text, places_W: Sequence[Sequence[float]], hover: Sequence[Text]
) -> list[Json]:
    """Crosses at the places (n, 3) in W, m, of readings that do not count; nothing without any."""
    cross = {"size": 5, "symbol": "x", "color": INK}
    return [point_marks(name, places_W, cross, hover)] if places_W else []
