"""The page as a whole: self-contained, reproducible, escaped, complete for every kind of flight."""

from __future__ import annotations

import re
import time
from collections.abc import Callable

import numpy as np
import pytest
from example_flights import Flight, spoil
from modes import Mode
from plotly.offline import get_plotlyjs
from report_pages import Page, Reported, decoded

from inspect_cli.assessment.classes import COMBINED_RULE
from inspect_cli.commands.surface_maps import with_maps
from inspect_cli.metrics.evaluate import evaluate_with_arrays
from inspect_cli.records import (
    Command,
    Estimate,
    InvalidReason,
    Probe,
    Reading,
    Reference,
    State,
    SurfaceEstimate,
    TrueContact,
)
from inspect_cli.reporting.documents.flight import report_document
from inspect_cli.reporting.screen.html import html
from inspect_cli.reporting.words.language import language
from inspect_cli.schema.result import Metric

Fly = Callable[..., Flight]
Report = Callable[[Flight], Reported]

EVIL = "</script><script>document.documentElement.dataset.pwned='1'</script><b>&amp;"


def test_a_completed_flight_is_told_in_order(fly: Fly, report: Report) -> None:
    acceptance = (
        {"metric": "contact.points_valid", "min": 9, "ref": "A8.map"},
        {"metric": "contact.force_peak_n", "max": 0.5, "known_failure": "it presses with 1.8 N"},
        {"metric": "contact.force_mean_n", "min": 2.5},
    )
    page = report(fly(acceptance=acceptance)).page
    wanted = [
        "Half-cell readings at 5 cm on a reinforced concrete wall",
        "completed",
        "9 of 9 readings are valid.",
        "Active corrosion is indicated at points 2 and 3.",
        "active by potential and resistivity",
        "✓ pass",
        "it presses with 1.8 N",
        "✗ fail",
        "This is a simulated flight.",
        "interpretation to a specialist",
        "not corrected for temperature: the temperature is not known",
        COMBINED_RULE,
        "Readings by point.",
        "Errors of tracking and estimation.",
        "Surfaces as the planner believed them.",
        "offset ± 0.02 mm, tilt ± 0.03 mrad",
        "Planned duration",
        "SHA-256",
    ]
    places = [page.text.find(words) for words in wanted]
    assert -1 not in places, wanted[places.index(-1)]
    assert places == sorted(places)


def test_every_figure_is_there_and_described(fly: Fly, report: Report) -> None:
    page = report(fly(2, 3)).page
    assert list(page.figures) == [
        "map-1",
        "error-1",
        "cumulative-1",
        "histogram-1",
        "resistivity-1",
        "position",
        "position-error",
        "attitude",
        "attitude-error",
        "force",
        "wrench-force",
        "wrench-torque",
        "tof",
        "actuators",
        "scene",
        "modes",
    ]
    plots = [attributes for _, attributes in page.tags if attributes.get("class") == "plot"]
    assert [p["id"] for p in plots] == [f"plot-{name}" for name in page.figures]
    assert all(p["aria-label"] for p in plots)
    tables = sum(tag == "table" for tag, _ in page.tags)
    assert tables == sum(tag == "caption" for tag, _ in page.tags) > 5


def test_it_loads_nothing_and_holds_plotly_once(fly: Fly, report: Report) -> None:
    page = report(fly()).page
    for tag, attributes in page.tags:
        assert "src" not in attributes, tag
        if "href" in attributes:
            assert str(attributes["href"]).startswith(("#", "data:")), attributes
    style = re.search(r"<style>(.*?)</style>", page.source, re.DOTALL)
    assert style
    assert "url(" not in style[1]
    assert "@import" not in style[1]
    assert page.source.count("plotly.js v") == 1
    policy = next(a["content"] for _, a in page.tags if "http-equiv" in a)
    assert "default-src 'none'" in str(policy)
    assert "unsafe-eval" not in str(policy)


def test_same_log_same_bytes(fly: Fly, report: Report) -> None:
    first = report(fly())
    before = first.path.read_bytes()
    time.sleep(0.01)
    assert report(fly()).path.read_bytes() == before


def test_a_long_flight_stays_small_and_quick(fly: Fly) -> None:
    flight = fly(4, 6)  # 253 s
    log = flight.log()
    evaluation = evaluate_with_arrays(log)
    result = evaluation.result
    begin = time.process_time()
    evaluated = with_maps(evaluation.assessed)
    page = html(report_document(log, result, log.plan(), evaluated), language("en"))
    assert time.process_time() - begin < 2.0
    assert len(page.encode()) - len(get_plotlyjs().encode()) < 3e6


def test_what_a_user_wrote_is_text(fly: Fly, report: Report) -> None:
    words = {"title": EVIL, "description": EVIL, "label": EVIL, "event": EVIL}
    flight = fly(1, 3, words=words)
    flight.status, flight.status_reason = "aborted", EVIL
    flight.run = {"seed": 1, "versions": {EVIL: EVIL}}
    spoil(flight, 1, InvalidReason.FORCE)
    page = report(flight).page
    assert page.text.count(EVIL) >= 8
    executed = [text for attributes, text in page.scripts if attributes.get("type") is None]
    assert len(executed) == 2
    assert not any("pwned" in text for text in executed)
    assert not any(tag == "b" for tag, _ in page.tags)
    # Plotly reads tags in labels, so there the text arrives with entities.
    drawn = page.figures["map-1"]["data"]
    texts = [text for one in drawn for key in ("text", "customdata") for text in one.get(key) or ()]
    assert any("&lt;/script&gt;&lt;script&gt;" in text for text in texts)
    assert any("&lt;/script&gt;&lt;scr…" in text for text in texts)
    assert not any("<scr" in text for text in texts)


def without_truth(flight: Flight) -> None:
    flight.without_truth()


def without_valid_reading(flight: Flight) -> None:
    for k in range(9):
        spoil(flight, k, InvalidReason.OPEN_CIRCUIT)


def wall_missing(flight: Flight) -> None:
    flight.channels[Reading.topic] = flight.rows(Reading)[:0]
    flight.status, flight.status_reason = "aborted", "no surface within reach of target 1"
    reference = flight.rows(Reference)
    reference["mode"][reference["t_s"] > 9.0] = Mode.HOVER
    contact = flight.rows(TrueContact)
    contact["surface"], contact["potential"] = -1.0, np.nan
    flight.rows(SurfaceEstimate)["valid"] = 0.0


def cut_early(flight: Flight) -> None:
    flight.cut_at(20.0)


def cut_at_once(flight: Flight) -> None:
    flight.cut_at(0.0)


def diverged(flight: Flight) -> None:
    state, estimate = flight.rows(State), flight.rows(Estimate)
    state["p_WB"][5000:] = 1e200
    state["q_WB"][5000:] = np.nan
    state["f_normal"][5000:] = np.inf
    estimate["q_WB"][5000:] = 0.0
    estimate["wrench_B"][5000:] = np.nan
    flight.status, flight.status_reason = "diverged", "bad acceleration"


def without_channels(flight: Flight) -> None:
    for record in (Command, Probe, Reference, SurfaceEstimate):
        del flight.channels[record.topic]


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (without_truth, "9 of 9 readings are valid."),
        (without_valid_reading, "Without a valid reading nothing can be said about corrosion."),
        (wall_missing, "The flight was aborted. Reason: no surface within reach of target 1."),
        (cut_early, "The log was cut off: what follows ends there."),
        (cut_at_once, "The log was cut off"),
        (diverged, "The simulation diverged: the flight is not to be used."),
        (without_channels, "9 of 9 readings are valid."),
    ],
)
def test_every_kind_of_end_is_reported(
    fly: Fly, report: Report, change: Callable[[Flight], None], sentence: str
) -> None:
    flight = fly()
    change(flight)
    page = report(flight).page
    assert sentence in page.text
    for name, figure in page.figures.items():
        for line in figure["data"]:
            if line["type"] in ("scatter", "scatter3d", "bar") and isinstance(line["x"], dict):
                columns = [line[axis] for axis in "xyz" if isinstance(line.get(axis), dict)]
                assert len({len(decoded(column)) for column in columns}) == 1, name


def test_an_expected_abort_is_told_as_such(fly: Fly, report: Report) -> None:
    flight = fly(1, 1)
    flight.mission = flight.mission.model_copy(update={"expect_status": "aborted"})
    assert "expects it to be aborted, which it was not." in report(flight).page.text
    flight.status = "aborted"
    assert "expects it to be aborted, as it was." in report(flight).page.text


def test_a_real_flight_claims_no_simulation(fly: Fly, report: Report) -> None:
    page = report(fly().without_truth()).page
    assert "simulated" not in page.text
    names = {line.get("name") for figure in page.figures.values() for line in figure["data"]}
    assert not any("truth" in str(name) for name in names)
    assert "estimate − reference" in names


def test_one_point_and_other_vehicles(fly: Fly, report: Report) -> None:
    page = report(fly(1, 1, n_rotors=4, n_joints=0)).page
    assert "The one reading is valid." in page.text
    panels = [k for k in page.figures["actuators"]["layout"] if k.startswith("yaxis")]
    assert len(panels) == 2  # thrust and saturation; a vehicle without joints has no third
    page = report(fly(1, 2, n_rotors=8, n_joints=11)).page
    assert len(page.figures["actuators"]["data"]) == 2 * (8 + 11) + 1


def test_points_active_by_potential_alone_are_named(fly: Fly, report: Report) -> None:
    flight = fly()
    flight.rows(Reading)["resistance"] = 150.0 / 0.08  # above the combined rule's 100 Ω·m
    text = report(flight).page.text
    assert (
        "By potential alone (ASTM C876) points 2 and 3 are active; "
        "the combined rule calls them possible." in text
    )
    assert "No active corrosion" not in text
    flight.rows(Reading)["potential"] = -0.25
    text = report(flight).page.text
    assert "By potential alone" not in text
    assert "No reading indicates active corrosion; it cannot be ruled out at points 1, 2, 3" in text


def test_a_bumped_body_and_motion_at_the_end_are_warned_of(fly: Fly, report: Report) -> None:
    flight = fly(1, 1)
    log, reported = flight.log(), report(flight)
    assert not any(a.get("class") == "warnings" for _, a in reported.page.tags)
    bad = {
        "contact.body_force_max_n": Metric(value=263.2, unit="N"),
        "flight.end_speed_mps": Metric(value=0.41, unit="m/s"),
        "flight.duration_s": Metric(value=4321.4, unit="s"),
    }
    result = reported.result.model_copy(update={"metrics": reported.result.metrics | bad})
    page = Page(html(report_document(log, result, flight.plan), language("en")))
    assert any(a.get("class") == "warnings" for _, a in page.tags)
    assert "The vehicle's body touched something: 263 N." in page.text
    assert "The vehicle was still moving at the end: 0.41 m/s." in page.text
    assert "4\u202f321 sflight time" in page.text


def test_points_stand_in_the_order_of_their_labels(fly: Fly, report: Report) -> None:
    flight = fly(1, 12)
    labels = [str(12 - k) for k in range(12)]
    targets = [
        t.model_copy(update={"label": label})
        for t, label in zip(flight.plan.targets, labels, strict=True)
    ]
    flight.plan = flight.plan.model_copy(update={"targets": tuple(targets)})
    flight.rows(Reading)["potential"] = -0.25
    assert (
        "ruled out at points 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11 and 12." in report(flight).page.text
    )
