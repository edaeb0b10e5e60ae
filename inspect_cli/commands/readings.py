"""``inspect report --readings``: a half-cell survey that people took, evaluated and reported."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from platform import python_version
from typing import Any

import numpy as np

from inspect_cli.assessment.assess import Assessed, assess
from inspect_cli.assessment.classes import (
    ASTM_CLASSES,
    VERDICTS,
    astm_codes,
    is_resistivity,
    millivolts,
    name_of,
    verdict_codes,
)
from inspect_cli.assessment.findings import disagreement
from inspect_cli.assessment.kriging import KrigedMap
from inspect_cli.assessment.mixture import resolution_of
from inspect_cli.assessment.readings import Readings
from inspect_cli.assessment.surface_findings import SurfaceFindings
from inspect_cli.assessment.temperatures import standardised
from inspect_cli.commands.delivery import (
    Export,
    Wanted,
    deliver,
    export,
    report_folder,
    require_exportable,
    require_room,
)
from inspect_cli.commands.runs import METRICS_NAME, READINGS_NAME, write_model
from inspect_cli.commands.surface_maps import with_map
from inspect_cli.errors import InputError
from inspect_cli.exchange.readings import HandedReadings
from inspect_cli.exchange.readings_csv import readings_csv
from inspect_cli.files import write_whole
from inspect_cli.reporting.half_cell.readings_document import readings_document
from inspect_cli.schema.assessment import Basis
from inspect_cli.schema.readings import ReadingsResult, SourceOfReadings
from inspect_cli.schema.result import PointResult
from inspect_cli.spatial.arrays import Vector
from inspect_cli.surveys.settings import read_settings
from inspect_cli.surveys.survey import Survey, read_survey

VERSIONED = ("inspect-cli", "numpy", "pykrige", "scipy", "shapely")


@dataclass(frozen=True)
class ReadingsOutcome:
    """A survey that was reported, and where its page is."""

    result: ReadingsResult
    page: Path


def report_readings(
    file: Path,
    options: Mapping[str, object] | None = None,
    *,
    out: Path | None = None,
    pdf: bool = False,
    exports: tuple[Export, ...] = (),
) -> ReadingsOutcome:
    """Evaluate the readings of a file; write its page, metrics and table.

    Args:
        file: a table of readings (``surveys.survey``).
        options: settings that come before those of the file's ``.survey.yaml``.
        out: folder for the report's files; by default ``reports/<name of the file>/``.
        pdf: write ``report.pdf``, too.
        exports: files for other programs.

    Raises:
        InputError: a cell, a setting or a file is refused; then nothing is written.
    """
    if file.is_dir():
        raise InputError(
            f"{file} is a folder", hint="name one file of readings: a report has one surface"
        )
    folder = out or Path("reports") / file.stem
    require_room(folder)
    settings = read_settings(file, options)
    wanted = Wanted(language=settings.language, pdf=pdf, exports=exports)
    survey = read_survey(file, settings)
    _refuse_idle(options or {}, survey)
    require_exportable(len(survey.labels), wanted)
    name = survey.settings.structure or file.stem
    readings, basis = standard_readings(survey)
    evaluated = with_map(assess(name, readings, basis=basis))
    points = points_of(name, survey, readings, evaluated.assessed)
    result = _result(file, survey, evaluated)
    report_folder(folder)
    write_model(folder / METRICS_NAME, result)
    write_whole(folder / READINGS_NAME, readings_csv(points))
    handed = HandedReadings(
        points=points,
        title=result.survey,
        structure=survey.settings.structure,
        date=survey.settings.date,
        electrode=survey.settings.electrode,
    )
    export(folder, handed, wanted, survey.settings.georeference)
    page = deliver(folder, readings_document(result, points, evaluated), wanted)
    return ReadingsOutcome(result, page)


def _refuse_idle(options: Mapping[str, object], survey: Survey) -> None:
    """Refuse what somebody asked for and this file has no use for: it is not the file they think.

    Settings that stand beside a file may be shared by several and are no such wish.
    """
    idle = {
        "resistivity_unit": (
            not np.isfinite(survey.resistivity_ohm_m).any(),
            "there are no resistivities",
            "name their file with --resistivity, or give a list a column of them",
        ),
        "spacing_m": (survey.grid is None, "a list has coordinates of its own", "leave it out"),
        "coordinate_unit": (
            survey.grid is not None,
            "a grid has no coordinates",
            "state the distance of its readings with --spacing-m",
        ),
    }
    for key, (is_idle, why, hint) in idle.items():
        if is_idle and options.get(key) is not None:
            raise InputError(f"--{key.replace('_', '-')} is given, but {why}", hint=hint)


def standard_readings(survey: Survey) -> tuple[Readings, Basis]:
    """The survey's readings against CSE at the standard's temperature, and how they became that."""
    temperature_c = survey.temperature_c
    if temperature_c is None:
        stated = survey.settings.temperature_c
        temperature_c = np.full(len(survey.labels), np.nan if stated is None else stated)
    electrode = survey.settings.electrode
    read_v = 1e-3 * survey.potential_mv
    potential_v, basis, by_temperature_v = standardised(read_v, electrode, temperature_c)
    readings = Readings(
        labels=np.array(survey.labels, dtype=np.str_),
        uv_m=survey.uv_m,
        potential_v=potential_v,
        resistivity_ohm_m=survey.resistivity_ohm_m,
        measurement_sd_v=np.hypot(_rounding_sd_v(survey.potential_mv), by_temperature_v),
    )
    return readings, basis


def _rounding_sd_v(potential_mv: Vector) -> Vector:
    """Standard uncertainty, V, of readings that were rounded to a step: step/√12 (GUM, F.2.2.1).

    How long and how hard a person pressed is not in the file.
    """
    valid = potential_mv[np.isfinite(potential_mv)]
    step_mv = resolution_of(valid) if len(valid) else 1.0
    return np.full(len(potential_mv), 1e-3 * step_mv / np.sqrt(12.0))


def points_of(
    name: str, survey: Survey, readings: Readings, assessed: Assessed
) -> tuple[PointResult, ...]:
    """A point for each reading of the file, in its order."""
    rho = readings.resistivity_ohm_m
    columns = zip(
        survey.labels,
        survey.valid.tolist(),
        survey.why,
        survey.points_W.tolist(),
        survey.uv_m.tolist(),
        _known(survey.potential_mv),
        _known(millivolts(readings.potential_v)),
        _known(1e3 * assessed.budget.alone_v[assessed.merged.member]),
        _known(np.where(is_resistivity(rho), rho, np.nan)),
        astm_codes(readings.potential_v).tolist(),
        verdict_codes(readings.potential_v, rho).tolist(),
        strict=True,
    )
    # Every value was checked when the file was read; a hundred thousand need no second look.
    unknown: dict[str, Any] = dict.fromkeys(PointResult.model_fields)
    unknown |= {"instrument": "", "values": {}, "units": {}}
    return tuple(
        PointResult.model_construct(
            **unknown
            | {
                "index": k,
                "label": label,
                "valid": valid,
                "reason": why,
                "p_W": tuple(p_W),
                "surface": name,
                "uv_m": tuple(uv_m),
                "read_mv": read_mv,
                "potential_mv": mv,
                "potential_sd_mv": sd_mv if valid else None,
                "resistivity_ohm_m": ohm_m,
                "contact_s": None,
                "astm_class": name_of(ASTM_CLASSES, astm),
                "corrosion": name_of(VERDICTS, verdict),
            }
        )
        for k, (label, valid, why, p_W, uv_m, read_mv, mv, sd_mv, ohm_m, astm, verdict) in (
            enumerate(columns)
        )
    )


def _known(values: Vector) -> list[float | None]:
    return [None if math.isnan(value) else value for value in values.tolist()]


def _result(file: Path, survey: Survey, evaluated: SurfaceFindings) -> ReadingsResult:
    found = evaluated.map
    return ReadingsResult(
        survey=survey.settings.title or file.name,
        files=tuple(SourceOfReadings(name=f.name, sha256=f.sha256) for f in survey.files),
        settings=survey.settings,
        assumed=survey.assumed,
        warnings=(*survey.warnings, *disagreement(evaluated.assessed.summary.repeatability)),
        assessment=(evaluated.assessed.summary,),
        map=(found.how if isinstance(found, KrigedMap) else found.why,),
        versions={name: version(name) for name in VERSIONED} | {"python": python_version()},
    )
