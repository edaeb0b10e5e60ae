"""A report as pages of paper: one PDF that needs nothing else.

``paper.typ`` holds all of the typesetter's code; the document reaches it as JSON, which it reads
as data. So no title, label or reason can become code, whatever stands in it. Fonts are those that
the typesetter and matplotlib bring along, never the system's: the same document and language give
the same bytes everywhere.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Iterator, Sequence
from importlib import resources
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import matplotlib
import typst

from inspect_cli.errors import EnvironmentFault
from inspect_cli.files import write_whole
from inspect_cli.reporting.content.blocks import (
    Block,
    Boxes,
    Document,
    Facts,
    Figures,
    Film,
    Folded,
    Heading,
    Notes,
    Paragraph,
    Picture,
    Table,
)
from inspect_cli.reporting.figures import palette
from inspect_cli.reporting.figures.figure import Figure, Json
from inspect_cli.reporting.paper.plot_scale import has_equal_scales
from inspect_cli.reporting.paper.plots import draw
from inspect_cli.reporting.paper.runs import runs
from inspect_cli.reporting.paper.tables import paper_table, turned
from inspect_cli.reporting.words.language import Language
from inspect_cli.reporting.words.printable import printable, shortened
from inspect_cli.reporting.words.text import Text, say

PROGRAM = "paper.typ"
PAGE_MM = 170.0
"""Between the margins of an upright page."""
HALF_PAGE_MM = 82.0
TALL = 1.3
"""Height over width of a map from which two stand side by side."""
PICTURE_MM = 120.0
"""Largest height of a picture, mm."""
RUNNING_TITLE = 90
RUNNING_HEADING = 45
"""Characters of the title and of the section at the head of a page."""
FONTS = ("Libertinus Serif", "DejaVu Sans", "Last Resort High-Efficiency")
"""The second has Arabic, Hebrew and signs; the last a frame for any character that none has."""
MONO_FONTS = ("DejaVu Sans Mono", "DejaVu Sans", "Last Resort High-Efficiency")
SCREEN_ONLY = say("This drawing has three dimensions: it is in the HTML report.")
FILM_ONLY = say("This is a film: it is in the HTML report.")


def write_pdf(document: Document, language: Language, path: Path) -> None:
    """Write the report to ``path``, whole or not at all.

    Raises:
        EnvironmentFault: it cannot be typeset, or the file not be written.
    """
    write_whole(path, pdf(document, language))


def pdf(document: Document, language: Language, standards: Sequence[str] = ()) -> bytes:
    """The report as a PDF: A4, tagged for screen readers, without a date of its own.

    ``standards`` are those that the typesetter shall hold it to, such as "ua-1".

    Raises:
        EnvironmentFault: the typesetter fails.
        ValueError: a figure holds something that no drawing on paper is known for.
    """
    files = typeset_files(document, language)
    return _compiled(files, "pdf", pdf_standards=list(standards))[0]


def pages_png(document: Document, language: Language, ppi: float = 110.0) -> list[bytes]:
    """The pages as PNG images."""
    return _compiled(typeset_files(document, language), "png", ppi=ppi)


def typeset_files(document: Document, language: Language) -> dict[str, bytes]:
    """What the typesetter is given: its program, the content as JSON, and the drawings."""
    paper = _Paper(language)
    content = paper.content(document)
    program = resources.files(__package__).joinpath(PROGRAM).read_bytes()
    text = json.dumps(content, ensure_ascii=False, allow_nan=False)
    return {PROGRAM: program, "content.json": text.encode(), **paper.files}


def fonts() -> typst.Fonts:
    """The fonts that the typesetter and matplotlib bring along."""
    folder = Path(matplotlib.get_data_path()) / "fonts" / "ttf"
    return typst.Fonts(include_system_fonts=False, font_paths=[folder])


def _compiled(files: dict[str, bytes], form: Any, **options: Any) -> list[bytes]:
    """The pages in one file or in one for each; the typesetter reads from a folder of its own."""
    try:
        with TemporaryDirectory(prefix="inspect-") as folder:
            for name, data in files.items():
                (Path(folder) / name).write_bytes(data)
            compiler = typst.Compiler(
                Path(folder) / PROGRAM, folder, font_paths=fonts(), ignore_system_fonts=True
            )
            made = compiler.compile(format=form, timestamp=0, **options)
    except (RuntimeError, OSError, ValueError) as error:
        raise EnvironmentFault(
            f"the report cannot be typeset: {error}",
            hint="the HTML report beside it is whole; report this with the message above",
        ) from error
    return [bytes(part) for part in made] if isinstance(made, list) else [bytes(made or b"")]


class _Paper:
    """Turns a document into the typesetter's data, and keeps the drawings on the way."""

    def __init__(self, language: Language) -> None:
        self.language = language
        self.files: dict[str, bytes] = {}

    def content(self, document: Document) -> Json:
        """The whole document."""
        cover, title = document.cover, self._plain(document.title)
        return {
            "lang": self.language.code,
            "title": title,
            "running": shortened(title, RUNNING_TITLE),
            "contents": self._plain(say("Contents")),
            "fonts": list(FONTS),
            "mono": list(MONO_FONTS),
            "colours": {
                "ink": palette.INK,
                "muted": palette.MUTED,
                "rule": palette.RULE,
                "accent": palette.BLUE,
            },
            "marks": {
                name: {"shape": style.symbol, "colour": style.colour}
                for styles in (palette.CORROSION_STYLES, palette.ASTM_STYLES)
                for name, style in styles.items()
            },
            "cover": {
                "kicker": self._runs(cover.kicker),
                "title": self._runs(cover.title),
                "description": self._runs(cover.description),
                "facts": [[self._runs(a), self._runs(b)] for a, b in cover.facts],
                "signed": [self._runs(line) for line in cover.signed],
            },
            "sections": [
                {
                    "heading": self._runs(section.heading),
                    "running": shortened(self._plain(section.heading), RUNNING_HEADING),
                    "blocks": turned([p for block in section.blocks for p in self._block(block)]),
                }
                for section in document.sections
                if section.on_paper
            ],
        }

    def _runs(self, text: Text) -> list[Json]:
        return runs(text, self.language)

    def _plain(self, text: Text) -> str:
        return printable(self.language.plain(text))

    def _block(self, block: Block) -> Iterator[Json]:
        """The block's data; nothing for what paper leaves out."""
        match block:
            case Heading():
                yield {"is": "heading", "text": self._runs(block.text)}
            case Paragraph():
                yield {"is": "paragraph", "role": block.role, "text": self._runs(block.text)}
            case Facts() if block.pairs:
                pairs = [[self._runs(a), self._runs(b)] for a, b in block.pairs]
                yield {"is": "facts", "pairs": pairs}
            case Notes() if block.items:
                items = [self._runs(item) for item in block.items]
                yield {"is": "notes", "role": block.role, "items": items}
            case Boxes() if block.boxes:
                yield {"is": "boxes", "boxes": [self._box(box) for box in block.boxes]}
            case Table():
                yield paper_table(block, self.language)
            case Figures():
                yield from self._figures(block)
            case Picture():
                yield {"is": "figures", "columns": 1, "figures": [self._picture(block)]}
            case Film():
                yield {"is": "figures", "columns": 1, "figures": [self._film(block)]}
            case Facts() | Notes() | Boxes() | Folded():
                return

    def _box(self, box: Any) -> Json:
        return {key: self._runs(getattr(box, key)) for key in ("name", "value", "unit")}

    def _figures(self, block: Figures) -> Iterator[Json]:
        """Drawings in one column or in two; a map to scale has the whole width for itself."""
        paired = [f for f in block.figures if block.side_by_side and not _needs_width(f)]
        pairs = [paired[k : k + 2] for k in range(0, len(paired), 2)]
        for figure in block.figures:
            if figure not in paired:
                yield {"is": "figures", "columns": 1, "figures": [self._figure(figure, PAGE_MM)]}
        for pair in pairs:
            width = HALF_PAGE_MM if len(pair) == 2 else PAGE_MM
            drawn = [self._figure(figure, width, self._common(pair, width)) for figure in pair]
            yield {"is": "figures", "columns": len(pair), "figures": drawn}

    def _common(self, pair: Sequence[Figure], width_mm: float) -> float:
        """The scale, 1 to this, at which all maps beside each other fit."""
        plots = [draw(f, self.language, width_mm) for f in pair if has_equal_scales(f.layout)]
        return max((p.scale.denominator for p in plots if p and p.scale), default=1.0)

    def _figure(self, figure: Figure, width_mm: float, least_denominator: float = 1.0) -> Json:
        plot = draw(figure, self.language, width_mm, least_denominator=least_denominator)
        data = self._drawing(figure.caption, figure.description)
        if plot is None:
            return {**data, "note": self._runs(SCREEN_ONLY)}
        return {**data, "file": self._kept(plot.svg, "svg"), "width": plot.width_mm}

    def _picture(self, picture: Picture) -> Json:
        data = self._drawing(picture.caption, picture.description)
        width, height = struct.unpack(">II", picture.png[16:24].ljust(8, b"\1"))
        fitted = min(PAGE_MM, PICTURE_MM * width / max(height, 1))
        return {**data, "file": self._kept(picture.png, "png"), "width": fitted}

    def _film(self, film: Film) -> Json:
        data = self._drawing(film.caption, film.description)
        return {**data, "note": self._runs(FILM_ONLY)}

    def _drawing(self, caption: Text, description: Text) -> Json:
        words = self._plain(description)
        return {"file": None, "caption": self._runs(caption), "description": words}

    def _kept(self, data: bytes, ending: str) -> str:
        name = f"drawing-{len(self.files) + 1}.{ending}"
        self.files[name] = data
        return name


def _needs_width(figure: Figure) -> bool:
    """Whether half a page is too narrow: maps that are not tall, and panels over time."""
    tall = figure.slope is not None and figure.slope > TALL
    return (has_equal_scales(figure.layout) and not tall) or "yaxis2" in figure.layout
