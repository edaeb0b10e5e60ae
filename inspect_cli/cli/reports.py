"""The command that reports flights, and readings that people took."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import typer

from inspect_cli.cli.program import Json, ReportOut, named_path, print_json, stdout_kept_clean
from inspect_cli.errors import EXIT_CHECK_FAILED, EXIT_GOOD, InputError

READINGS = "Readings without a flight"


def report(
    runs: Annotated[
        list[Path] | None, typer.Argument(metavar="[RUN|LOG...]", help="Run folders or logs.")
    ] = None,
    out: ReportOut = None,
    language: Annotated[
        Literal["en", "de"] | None, typer.Option(help="Of page and PDF; English by default.")
    ] = None,
    pdf: Annotated[bool, typer.Option("--pdf", help="Write report.pdf, too.")] = False,
    export: Annotated[
        str | None, typer.Option(metavar="KIND,…", help="Readings as geojson, ifc.")
    ] = None,
    no_pictures: Annotated[
        bool, typer.Option("--no-pictures", help="Render no scene and no film.")
    ] = False,
    readings: Annotated[
        list[Path] | None,
        typer.Option(
            metavar="FILE",
            parser=named_path,
            help="CSV or Excel: a grid, or a list with x, y[, z].",
            rich_help_panel=READINGS,
        ),
    ] = None,
    resistivity: Annotated[
        list[Path] | None,
        typer.Option(
            metavar="FILE",
            parser=named_path,
            help="Resistivities at the same points.",
            rich_help_panel=READINGS,
        ),
    ] = None,
    unit: Annotated[
        str | None,
        typer.Option(metavar="mV|V", help="Of the potentials.", rich_help_panel=READINGS),
    ] = None,
    electrode: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="Read against: CSE, SCE, …", rich_help_panel=READINGS),
    ] = None,
    temperature_c: Annotated[
        float | None, typer.Option(metavar="T", help="Of the concrete.", rich_help_panel=READINGS)
    ] = None,
    spacing_m: Annotated[
        str | None,
        typer.Option(
            metavar="D|DUxDV",
            help="Of a grid: between columns, between rows.",
            rich_help_panel=READINGS,
        ),
    ] = None,
    resistivity_unit: Annotated[
        str | None,
        typer.Option(
            metavar="kohm_cm|ohm_m|ohm_cm", help="Of the resistivities.", rich_help_panel=READINGS
        ),
    ] = None,
    coordinate_unit: Annotated[
        str | None,
        typer.Option(metavar="m|mm|…", help="Of a list's x, y, z.", rich_help_panel=READINGS),
    ] = None,
    layout: Annotated[
        str | None,
        typer.Option(
            metavar="grid|list", help="Where the file does not tell.", rich_help_panel=READINGS
        ),
    ] = None,
    sign: Annotated[
        str | None,
        typer.Option(
            metavar="as_read|inverted",
            help="inverted: the device shows −350 mV as 350.",
            rich_help_panel=READINGS,
        ),
    ] = None,
    orientation: Annotated[
        str | None,
        typer.Option(
            metavar="level|upright",
            help="How a surface without z lies in space.",
            rich_help_panel=READINGS,
        ),
    ] = None,
    sheet: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="Of a workbook.", rich_help_panel=READINGS),
    ] = None,
    title: Annotated[
        str | None, typer.Option(help="Of the survey.", rich_help_panel=READINGS)
    ] = None,
    as_json: Json = False,
) -> int:
    """Report flights, or readings that people took: an HTML page, metrics and tables."""
    options: dict[str, object] = {
        "potential_unit": unit,
        "electrode": electrode,
        "temperature_c": temperature_c,
        "spacing_m": None if spacing_m is None else _spacing(spacing_m),
        "resistivity": _only("--resistivity", resistivity),
        "resistivity_unit": resistivity_unit,
        "coordinate_unit": coordinate_unit,
        "layout": layout,
        "sign": sign,
        "orientation": orientation,
        "sheet": sheet,
        "title": title,
        "language": language,
    }
    survey = _only("--readings", readings)
    if survey is None:
        _refuse_options_of_readings(options)
        return _report_flights(runs or [], out, language or "en", pdf, export, no_pictures, as_json)
    if runs:
        raise InputError("--readings reports a file, and flights are reported without it")
    return _report_readings(survey, options, out, pdf, export, as_json)


def _only(option: str, files: list[Path] | None) -> Path | None:
    """The one file that an option names; of several, the command line keeps none silently."""
    if not files:
        return None
    if len(files) > 1:
        hint = "give each file a report of its own: one file, one surface, one report"
        raise InputError(f"{option} is given {len(files)} times", hint=hint)
    return files[0]


def _report_flights(
    runs: list[Path],
    out: Path | None,
    language: Literal["en", "de"],
    pdf: bool,
    export: str | None,
    no_pictures: bool,
    as_json: bool,
) -> int:
    from inspect_cli import terminal
    from inspect_cli.commands.delivery import Wanted, exports_of
    from inspect_cli.commands.report import report as command

    if not runs:
        hint = "name a run folder or a log, or give a file of readings with --readings"
        raise InputError("there is nothing to report", hint=hint)
    wanted = Wanted(language, not no_pictures, pdf, exports_of(export))
    with stdout_kept_clean():
        outcomes = command(runs, out, wanted)
    if as_json:
        reports = [
            {"page": str(o.page), "result": o.result.model_dump(mode="json", by_alias=True)}
            for o in outcomes
        ]
        print_json({"reports": reports})
    else:
        for outcome in outcomes:
            note = outcome.pictures.note if outcome.pictures else ""
            terminal.print_report(outcome.result, outcome.page, note)
    return EXIT_GOOD if all(o.result.passed for o in outcomes) else EXIT_CHECK_FAILED


def _report_readings(
    readings: Path,
    options: dict[str, object],
    out: Path | None,
    pdf: bool,
    export: str | None,
    as_json: bool,
) -> int:
    from inspect_cli import terminal
    from inspect_cli.commands.delivery import exports_of
    from inspect_cli.commands.readings import report_readings as command

    with stdout_kept_clean():
        outcome = command(readings, options, out=out, pdf=pdf, exports=exports_of(export))
    if as_json:
        result = outcome.result.model_dump(mode="json", by_alias=True)
        print_json({"page": str(outcome.page), "result": result})
    else:
        terminal.print_readings(outcome.result, outcome.page)
    return EXIT_GOOD


def _spacing(text: str) -> float | tuple[float, ...]:
    try:
        numbers = tuple(float(part) for part in text.split("x"))
    except ValueError as error:
        hint = "write --spacing-m 0.5, or --spacing-m 0.5x0.25, with decimal points"
        raise InputError(f"--spacing-m: '{text}' is no spacing", hint=hint) from error
    return numbers[0] if len(numbers) == 1 else numbers


def _refuse_options_of_readings(options: dict[str, object]) -> None:
    given = [key for key, value in options.items() if value is not None and key != "language"]
    if given:
        name = {"potential_unit": "unit"}.get(given[0], given[0]).replace("_", "-")
        raise InputError(f"--{name} goes with --readings", hint="name the file with --readings")
