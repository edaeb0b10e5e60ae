"""The files of a report: page, PDF, and readings for other programs.

A folder holds one report: a file of an earlier one that has no successor is removed.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, get_args

from inspect_cli.commands.runs import METRICS_NAME, READINGS_NAME
from inspect_cli.errors import InputError
from inspect_cli.exchange.readings import HandedReadings
from inspect_cli.files import write_whole
from inspect_cli.log.reader import RunLog
from inspect_cli.pictures.names import FILM_NAME, SCENE_NAME
from inspect_cli.reporting.content.blocks import REPORT_NAME, Document
from inspect_cli.reporting.screen.html import html
from inspect_cli.reporting.words.language import language as language_of
from inspect_cli.schema.explain import suggest
from inspect_cli.schema.result import Result
from inspect_cli.schema.survey import Georeference, LanguageCode
from inspect_cli.schema.vehicle import HalfCellModel

PDF_NAME = "report.pdf"
Export = Literal["geojson", "ifc"]
EXPORTS: dict[Export, str] = {"geojson": "readings.geojson", "ifc": "readings.ifc"}
"""The files by what they are for."""
REPORT_FILES = (METRICS_NAME, READINGS_NAME, REPORT_NAME, PDF_NAME, *EXPORTS.values())
"""What a report writes, or removes where an earlier one left it."""
PICTURES = (SCENE_NAME, FILM_NAME)
"""The same of a flight besides."""


@dataclass(frozen=True)
class Wanted:
    """What a report consists of besides its page, its metrics and its table."""

    language: LanguageCode = "en"
    pictures: bool = False
    pdf: bool = False
    exports: tuple[Export, ...] = ()


def exports_of(text: str | None) -> tuple[Export, ...]:
    """The exports that an option names, with commas between them; none without it.

    Raises:
        InputError: one is not known, or the option is there and names none.
    """
    if text is None:
        return ()
    found: list[Export] = []
    for name in (part.strip() for part in text.split(",") if part.strip()):
        known = next((export for export in get_args(Export) if export == name), None)
        if known is None:
            raise InputError(f"--export: there is no '{name}'", hint=suggest(name, list(EXPORTS)))
        found.append(known)
    if not found:
        raise InputError("--export names nothing", hint=f"choices: {', '.join(EXPORTS)}")
    return tuple(dict.fromkeys(found))


def require_room(folder: Path, files: Iterable[str] = REPORT_FILES) -> None:
    """Refuse, before anything is computed, a place that cannot take a report's files.

    Raises:
        InputError: a file stands where a folder has to be, or a folder where a file has to be.
    """
    there = next((path for path in (folder, *folder.parents) if path.exists()), folder)
    if there.exists() and not there.is_dir():
        what = f"{folder} cannot be a folder: {there} is a file"
        raise InputError(what, hint="choose another with --out")
    for path in (folder / name for name in files):
        if path.is_dir():
            what = f"{path} is a folder where the report writes a file"
            raise InputError(what, hint="move it away, or choose another folder with --out")


def report_folder(folder: Path) -> Path:
    """The folder of a report, made if it is not there.

    Raises:
        InputError: it cannot be.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        what = f"{folder} cannot be a folder: {error.strerror}"
        raise InputError(what, hint="choose another with --out") from error
    return folder


def deliver(folder: Path, document: Document, wanted: Wanted) -> Path:
    """Write the page, and the PDF where it is wanted, of one content; return the page's path."""
    language = language_of(wanted.language)
    page = folder / REPORT_NAME
    write_whole(page, html(document, language))
    if wanted.pdf:
        # matplotlib and typst are loaded for this alone.
        from inspect_cli.reporting.paper.typeset import write_pdf

        write_pdf(document, language, folder / PDF_NAME)
    else:
        (folder / PDF_NAME).unlink(missing_ok=True)
    return page


def require_exportable(points: int, wanted: Wanted) -> None:
    """Refuse, before anything is written, more points than a wanted export takes.

    Raises:
        InputError: there are too many.
        EnvironmentFault: what writes a model is not installed.
    """
    if "ifc" in wanted.exports:
        from inspect_cli.exchange.ifc import require_model

        require_model(points)


def export(
    folder: Path,
    readings: HandedReadings,
    wanted: Wanted,
    georeference: Georeference | None = None,
) -> None:
    """Write the readings for maps and models of buildings.

    Raises:
        EnvironmentFault: what writes a model is not installed.
    """
    for name, file in EXPORTS.items():
        if name not in wanted.exports:
            (folder / file).unlink(missing_ok=True)
    if "geojson" in wanted.exports:
        from inspect_cli.exchange.geojson import geojson

        write_whole(folder / EXPORTS["geojson"], geojson(readings, georeference))
    if "ifc" in wanted.exports:
        from inspect_cli.exchange.ifc import ifc

        write_whole(folder / EXPORTS["ifc"], ifc(readings, georeference))


def handed_readings(log: RunLog, result: Result) -> HandedReadings:
    """The readings of a flight, or of the sorties of a survey."""
    probe = log.platform().find(HalfCellModel)
    return HandedReadings(
        points=result.points,
        title=log.mission().title or result.mission,
        electrode=probe.electrode if probe else HalfCellModel.model_fields["electrode"].default,
    )
