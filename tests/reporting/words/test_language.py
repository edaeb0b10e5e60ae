"""Languages: complete catalogues, nothing left in English, numbers with the language's signs."""

from __future__ import annotations

import re
from collections.abc import Callable
from io import BytesIO
from pathlib import Path

import pytest
from babel.messages.pofile import read_po
from example_documents import ACCEPTANCE, FLIGHTS, flown, studied, study_result, surveyed
from example_flights import Flight, spoil
from report_pages import Page, Reported
from said_texts import names, reasons, said
from visible_words import Pseudo, foreign, left_over, shown, visible

from inspect_cli import cli
from inspect_cli.commands.delivery import Wanted, deliver
from inspect_cli.commands.study import STUDIES
from inspect_cli.commands.surface_maps import with_maps
from inspect_cli.metrics.evaluate import evaluate_with_arrays
from inspect_cli.metrics.flight import FlightData as Logged
from inspect_cli.metrics.readings import point_results
from inspect_cli.metrics.truth_scoring import NO_TRUTH
from inspect_cli.records import InvalidReason
from inspect_cli.reporting.content.read_points import ReadPoint
from inspect_cli.reporting.documents.flight import report_document
from inspect_cli.reporting.screen.html import html
from inspect_cli.reporting.studies.pitch_figures import (
    ACTIVE,
    DETECTED,
    MISSED,
    SITES,
    TOO_RESISTIVE,
)
from inspect_cli.reporting.words.language import LANGUAGES, language
from inspect_cli.reporting.words.recorded import RECORDED, recorded
from inspect_cli.reporting.words.text import Said, count, number, say, significant
from inspect_cli.schema.result import Metric
from inspect_cli.schema.study import Quantity, StudyResult, StudyVariant

Fly = Callable[..., Flight]
Report = Callable[[Flight], Reported]


@pytest.mark.parametrize("code", [code for code in LANGUAGES if code != "en"])
def test_every_sentence_of_the_source_is_translated(root: Path, code: str) -> None:
    package = root / "inspect_cli"
    file = package / "reporting" / "words" / "languages" / f"{code}.po"
    catalogue = read_po(BytesIO(file.read_bytes()), locale=code)
    wanted, there = said(package), set()
    for message in catalogue:
        if not message.id:
            continue
        one, many = (message.id, "") if isinstance(message.id, str) else message.id
        there.add((one, many))
        translated = [message.string] if isinstance(message.string, str) else message.string
        assert all(translated), one
        assert len(translated) == (2 if many else 1), one
        assert not message.fuzzy, one
        for text in translated:
            assert names(text) <= names(one) | names(many), one
        assert names(translated[-1]) == names(many or one), one
    assert not catalogue.obsolete
    assert wanted - there == set(), "without a translation"
    assert there - wanted == set(), "nothing says this any more"


def test_what_results_say_is_known_again(root: Path, fly: Fly) -> None:
    found = reasons(root / "inspect_cli" / "metrics")
    assert len(found) > 30
    found.remove("there is no metric '1'1")  # the last value is a clause or nothing
    found.remove("1 where points were planned")  # the first is NO_TRUTH
    found |= {NO_TRUTH, f"{NO_TRUTH} where points were planned"}
    found |= {"there is no metric 'a.b'", "there is no metric 'a.b'; did you mean 'a.c'?"}
    assert [text for text in sorted(found) if not isinstance(recorded(text), Said)] == []
    flight = fly(1, len(InvalidReason))
    for k, reason in enumerate(InvalidReason):
        spoil(flight, k, reason)
    points = point_results(Logged(flight.log()))
    told = [ReadPoint(point, None).reason for point in points]
    assert all(isinstance(text, Said) for text in told)
    assert "Kraft: sie blieb nicht 2 s lang bei 1 N" in map(language("de").plain, told)
    # In English every one of them reads as it was written.
    assert list(map(language("en").plain, told)) == [point.reason for point in points]


def test_what_somebody_else_wrote_stays_as_it_is() -> None:
    for text in ("", "no surface within reach of target 1", "sortie x: y", "plane {0}"):
        assert recorded(text) == text
    nested = recorded("sortie 2: target 1.5 was never touched")
    assert language("de").plain(nested) == "Teilflug 2: Ziel 1.5 wurde nie berührt"
    assert len({said.template for said in RECORDED}) == len(RECORDED)


@pytest.mark.parametrize("name", FLIGHTS)
def test_no_word_of_a_flights_report_is_left_in_english(
    fly: Fly, platform_file: Path, name: str
) -> None:
    flight = FLIGHTS[name](fly, platform_file)
    page = Page(html(flown(flight), Pseudo.made()))
    assert left_over(page, foreign(flight)) == []


def test_no_word_of_a_surveys_report_is_left_in_english(fly: Fly) -> None:
    flight = fly(1, 3)
    page = Page(html(surveyed(flight), Pseudo.made()))
    others = {"z-9", "zu weit", "das Seil riss"}
    assert left_over(page, foreign(flight) | others) == []


@pytest.mark.parametrize("name", STUDIES)
def test_no_word_of_a_study_is_left_in_english(fly: Fly, name: str) -> None:
    page = Page(html(studied(study_result(name)), Pseudo.made()))
    assert left_over(page, foreign(fly(1, 1)) | {"variant-0", "variant-1"}) == []


@pytest.mark.parametrize(
    ("shares", "english", "german"),
    [
        ((0.99, 0.97), "stays at 95 % or above up to the widest", "Bis zum größten Rasterabstand"),
        ((0.99, 0.5), "first drops below 95 % at a pitch of 0.25 m", "Erst ab einem Rasterabstand"),
        ((0.9, 0.5), "is below 95 % at the finest pitch already", "Schon beim kleinsten"),
    ],
)
def test_the_findings_of_the_pitch_study_are_known_again(
    shares: tuple[float, float], english: str, german: str
) -> None:
    study = STUDIES["pitch"]
    assert study.concluded
    variants = [
        StudyVariant(
            name=f"pitch-{pitch}",
            folder=None,
            values={"pitch": pitch},
            status="sampled",
            metrics={
                DETECTED: Metric(value=share, unit="1"),
                SITES: Metric(value=share, unit="1"),
                MISSED: Metric(value=missed, unit="m²"),
            },
            standard_errors={DETECTED: 0.0125, SITES: 0.0125, MISSED: 0.001},
        )
        for pitch, share, missed in zip((0.1, 0.25), shares, (0.5, 0.25), strict=True)
    ]
    result = StudyResult(
        study="pitch",
        title=study.title,
        mission="m",
        platform="p",
        seed=1,
        expect_status="completed",
        quantities=(Quantity(name="pitch", symbol="p", unit="m", base=0.1),),
        columns=(),
        variants=tuple(variants),
        common={
            ACTIVE: Metric(value=0.3456, unit="m²"),
            TOO_RESISTIVE: Metric(value=0.0864, unit="m²"),
        },
    )
    area, sites, *more = study.concluded(result).findings
    unsteady, by_rule = more[-2:]
    assert english in area
    assert english in sites
    assert "The grid of 0.25 m missed less area than that of 0.1 m" in unsteady
    assert by_rule.startswith("Over 0.086 m² (25.0 %) of the truly active area")
    assert "more than 100 Ω·m" in by_rule
    # Both shares are the same: two sentences, or none, for each mean near the level.
    near = [share for share in shares if abs(share - 0.95) < 2.0 * 0.0125]
    assert sum("two standard errors of 95 %" in finding for finding in more) == 2 * len(near)
    for finding in (area, sites, *more):
        known = recorded(finding)
        assert isinstance(known, Said)
        assert language("en").plain(known) == finding
    assert language("de").plain(recorded(area)).startswith(german)
    assert "1,2 %" in language("de").plain(recorded(sites))


def test_the_pseudo_language_finds_what_is_left() -> None:
    words = Pseudo.made().plain
    assert words(say("{n} of {m}", n="one", m=number(1.5, 1))) == "one⟦ of ⟧1,5"
    assert shown("⟦shown ⟧left 12 mV") == "left 12 mV"


def test_german_has_its_own_signs(fly: Fly, report: Report, tmp_path: Path) -> None:
    flight = fly(acceptance=ACCEPTANCE)
    log, english = flight.log(), report(flight)
    evaluated = with_maps(evaluate_with_arrays(log).assessed)
    document = report_document(log, english.result, log.plan(), evaluated)
    path = deliver(tmp_path, document, Wanted("de"))
    page = Page(path.read_text(encoding="utf-8"))
    assert '<html lang="de">' in page.source
    assert '<html lang="en">' in english.page.source
    for told, code in ((page, "de"), (english.page, "en")):
        signs = {"de": ",\u202f", "en": ".\u202f"}[code]
        assert {f["layout"]["separators"] for f in told.figures.values()} == {signs}
    for words in (
        "9 von 9 Messwerten sind gültig.",
        "Aktive Korrosion ist an den Punkten 2 und 3 angezeigt.",
        "1,8 N in der Kontaktphase, Sollwert 10 cm dahinter (§\u00a0V-E)",
        "0,91 N (§\u00a0V-F, Tabelle IV)",
        "1,44 … 2,16",
        "Versatz ± 0,02 mm, Neigung ± 0,03 mrad",
        "Potentialfeldmessung",
        "it presses with 1.8 N",
    ):
        assert words in page.text, words
    # No point stands between two digits but in what is not ours.
    kept = {"it presses with 1.8 N", *foreign(flight)}
    ours = re.compile("|".join(map(re.escape, sorted(kept, key=len, reverse=True))))
    texts = [ours.sub("", re.sub(r"%\{[^}]*\}", "", text)) for text in visible(page)]
    assert [text for text in texts if re.search(r"\d\.\d", text)] == []


def test_numbers_and_plurals() -> None:
    german, english = language("de").plain, language("en").plain
    assert german(number(-2750.25, 2)) == "−2\u202f750,25"
    assert english(number(-2750.25, 2)) == "−2\u202f750.25"
    assert german(significant(1.5e-5, 2)) == "1,5e−05"
    assert german(number(None, 2)) == "–"
    for n, words in ((0, "0 Teilflügen"), (1, "1 Teilflug"), (2, "2 Teilflügen")):
        assert german(count(n, "{n} sortie", "{n} sorties")) == words
    assert german(say("nobody translates this")) == "nobody translates this"


def test_the_command_line_offers_the_languages(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.run(["report", "--help"]) == 0
    assert "--language" in capsys.readouterr().out
    assert cli.run(["report", "nowhere", "--language", "fr"]) == 2
    refused = capsys.readouterr().err
    assert all(f"'{code}'" in refused for code in LANGUAGES)
