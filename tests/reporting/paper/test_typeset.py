"""A report on paper says what the report on the screen says, whatever anybody wrote into it."""

from __future__ import annotations

import io
import re
from html.parser import HTMLParser
from pathlib import Path

import pypdf
import pytest
from PIL import Image

from inspect_cli.errors import EnvironmentFault
from inspect_cli.reporting.content.blocks import (
    Block,
    Box,
    Boxes,
    Column,
    Cover,
    Document,
    Facts,
    Figures,
    Film,
    Folded,
    Heading,
    Notes,
    Paragraph,
    Picture,
    Section,
    Table,
)
from inspect_cli.reporting.figures.figure import Figure, Json, words
from inspect_cli.reporting.paper import typeset
from inspect_cli.reporting.paper.plots import draw
from inspect_cli.reporting.paper.typeset import HALF_PAGE_MM, pdf, typeset_files, write_pdf
from inspect_cli.reporting.screen.html import html
from inspect_cli.reporting.words.language import Language, language
from inspect_cli.reporting.words.printable import breakable, printable, shortened
from inspect_cli.reporting.words.text import (
    NOTHING,
    Badge,
    Chip,
    Lines,
    Link,
    Listed,
    Text,
    code,
    number,
    say,
    sentences,
    significant,
    strong,
    together,
)

ENGLISH = language("en")
GERMAN = Language("de", ",", {"{n} readings are valid.": "{n} Messwerte sind gültig."})
A4_PT = (595.276, 841.890)

FOREIGN = {
    "call": '#panic("x")',
    "markup": "*b* _e_ $x^2$ `c` = h / t: d",
    "quotes": '\\ \\" " ] } ) //',
    "import": '#import "@preview/a:1.0.0": *',
    "script": "<script>alert(1)</script>",
    "emoji": "😀 👍🏽",
    "turned": "\u202eevil\u202c \u2067x\u2069",
    "controls": "a\x00b\x1b[0m\x7f\x85",
    "surrogate": "\ud800x\udfff",
    "no characters": "\uffff\ufdd0",
    "lines": "two\nlines\r\n\tx",
    "right to left": "שלום עולם مرحبا",
    "far": "漢字かな \U0001f9ff \ue000",
    "json": '{"is": "text"}',
    "empty": "",
    "signs": "Ω − ≥ ² ⚠ ✓ θ Δ µ",
}


def picture() -> bytes:
    file = io.BytesIO()
    Image.new("RGB", (60, 40), (0, 114, 178)).save(file, "PNG")
    return file.getvalue()


def curve(name: str, label: str = "truth") -> Figure:
    trace = {"type": "scatter", "mode": "lines", "x": [0, 1, 2], "y": [0.0, 0.5, 2.0]}
    axis = {"title": {"text": f"{words(label)} (m)"}}
    traces = [{**trace, "name": words(label), "showlegend": True}]
    return Figure(name, f"Curve {name}.", f"A curve called {name}.", traces, {"yaxis": axis})


def every_block(foreign: Text = "wall") -> list[Block]:
    columns = [
        Column("Point"),
        Column("Potential", "mV CSE", numeric=True),
        Column("Class"),
        Column("Remark", prose=True),
    ]
    rows: list[list[Text]] = [
        ["P1", number(-1234.5, 1), Chip("passive", "passive"), foreign],
        ["P2", significant(0.25, 2), Chip(say("passed"), "pass"), code("tracking.rmse_mm")],
        ["P3", number(None, 1), Badge("aborted", "aborted"), Lines(("one", "two"))],
    ]
    return [
        Notes([foreign, "One reading is invalid."], "warnings"),
        Paragraph(sentences([say("{n} readings are valid.", n=number(35, 0)), foreign]), "finding"),
        Paragraph(together(strong("Rule."), " Active below ", number(-350, 0), " mV."), "rule"),
        Paragraph("Small words.", "note"),
        Boxes([Box("valid readings", number(35, 0)), Box("area", number(0.013, 3), "m²")]),
        Heading("How it was read"),
        Facts([("Half cell", "Cu/CuSO₄"), ("Wall", foreign)]),
        Notes([Listed(("one", "two", "three")), Link("Sortie 1", "sortie-1/report.html")]),
        Table("Readings in their order.", columns, rows),
        Table("Many columns.", [*columns, *columns], [[*row, *row] for row in rows], wide=True),
        Figures([curve("first")]),
        Figures([curve("second"), curve("third")], side_by_side=True),
        Picture(picture(), "A picture of the wall.", "A wall."),
        Film(b"film", "The approach.", "A film of the approach."),
        Folded("More", [Paragraph("hidden")]),
    ]


def document(foreign: Text = "wall", blocks: list[Block] | None = None) -> Document:
    cover = Cover("Inspection report", "Abutment north", "Face to the river.", [("Wall", foreign)])
    shown = Section("summary", "Summary", blocks or every_block(foreign))
    kept = Section("flight", "Diagrams", [Paragraph("on the screen")], on_paper=False)
    return Document("Abutment north – inspection report", cover, [shown, kept])


def text_of(data: bytes) -> str:
    """The text of all pages; marks without a shape, which typesetting leaves, are dropped."""
    pages = pypdf.PdfReader(io.BytesIO(data)).pages
    return re.sub("[\u200b\u2060]", "", "\n".join(page.extract_text() for page in pages))


class Shown(HTMLParser):
    """What a reader of the page sees, without what paper leaves out."""

    def __init__(self) -> None:
        super().__init__()
        self.hidden, self.parts = 0, [""]

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        left_out = tag == "section" and dict(attrs).get("id") == "flight"
        if tag in ("script", "style", "nav", "details", "title") or left_out or self.hidden:
            self.hidden += tag not in ("img", "br", "link", "meta")
        self.parts.append(" ")

    def handle_endtag(self, tag: str) -> None:
        self.hidden = max(0, self.hidden - 1)
        self.parts.append(" ")

    def handle_data(self, data: str) -> None:
        if not self.hidden:
            self.parts.append(data)


def test_paper_says_what_the_screen_says() -> None:
    page = Shown()
    page.feed(html(document(), ENGLISH))
    on_screen = "".join(page.parts).split()
    on_paper = text_of(pdf(document(), ENGLISH)).split()
    missing = [word for word in on_screen if word not in on_paper]
    assert missing == []
    assert "hidden" not in on_paper
    assert "Diagrams" not in on_paper
    # What paper adds: contents, numbers of pages, tables and figures, signs, the drawings' words.
    added = {word for word in on_paper if word not in on_screen}
    ours = "Contents Table Figure truth (m) This is a film: it in the HTML report."
    own = {*ours.split(), "–", "inspection", "report", "•", "⚠", "✓", "/", "."}
    assert {w for w in added - own if not re.fullmatch(r"[−\d./]+|\.+", w)} == set()


def test_the_order_of_the_words_is_the_documents() -> None:
    text = text_of(pdf(document(), ENGLISH))
    body = text[text.index("One reading is invalid") :]
    marks = (
        "35 readings",
        "Rule.",
        "valid readings",
        "How it was read",
        "Readings in",
        "Curve first.",
    )
    places = [body.index(mark) for mark in marks]
    assert places == sorted(places)


def test_pages_are_upright_a4_with_their_numbers() -> None:
    rows: list[list[Text]] = [[f"P{k}", number(k, 1)] for k in range(200)]
    table = Table("All points.", [Column("Point"), Column("Potential", "mV", numeric=True)], rows)
    reader = pypdf.PdfReader(io.BytesIO(pdf(document(blocks=[table]), ENGLISH)))
    n = len(reader.pages)
    assert n > 3
    for k, page in enumerate(reader.pages, 1):
        size = float(page.mediabox.width), float(page.mediabox.height)
        assert size == pytest.approx(A4_PT, abs=0.01)
        text = re.sub("[\u200b\u2060]", "", page.extract_text())
        assert re.search(rf"\b{k}\s*/\s*{n}\b", text)
        if k > 1:  # each page but the cover repeats the heads of the table and of the document
            assert "Potential" in text
            assert "Abutment north – inspection report" in text
            assert "Summary" in text
    every = text_of(pdf(document(blocks=[table]), ENGLISH))
    assert all(re.search(rf"\bP{k}\b", every) for k in range(200))


def test_a_table_with_too_many_columns_lies_on_its_side() -> None:
    columns = [Column(f"Quantity {k}", "kΩ·cm", numeric=True) for k in range(24)]
    wide = Table("Wide.", columns, [[number(-12345.6, 1)] * 24] * 3, wide=True)
    blocks = [wide, Paragraph("Upright."), Heading("Wider"), wide, wide, Paragraph("And again.")]
    reader = pypdf.PdfReader(io.BytesIO(pdf(document(blocks=blocks), ENGLISH)))
    flipped = [float(page.mediabox.width) > float(page.mediabox.height) for page in reader.pages]
    assert flipped == [False, True, False, True, False]
    # A heading lies on the page of the table that it opens.
    texts = [page.extract_text() for page in reader.pages]
    for k, words_there in ((1, "Summary"), (2, "Upright."), (3, "Wider"), (4, "And again.")):
        assert words_there in texts[k]


def test_german_numbers_and_words() -> None:
    text = text_of(pdf(document(), GERMAN))
    assert "−1\u202f234,5" in text
    assert "0,013" in text
    assert "35 Messwerte sind gültig." in text
    assert "Abbildung" in text
    assert "Tabelle" in text
    assert NOTHING in text


def test_the_same_document_gives_the_same_bytes() -> None:
    first, second = pdf(document(), ENGLISH), pdf(document(), ENGLISH)
    assert first == second
    reader = pypdf.PdfReader(io.BytesIO(first))
    assert reader.metadata is not None
    assert reader.metadata.title == "Abutment north – inspection report"
    assert reader.metadata.creation_date is None
    assert b"/CreationDate" not in first


def test_the_file_is_tagged_and_names_its_language() -> None:
    reader = pypdf.PdfReader(io.BytesIO(pdf(document(), GERMAN)))
    catalogue = reader.trailer["/Root"]
    assert catalogue["/Lang"] == "de"
    assert catalogue["/MarkInfo"]["/Marked"]
    found, open_nodes = set(), [catalogue["/StructTreeRoot"]]
    alternatives = set()
    while open_nodes:
        node = open_nodes.pop().get_object()
        if not isinstance(node, pypdf.generic.DictionaryObject):
            continue
        found.add(str(node.get("/S")))
        alternatives.add(str(node.get("/Alt")))
        kids = node.get("/K", [])
        kids = kids if isinstance(kids, list) else [kids]
        open_nodes += [kid for kid in kids if not isinstance(kid, int)]
    assert {"/H1", "/H2", "/Table", "/TH", "/TD", "/Figure", "/Caption"} <= found
    assert {"A curve called first.", "A wall."} <= alternatives


def test_a_document_keeps_the_rules_of_accessible_pdf() -> None:
    assert pdf(document(), ENGLISH, ["ua-1"])[:5] == b"%PDF-"


@pytest.mark.parametrize("foreign", FOREIGN.values(), ids=FOREIGN.keys())
def test_foreign_text_stays_text(foreign: str) -> None:
    cover = Cover(foreign, foreign, foreign, [(foreign, foreign)])
    blocks = [*every_block(foreign), Heading(foreign), Figures([curve("evil", foreign)])]
    evil = Document(foreign, cover, [Section(foreign, foreign, blocks)])
    text = text_of(pdf(evil, ENGLISH))
    if foreign.isascii():
        seen = [re.sub(r"\s|\ufffd", "", part) for part in (printable(foreign), text)]
        assert seen[0] in seen[1]
    assert "One reading is invalid." in text


def test_the_program_holds_no_word_of_the_document() -> None:
    files = typeset_files(document('#panic("x")'), ENGLISH)
    assert files[typeset.PROGRAM] == typeset_files(document(), GERMAN)[typeset.PROGRAM]
    assert b"panic" not in files[typeset.PROGRAM]


def test_ten_thousand_letters_without_a_blank() -> None:
    endless = "y" * 10_000
    reader = pypdf.PdfReader(io.BytesIO(pdf(document(endless), ENGLISH)))
    assert sum(page.extract_text().count("y") for page in reader.pages) > 60_000
    assert len(reader.pages) < 120


def test_what_is_printable() -> None:
    assert printable("a\n\t b\u00a0c\u202fd") == "a b\u00a0c\u202fd"
    assert printable("\x00\ud800\u202e\uffff\ufdd0") == 5 * "\ufffd"
    assert printable("שלום θ 😀") == "שלום θ 😀"
    assert breakable("short words stay") == "short words stay"
    assert breakable("a" * 40).replace("\u200b", "") == "a" * 40
    assert max(map(len, breakable("a" * 400).split("\u200b"))) <= 28
    assert "runs/\u200b" in breakable("runs/example-survey/2026-11-24/flight.mcap")
    assert (shortened("abcd", 4), shortened("abcde", 4)) == ("abcd", "abc…")


def test_a_map_is_to_scale_on_the_page() -> None:
    # Two equal letters, centred on ticks that are 0.6 m apart: 120 mm at 1 : 5.
    trace = {"type": "scatter", "mode": "lines", "x": [0.0, 0.7], "y": [0.0, 0.3]}
    layout = {
        "xaxis": {"tickvals": [0.1, 0.7], "ticktext": ["Q", "Q"]},
        "yaxis": {"scaleanchor": "x"},
    }
    plan = Figure("plan", "A plan.", "A plan.", [trace], layout)
    data = pdf(document(blocks=[Figures([plan])]), ENGLISH)
    places: list[float] = []

    def seen(text: str, cm: list[float], tm: list[float], font: object, size: float) -> None:
        if text.strip() == "Q":
            places.append(cm[4] + tm[4])

    pypdf.PdfReader(io.BytesIO(data)).pages[1].extract_text(visitor_text=seen)
    assert "Scale 1 : 5, printed at full size" in " ".join(text_of(data).split())
    assert len(places) == 2
    assert (places[1] - places[0]) * 25.4 / 72.0 == pytest.approx(120.0, abs=0.01)


def test_what_paper_cannot_show_is_said() -> None:
    scene = Figure("scene", "Path in space.", "A path.", [{"type": "scatter3d"}], {})
    film = Film(b"film", "The approach.", "A film.")
    text = " ".join(text_of(pdf(document(blocks=[Figures([scene]), film]), ENGLISH)).split())
    assert "This drawing has three dimensions: it is in the HTML report." in text
    assert "Path in space." in text
    assert "This is a film: it is in the HTML report." in text


def test_the_file_is_written_whole(tmp_path: Path) -> None:
    path = tmp_path / "new" / "report.pdf"
    write_pdf(document(), ENGLISH, path)
    assert path.read_bytes() == pdf(document(), ENGLISH)
    assert list(path.parent.iterdir()) == [path]


def test_a_tall_picture_fits_its_page() -> None:
    file = io.BytesIO()
    Image.new("RGB", (30, 300), (0, 114, 178)).save(file, "PNG")
    tall = Picture(file.getvalue(), "A tall picture.", "A column.")
    reader = pypdf.PdfReader(io.BytesIO(pdf(document(blocks=[tall]), ENGLISH)))
    assert len(reader.pages) == 2
    assert "A tall picture." in reader.pages[1].extract_text()


def test_a_failure_of_the_typesetter_is_told(tmp_path: Path) -> None:
    broken = document(blocks=[Picture(b"no picture", "caption", "description")])
    with pytest.raises(EnvironmentFault, match="cannot be typeset"):
        write_pdf(broken, ENGLISH, tmp_path / "report.pdf")
    assert not list(tmp_path.iterdir())


def test_a_verdict_has_one_sign() -> None:
    chips: list[Text] = [Chip(say("✓ pass"), "pass"), Chip(say("✗ fail"), "fail")]
    table = Table("", [Column("A"), Column("B")], [chips])
    text = text_of(pdf(document(blocks=[table]), ENGLISH))
    assert (text.count("✓"), text.count("✗")) == (1, 1)


def test_maps_beside_each_other_have_one_scale() -> None:
    """The second has a longer legend, so that alone it fits at a smaller scale than the first."""
    frame: Json = {
        "xaxis": {"range": [0.0, 0.9]},
        "yaxis": {"range": [0.0, 3.4], "scaleanchor": "x"},
        "showlegend": True,
    }
    names = ["a"], [f"{n} {12 * 'long '}" for n in range(9)]
    maps = [
        Figure(
            f"m{k}",
            "",
            "",
            [{"type": "scatter", "name": n, "x": [0, 1], "y": [0, 3]} for n in own],
            frame,
            400,
            slope=3.4 / 0.9,
        )
        for k, own in enumerate(names)
    ]
    alone = [draw(m, ENGLISH, HALF_PAGE_MM) for m in maps]
    assert len({plot.scale for plot in alone if plot}) == 2
    made = text_of(pdf(document(blocks=[Figures(tuple(maps), side_by_side=True)]), ENGLISH))
    scales = re.findall(r"Scale 1 : (\d+)", made)
    assert len(scales) == 2
    assert scales[0] == scales[1]
