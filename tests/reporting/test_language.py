"""Languages: complete catalogues, nothing left in English, numbers with the language's signs."""

from __future__ import annotations

import re
from collections.abc import Callable
from io import BytesIO
from pathlib import Path

import pytest
from babel.messages.pofile import read_po
from evaluated_points import evaluated_of
from example_flights import Flight, spoil
from experiment_flights import drawing, force_evaluation, hold, servoing
from report_pages import Page, Reported
from said_texts import names, reasons, said
from visible_words import Pseudo, foreign, left_over, shown, visible

from inspect_cli import cli
from inspect_cli.commands.study import STUDIES
from inspect_cli.metrics.evaluate import evaluate
from inspect_cli.metrics.flight import Flight as Logged
from inspect_cli.metrics.points import point_results
from inspect_cli.records import InvalidReason, Reading
from inspect_cli.reporting.content import Document
from inspect_cli.reporting.html import html
from inspect_cli.reporting.language import LANGUAGES, language
from inspect_cli.reporting.points import ReadPoint
from inspect_cli.reporting.recorded import RECORDED, recorded
from inspect_cli.reporting.report import report_document, write_report
from inspect_cli.reporting.study import study_document
from inspect_cli.reporting.survey import survey_document
from inspect_cli.reporting.text import Said, count, number, say, significant
from inspect_cli.schema.coverage import CoveragePlan, Skipped, Sortie
from inspect_cli.schema.result import Metric
from inspect_cli.schema.study import Quantity, StudyResult, StudyVariant

Fly = Callable[..., Flight]
Report = Callable[[Flight], Reported]

ACCEPTANCE = (
    {"metric": "contact.points_valid", "min": 9, "ref": "A8.map"},
    {"metric": "contact.force_mean_n", "min": 1.44, "max": 2.16, "ref": "A8.force"},
    {"metric": "contact.force_peak_n", "max": 0.5, "known_failure": "it presses with 1.8 N"},
    {"metric": "force_sensor.rmse_fy_n", "max": 2.5, "ref": "A9.force"},
)


@pytest.mark.parametrize("code", [code for code in LANGUAGES if code != "en"])
def test_every_sentence_of_the_source_is_translated(root: Path, code: str) -> None:
    package = root / "inspect_cli"
    file = package / "reporting" / "languages" / f"{code}.po"
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


def surveyed(flight: Flight) -> Document:
    log = flight.log()
    result = evaluate(log)
    added = Sortie(number=2, added=True, plan=flight.plan)
    sorties = [Sortie(number=1, plan=flight.plan), added, Sortie(number=3, plan=flight.plan)]
    left = Skipped(
        label="z-9", surface="wall", uv_m=(0.0, 0.1), p_WC=(2.0, 0.0, 1.3), reason="zu weit"
    )
    survey = CoveragePlan.of(sorties, [left], 12.3, 40.0)
    late = result.model_copy(update={"status": "aborted", "status_reason": "das Seil riss"})
    evaluated = evaluated_of(result, flight.plan)
    return survey_document(log, result, [result, late], survey, flight.plan, evaluated)


def studied() -> Document:
    study = STUDIES["force"]
    metrics = {c.metric: Metric(value=0.5, unit=c.unit) for c in study.columns}
    quantities = tuple(
        Quantity(name=f.name, symbol=f.symbol, unit=f.unit, base=1.0) for f in study.factors
    )
    values = {"gain": 1.0, "speed": 1.0}
    made = {"values": values, "metrics": metrics, "folder": "gain-1"}
    variants = (
        StudyVariant(name="gain-1", status="completed", **made),
        StudyVariant(
            name="gain-2", status="not flown", **(made | {"values": {**values, "gain": 2.0}})
        ),
    )
    result = StudyResult(
        study="force",
        title=study.title,
        mission="example-survey",
        platform="tilt_rotor_hexarotor",
        seed=1,
        expect_status="completed",
        quantities=quantities,
        columns=study.columns,
        variants=variants[:1],
    )
    return study_document(result, study.explained, study.figure(result))


def invalid(flight: Flight) -> Flight:
    for k in range(1, 9):
        spoil(flight, k, InvalidReason(k))
    flight.status, flight.status_reason = "aborted", "no surface within reach of target 1"
    return flight


def resistive(flight: Flight) -> Flight:
    flight.rows(Reading)["resistance"] = 150.0 / 0.08
    return flight


FLIGHTS: dict[str, Callable[[Fly, Path], Flight]] = {
    "nine": lambda fly, _: fly(acceptance=ACCEPTANCE),
    "invalid": lambda fly, _: invalid(fly(3, 3)),
    "resistive": lambda fly, _: resistive(fly()),
    "real": lambda fly, _: fly().without_truth(),
    "cut": lambda fly, _: fly().cut_at(20.0),
    "drawing": lambda _, platform: drawing(platform),
    "servoing": lambda _, platform: servoing(platform),
    "pulls": lambda _, platform: hold(platform),
    "hold": lambda _, platform: hold(platform, pulls=0),
    "forces": lambda _, platform: force_evaluation(platform),
}


@pytest.mark.parametrize("name", FLIGHTS)
def test_no_word_of_a_flights_report_is_left_in_english(
    fly: Fly, platform_file: Path, name: str
) -> None:
    flight = FLIGHTS[name](fly, platform_file)
    log = flight.log()
    result = evaluate(log)
    evaluated = evaluated_of(result, flight.plan)
    document = report_document(log, result, flight.plan, evaluated)
    page = Page(html(document, Pseudo.made()))
    assert left_over(page, foreign(flight)) == []


def test_no_word_of_a_surveys_report_is_left_in_english(fly: Fly) -> None:
    flight = fly(1, 3)
    page = Page(html(surveyed(flight), Pseudo.made()))
    others = {"z-9", "zu weit", "das Seil riss"}
    assert left_over(page, foreign(flight) | others) == []


def test_no_word_of_a_study_is_left_in_english(fly: Fly) -> None:
    page = Page(html(studied(), Pseudo.made()))
    assert left_over(page, foreign(fly(1, 1)) | {"gain-1"}) == []


def test_the_pseudo_language_finds_what_is_left() -> None:
    words = Pseudo.made().plain
    assert words(say("{n} of {m}", n="one", m=number(1.5, 1))) == "one⟦ of ⟧1,5"
    assert shown("⟦shown ⟧left 12 mV") == "left 12 mV"


def test_german_has_its_own_signs(fly: Fly, report: Report, tmp_path: Path) -> None:
    flight = fly(acceptance=ACCEPTANCE)
    log, english = flight.log(), report(flight)
    readings = (tmp_path / "readings.csv").read_bytes()
    evaluated = evaluated_of(english.result, flight.plan)
    path = write_report(log, english.result, tmp_path, "de", evaluated)
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
    assert (tmp_path / "readings.csv").read_bytes() == readings


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
