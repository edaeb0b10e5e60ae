"""The report of half-cell readings that people took: the same findings, and where they are from."""

from __future__ import annotations

from collections.abc import Sequence

from inspect_cli.assessment.surface_findings import SurfaceFindings
from inspect_cli.reporting.content.blocks import (
    Block,
    Boxes,
    Column,
    Cover,
    Document,
    Facts,
    Heading,
    Notes,
    Paragraph,
    Section,
    Table,
)
from inspect_cli.reporting.content.opening import SIGNED, finding
from inspect_cli.reporting.content.read_points import ReadPoint
from inspect_cli.reporting.half_cell.evaluation import evaluation_blocks
from inspect_cli.reporting.half_cell.findings_text import few_readings, reading_caveats
from inspect_cli.reporting.half_cell.readings_text import findings, reading_boxes
from inspect_cli.reporting.words.recorded import recorded
from inspect_cli.reporting.words.text import Text, code, number, say, together
from inspect_cli.schema.readings import ReadingsResult
from inspect_cli.schema.result import PointResult
from inspect_cli.schema.survey import SurveySettings

ASSUMED: dict[str, Text] = {
    "potential_unit": say("the potentials are in millivolts"),
    "electrode": say("they were read against copper/copper sulphate (CSE)"),
    "spacing_m": say("the grid's spacing is 4 inches (0.1016 m)"),
    "orientation": say("the surface lies level: u along x and v along y"),
    "resistivity_unit": say("the resistivities are in kΩ·cm"),
    "coordinate_unit": say("the coordinates are in metres"),
    "seen_from_m": say("the surface was read from the side of the coordinates' origin"),
}
"""The assumption for each setting that nobody stated."""
SPACING_ASSUMED = say(
    "Nobody stated the spacing of the grid: areas and gradients rest on an assumed 0.1016 m."
)


def readings_document(
    result: ReadingsResult, points: Sequence[PointResult], evaluated: SurfaceFindings
) -> Document:
    """What the report of a file of readings says, in no language yet."""
    shown = [ReadPoint(point, None) for point in points]
    sections = [
        Section("summary", say("Summary"), _summary(result, shown, evaluated)),
        Section("survey", say("Corrosion survey"), evaluation_blocks([evaluated], shown, None)),
        Section("method", say("Method"), _method(result)),
        Section("provenance", say("Provenance"), _provenance(result)),
    ]
    title = result.survey
    return Document(say("{title} – inspection report", title=title), _cover(result), sections)


def _summary(
    result: ReadingsResult, points: Sequence[ReadPoint], evaluated: SurfaceFindings
) -> list[Block]:
    read = evaluated.assessed.summary.valid
    caveats = [*reading_caveats([evaluated], probed=False), *few_readings(read)]
    return [
        Notes(_warnings(result), "warnings"),
        *finding(findings(points, [evaluated])),
        Boxes(reading_boxes(points)),
        Heading(say("What this report does not say")),
        Notes(caveats, "caveats"),
    ]


def _warnings(result: ReadingsResult) -> list[Text]:
    """Warnings that stand before all numbers."""
    assumed = [SPACING_ASSUMED] if "spacing_m" in result.assumed else []
    return [*assumed, *(recorded(warning) for warning in result.warnings)]


def _cover(result: ReadingsResult) -> Cover:
    settings = result.settings
    read = sum(surface.readings for surface in result.assessment)
    facts: list[tuple[Text, Text]] = [
        *((name, value) for name, value in _people(settings) if value is not None),
        (say("Readings"), number(read, 0)),
        (say("Reference electrode"), settings.electrode),
        (say("Files"), ", ".join(file.name for file in result.files)),
    ]
    return Cover(say("Inspection report · half-cell potential"), result.survey, "", facts, SIGNED)


def _people(settings: SurveySettings) -> list[tuple[Text, str | None]]:
    return [
        (say("Structure"), settings.structure),
        (say("Client"), settings.client),
        (say("Inspector"), settings.inspector),
        (say("Date of the readings"), settings.date),
    ]


def _method(result: ReadingsResult) -> list[Block]:
    settings = result.settings
    temperature: Text = say("not stated")
    if settings.temperature_c is not None:
        temperature = together(number(settings.temperature_c, 1), " °C")
    facts: list[tuple[Text, Text]] = [
        (say("Method"), say("half-cell potential (ASTM C876), read by hand")),
        (say("Read against"), settings.electrode),
        (say("Temperature of concrete and electrode"), temperature),
        (say("Unit of the potentials in the file"), settings.potential_unit),
        *_sign(settings),
        *_spacing(settings),
    ]
    blocks: list[Block] = [Facts(facts)]
    if result.assumed:
        statements = [ASSUMED.get(name, code(name)) for name in result.assumed]
        blocks.append(Paragraph(say("Nobody stated, and this report assumes:"), "note"))
        blocks.append(Notes(statements))
    return blocks


def _sign(settings: SurveySettings) -> list[tuple[Text, Text]]:
    if settings.sign == "as_read":
        return []
    return [(say("Sign"), say("turned round: the device shows negative potentials as positive"))]


def _spacing(settings: SurveySettings) -> list[tuple[Text, Text]]:
    if settings.layout == "list":
        return []
    between_columns, between_rows = (number(spacing, 3) for spacing in settings.spacing_m)
    spacing = say("{u} m between columns, {v} m between rows", u=between_columns, v=between_rows)
    return [(say("Spacing of a grid"), spacing)]


def _provenance(result: ReadingsResult) -> list[Block]:
    rows: list[list[Text]] = [[file.name, code(file.sha256)] for file in result.files]
    columns = [Column(say("File")), Column("SHA-256", prose=True)]
    versions = [[name, version] for name, version in sorted(result.versions.items())]
    return [
        Table(say("Files that the readings were taken from."), columns, rows),
        Table(
            say("Versions of what computed the report."),
            [Column(say("Software")), Column(say("Version"))],
            versions,
        ),
    ]
