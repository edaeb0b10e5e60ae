"""A survey that people took, from its file: every reading, or a refusal with the cell's address.

``read_survey`` is pure but for the files that it reads. Nothing is dropped: a point without a
reading stays with its reason, a repeated reading stays a reading of its own.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from inspect_cli.errors import InputError, Location, Problem
from inspect_cli.schema.survey import SurveySettings
from inspect_cli.spatial.arrays import Mask, Points, Vector
from inspect_cli.surveys.distances import require_spacing
from inspect_cli.surveys.files import SourceFile, read_cells
from inspect_cli.surveys.grids import Grid, grid_of
from inspect_cli.surveys.joining import joined_resistivity
from inspect_cli.surveys.layout import layout_of
from inspect_cli.surveys.lists import ReadingList, list_of
from inspect_cli.surveys.planes import LEVEL, TOLERANCE_M, FittedPlane, fitted_plane
from inspect_cli.surveys.plausible import potentials_mv, resistivities_ohm_m, temperatures_c
from inspect_cli.surveys.sentinels import refuse_sentinels
from inspect_cli.surveys.units import UNITS


@dataclass(frozen=True)
class SurveyGrid:
    """The grid that the readings were taken on, rows from the top."""

    rows: int
    columns: int
    row_names: tuple[str, ...] | None
    column_names: tuple[str, ...] | None
    spacing_m: tuple[float, float]
    """Between columns, between rows."""


@dataclass(frozen=True)
class Survey:
    """The readings of one surface, in the order of the file (a grid's row by row)."""

    files: tuple[SourceFile, ...]
    """The readings' file, and the resistivities' if there is one."""
    labels: tuple[str, ...]
    """``2/B`` in a grid with names, ``R1C1`` in one without, a list's own or its numbers."""
    uv_m: Points
    """(n, 2) along the surface: u to the right, v up, seen from outside."""
    p_W: Points | None
    """(n, 3), m, where the file has x, y and z."""
    potential_mv: Vector
    """(n,) against ``settings.electrode``, as given; NaN where there is no reading."""
    temperature_c: Vector | None
    """(n,) where the file has such a column; NaN where it says nothing."""
    resistivity_ohm_m: Vector
    """(n,) NaN where it is not known."""
    valid: Mask
    """(n,) whether there is a potential."""
    why: tuple[str, ...]
    """(n,) why there is none; empty where there is one."""
    grid: SurveyGrid | None
    plane: FittedPlane | None
    """Where readings in space were laid out on a plane."""
    settings: SurveySettings
    """As used: with the layout that the file has, and the units and the electrode it states."""
    assumed: tuple[str, ...]
    """The settings that matter for the result and that neither file nor user stated."""
    warnings: tuple[str, ...]
    """Sentences for whoever reads the result."""

    @property
    def points_W(self) -> Points:
        """(n, 3), m: where the readings are; without z, as ``settings.orientation`` says."""
        if self.p_W is not None:
            return self.p_W
        u, v = self.uv_m.T
        none = np.zeros(len(u))
        upright = self.settings.orientation == "upright"
        return np.column_stack([u, none, v] if upright else [u, v, none])


def read_survey(path: Path, settings: SurveySettings | None = None) -> Survey:
    """The survey that a CSV, TSV, text or Excel file holds.

    Args:
        path: the file; a grid of readings or a list with named columns.
        settings: what the file does not say (``surveys.settings.read_settings``).

    Raises:
        InputError: something in it is not certain; with file:line:column and the cell.
    """
    settings = settings or SurveySettings()
    cells, source = read_cells(path, settings.sheet)
    if layout_of(cells, "potential", settings.layout) == "grid":
        unit = UNITS[settings.potential_unit]
        return _survey_of_grid(path, grid_of(cells, unit), source, settings)
    return _survey_of_list(path, list_of(cells, "potential", settings), source, settings)


def _survey_of_grid(path: Path, grid: Grid, source: SourceFile, settings: SurveySettings) -> Survey:
    unit = UNITS[settings.potential_unit]
    stated = set(settings.model_fields_set)
    if "spacing_m" not in stated:
        require_spacing(grid)
    raw = grid.values.ravel()
    refuse_sentinels(raw, unit, grid.with_unit, grid.where)
    values = potentials_mv(raw, unit, "potential_unit" in stated, settings, grid.where)
    resistivity, stated_too, settings, files = _second_file(path, settings, grid, source)
    rows, columns = grid.values.shape
    du, dv = settings.spacing_m
    j, i = np.meshgrid(np.arange(columns), np.arange(rows))
    uv_m = np.column_stack([j.ravel() * du, (rows - 1 - i.ravel()) * dv]) + settings.origin_m
    matters = ["potential_unit", "electrode", "spacing_m", "orientation"]
    matters += ["resistivity_unit"] if len(files) > 1 else []
    return Survey(
        files=files,
        labels=grid.labels,
        uv_m=uv_m,
        p_W=None,
        potential_mv=values,
        temperature_c=None,
        resistivity_ohm_m=np.full(len(values), np.nan) if resistivity is None else resistivity,
        valid=np.isfinite(values),
        why=tuple(grid.gaps.get(k, "") for k in range(len(values))),
        grid=SurveyGrid(rows, columns, grid.row_names, grid.column_names, settings.spacing_m),
        plane=None,
        settings=settings.model_copy(update={"layout": "grid"}),
        assumed=tuple(key for key in matters if key not in stated | stated_too),
        warnings=grid.cells.warnings,
    )


def _survey_of_list(
    path: Path, rows: ReadingList, source: SourceFile, settings: SurveySettings
) -> Survey:
    stated = set(settings.model_fields_set) | rows.stated
    potential = rows.numbers["potential"]
    unit = rows.units["potential"]
    is_stated = "potential_unit" in stated
    refuse_sentinels(potential.values, unit, potential.with_unit, partial(rows.where, "potential"))
    values = potentials_mv(
        potential.values, unit, is_stated, settings, partial(rows.where, "potential")
    )
    own = _own_resistivity(rows)
    if own is not None and settings.resistivity is not None:
        what = "a column of resistivities where the settings name a file of them, too"
        raise rows.cells.refused(0, rows.columns["resistivity"], what, "remove one of the two")
    other, stated_too, settings, files = _second_file(path, settings, rows, source)
    resistivity = own if own is not None else other
    p_W, uv_m, plane, notes = _places(rows, settings)
    matters = ["potential_unit", "electrode", "coordinate_unit"]
    matters += ["resistivity_unit"] if resistivity is not None else []
    matters += ["orientation"] if plane is None else ["seen_from_m"]
    stated |= stated_too | ({"electrode"} if rows.electrode else set())
    if rows.ignored:
        notes += (f"Columns that were not read: {', '.join(rows.ignored)}.",)
    return Survey(
        files=files,
        labels=rows.labels,
        uv_m=uv_m,
        p_W=p_W,
        potential_mv=values,
        temperature_c=_own_temperature(rows),
        resistivity_ohm_m=np.full(len(values), np.nan) if resistivity is None else resistivity,
        valid=np.isfinite(values),
        why=tuple(potential.gaps.get(k, "") for k in range(len(values))),
        grid=None,
        plane=plane,
        settings=_as_used(rows, settings),
        assumed=tuple(key for key in matters if key not in stated),
        warnings=(*rows.cells.warnings, *notes),
    )


def _as_used(rows: ReadingList, settings: SurveySettings) -> SurveySettings:
    """The settings with what the headings state, and what the file turned out to be."""
    units = {"potential": "potential_unit", "resistivity": "resistivity_unit"}
    stated: dict[str, object] = {
        key: rows.units[role].key for role, key in units.items() if role in rows.units
    }
    length = next(rows.units[role] for role in ("x", "u") if role in rows.units)
    stated |= {"coordinate_unit": length.key, "layout": "list"}
    if rows.electrode:
        stated["electrode"] = rows.electrode
    return settings.model_copy(update=stated)


def _own_resistivity(rows: ReadingList) -> Vector | None:
    raw = rows.column("resistivity")
    if raw is None:
        return None
    unit = rows.units["resistivity"]
    return resistivities_ohm_m(raw, unit, lambda k: rows.where("resistivity", k))


def _own_temperature(rows: ReadingList) -> Vector | None:
    raw = rows.column("temperature")
    return None if raw is None else temperatures_c(raw, lambda k: rows.where("temperature", k))


def _second_file(
    path: Path, settings: SurveySettings, potentials: Grid | ReadingList, source: SourceFile
) -> tuple[Vector | None, set[str], SurveySettings, tuple[SourceFile, ...]]:
    """Resistivities of the file that the settings name, what it states, and the files read."""
    if settings.resistivity is None:
        return None, set(), settings, (source,)
    file = path.parent / settings.resistivity
    values, unit, stated, second = joined_resistivity(file, settings, potentials)
    used = settings.model_copy(update={"resistivity_unit": unit.key})
    return values, {"resistivity_unit"} if stated else set(), used, (source, second)


def _places(
    rows: ReadingList, settings: SurveySettings
) -> tuple[Points | None, Points, FittedPlane | None, tuple[str, ...]]:
    """Points in space, (u, v), the plane between them if one was fitted, and what to say of it."""
    p_W, uv_m = rows.coordinates("x", "y", "z"), rows.coordinates("u", "v")
    if uv_m is None and p_W is None:
        uv_m = rows.coordinates("x", "y")
    if uv_m is not None:
        return p_W, uv_m + settings.origin_m, None, ()
    assert p_W is not None  # a list has x and y, or u and v
    seen_from = None if settings.seen_from_m is None else np.array(settings.seen_from_m)
    fitted = fitted_plane(p_W, seen_from)
    if isinstance(fitted, str):
        hint = "state seen_from_m, or give columns u and v, the coordinates along the surface"
        raise InputError(Problem(fitted, Location(rows.cells.file), hint))
    plane, uv_m = fitted
    notes: tuple[str, ...] = ()
    if plane.max_m > TOLERANCE_M:
        notes += (
            f"The points lie up to {plane.max_m:.3f} m off the plane that fits them best "
            f"(RMS {plane.rms_m:.3f} m): distances along the surface are only nearly right.",
        )
    if settings.seen_from_m is None:
        side = "from above" if plane.R_WS[2, 2] > LEVEL else "from the origin of the coordinates"
        notes += (f"The surface is assumed to be seen {side}.",)
    return p_W, uv_m + settings.origin_m, plane, notes
