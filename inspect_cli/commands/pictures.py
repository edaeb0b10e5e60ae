"""The pictures of ``inspect report``: taken, and written beside the page."""

from __future__ import annotations

from pathlib import Path

from inspect_cli.files import write_whole
from inspect_cli.log.reader import RunLog
from inspect_cli.pictures.names import FILM_NAME, SCENE_NAME
from inspect_cli.pictures.render import Pictures, render_pictures
from inspect_cli.pictures.script import LegendEntry
from inspect_cli.reporting.figures.palette import ASTM_STYLES, INVALID_STYLE, READ_STYLE
from inspect_cli.reporting.words.language import language as language_of
from inspect_cli.scene.marks import INVALID, UNCLASSED
from inspect_cli.schema.result import Result
from inspect_cli.schema.survey import LanguageCode


def pictured(
    log: RunLog,
    result: Result,
    folder: Path,
    language: LanguageCode,
    *,
    wanted: bool,
    flight: str = "",
) -> Pictures | None:
    """Take the pictures of a flight and write ``scene.png`` and ``film.mp4`` into ``folder``.

    None where none are ``wanted``. A file of an earlier report that has no successor is removed:
    a folder shows one flight. ``flight`` says which of several it is.

    Raises:
        LogError: the log lacks the attachments that the pictures stand on.
        EnvironmentFault: a file cannot be written.
    """
    taken = Pictures()
    if wanted:
        taken = render_pictures(log, result, mark_styles(language), flight)
    for name, content in ((SCENE_NAME, taken.scene_png), (FILM_NAME, taken.film_mp4)):
        if content is None:
            (folder / name).unlink(missing_ok=True)
        else:
            write_whole(folder / name, content)
    return taken if wanted else None


def mark_styles(language: LanguageCode) -> dict[str, LegendEntry]:
    """How readings are marked in pictures, by their class, in the words of a language."""
    words = language_of(language)
    return {
        name: LegendEntry(words.plain(style.label), style.colour, style.symbol)
        for name, style in {**ASTM_STYLES, UNCLASSED: READ_STYLE, INVALID: INVALID_STYLE}.items()
    }
