"""Reports of rope pulls, drawings, slides and estimates: what they say and what they draw."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from example_flights import Flight, survey
from experiment_flights import (
    APART_M,
    PULL_N,
    drawing,
    force_evaluation,
    hold,
    servoing,
)
from modes import Mode
from report_pages import Reported, decoded, trace

from inspect_cli.records import Estimate, Reference, State, TrueContact, TrueDisturbance, WallForce

Report = Callable[[Flight], Reported]
Build = Callable[[Path], Flight]

FOREIGN = ("orrosion", "ASTM", "half-cell", "valid readings", "asks for no reading", "CSE")


@pytest.mark.parametrize(
    ("build", "kicker", "finding", "heading"),
    [
        (
            drawing,
            "Flight report · push-and-slide drawing",
            "Two trials of one drawing; they differ by 4.0 mm RMS in the plane.",
            "Drawing",
        ),
        (
            servoing,
            "Flight report · depth servoing",
            "The tool slid 0.40 m along a surface known by the depth camera alone at 0.067 m/s",
            "Depth servoing",
        ),
        (
            hold,
            "Flight report · rope pulls in free flight",
            "Two pulls at a cord with up to 6 N moved the body by up to 300 mm",
            "Rope pulls",
        ),
        (
            force_evaluation,
            "Flight report · contact, estimates against ground truth",
            "Two points were pressed without a reading, on average with",
            "Estimates against ground truth",
        ),
        (
            lambda platform: hold(platform, pulls=0),
            "Flight report · holding a pose",
            "One pose held in free flight for 30 s.",
            "Flight",
        ),
    ],
)
def test_a_report_without_readings_says_what_it_is(
    report: Report, platform_file: Path, build: Build, kicker: str, finding: str, heading: str
) -> None:
    page = report(build(platform_file)).page
    places = [page.text.find(words) for words in (kicker, finding, heading)]
    assert -1 not in places
    assert "– flight report" in page.source
    summary = page.text[: page.text.index("Pose tracking")].split("Half-cell readings at 5 cm")[-1]
    for words in FOREIGN:
        assert words not in summary, words
    sections = [a["id"] for tag, a in page.tags if tag == "section"]
    assert "survey" not in sections
    assert sections[0] == "summary"
    assert all(a["aria-label"] for _, a in page.tags if a.get("class") == "plot")


def test_both_trials_lie_on_the_reference(report: Report, platform_file: Path) -> None:
    reported = report(drawing(platform_file))
    figures = reported.page.figures
    names = [name for name in figures if name.startswith("drawing")]
    assert names == ["drawing-1", "drawing-1-apart", "drawing-1-position", "drawing-1-attitude"]
    plan = figures["drawing-1"]
    assert plan["layout"]["yaxis"]["scaleanchor"] == "x"
    assert [t["name"] for t in plan["data"]] == ["reference", "trial 1", "trial 2"]
    for name, above in (("reference", 0.0), ("trial 1", 0.0), ("trial 2", APART_M)):
        line = trace(plan, name)
        assert np.ptp(decoded(line["x"])) == pytest.approx(0.4, abs=1e-3)
        assert decoded(line["y"]).max() == pytest.approx(0.1 + above, abs=1e-4)
    apart = decoded(figures["drawing-1-apart"]["data"][0]["y"])
    assert np.nanmax(apart) == pytest.approx(1e3 * APART_M, abs=1e-3)
    assert np.nanmax(decoded(figures["drawing-1-apart"]["data"][0]["x"])) == pytest.approx(
        1.2, abs=1e-3
    )


def test_trials_are_drawn_since_their_first_touch(report: Report, platform_file: Path) -> None:
    flight = drawing(platform_file)
    figure = report(flight).page.figures["drawing-1-position"]
    assert not figure["timed"]
    texts = [a["text"] for a in figure["layout"]["annotations"]]
    assert texts == ["", "(a)", "(b)"]
    force, t_s = flight.rows(State)["f_normal"], flight.rows(State)["t_s"]
    touching = t_s[(force > 0.1) & (flight.rows(Reference)["target"] == 0)]
    release = figure["layout"]["annotations"][2]["x"]
    assert release == pytest.approx(touching[-1] - touching[0], abs=1e-6)
    for name in ("trial 1", "trial 2"):
        heights = [t for t in figure["data"] if t["name"] == name and t["yaxis"] == "y3"]
        assert decoded(heights[0]["x"]).min() == pytest.approx(-2.0, abs=0.011)


def test_pulls_are_numbered_and_in_the_bodys_axes(report: Report, platform_file: Path) -> None:
    flight = hold(platform_file)
    yaw = np.array([np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5)])  # x_B along y_W: the cord is at −y_B
    flight.rows(State)["q_WB"] = flight.rows(Reference)["q_WB"] = yaw
    reported = report(flight)
    figure = reported.page.figures["pull-position"]
    assert [a["text"] for a in figure["layout"]["annotations"]] == ["1", "2"]
    assert figure["layout"]["xaxis"]["range"] == pytest.approx([4.0, 24.0], abs=0.02)
    error = [t for t in figure["data"] if t["name"] == "truth − reference"]
    assert decoded(error[1]["y"]).min() == pytest.approx(-0.05 * PULL_N, rel=1e-3)
    assert np.abs(decoded(error[0]["y"])).max() < 1e-6
    cord = [t for t in figure["data"] if t["name"] == "cord (truth)"]
    assert decoded(cord[1]["y"]).min() == pytest.approx(-PULL_N, rel=1e-3)
    rows = [figure["layout"][f"yaxis{k}"]["range"] for k in ("", 2, 3)]
    assert rows[0] == rows[1] == rows[2]
    text = reported.page.text
    assert "Pulls at the cord. Along, across and in z" in text
    assert "16.0" not in text[: text.index("Pulls at the cord. Along")]
    # 0.05 m/N: 300 mm along, nothing across; the arm is turned, so it pulls at 90° to x_B.
    start = text.index("N·m about z_B")
    assert "90.0" in text[start : start + 200]
    assert "300.0" in text[start : start + 200]


def test_the_slide_is_seen_from_the_side(report: Report, platform_file: Path) -> None:
    figures = report(servoing(platform_file)).page.figures
    side = figures["slide-1-side"]
    assert side["layout"]["yaxis"]["scaleanchor"] == "x"
    surface = trace(side, "true surface")
    assert decoded(surface["y"]) == pytest.approx(0.0, abs=1e-6)
    tip = trace(side, "tool's tip (truth)")
    # x_T points down at the wall, the slide goes sideways: nothing of it is seen along x_T.
    assert np.ptp(decoded(tip["x"])) < 1e-6
    assert decoded(trace(side, "reference")["y"]).min() == pytest.approx(-0.1, abs=1e-6)
    arrows = trace(side, "surface as seen")
    assert len(decoded(arrows["x"])) % 3 == 0
    assert np.isnan(decoded(arrows["x"])[2::3]).all()
    assert np.hypot(
        np.diff(decoded(arrows["x"]))[::3], np.diff(decoded(arrows["y"]))[::3]
    ) == pytest.approx(0.05, abs=1e-3)
    over_time = figures["slide-1-time"]
    marks = [a for a in over_time["layout"]["annotations"] if a["text"] in ("moves", "stops")]
    assert marks[1]["x"] - marks[0]["x"] == pytest.approx(6.0, abs=0.03)


def test_the_sensors_force_is_that_on_the_vehicle(report: Report, platform_file: Path) -> None:
    flight = force_evaluation(platform_file)
    reported = report(flight)
    figure = reported.page.figures["ground-truth-force"]
    filtered = decoded(trace(figure, "wall sensor, filtered")["y"])
    assert filtered.min() == pytest.approx(-1.8, abs=0.5)  # it pushes the vehicle off the wall
    raw = decoded(trace(figure, "wall sensor, raw")["y"])
    assert raw.min() < figure["layout"]["yaxis"]["range"][0]
    text = reported.page.text
    assert "Ours, RMSE" in text
    assert all(number in text for number in ("0.0123", "0.0577", "1.62", "0.93"))
    del flight.channels[WallForce.topic]
    figures = report(flight).page.figures
    assert "ground-truth-force" not in figures
    assert "ground-truth-attitude" in figures


@pytest.mark.parametrize("build", [drawing, servoing, hold, force_evaluation])
@pytest.mark.parametrize(
    "missing",
    [
        (State,),
        (Estimate,),
        (Reference,),
        (State, TrueContact, TrueDisturbance),
        (TrueContact,),
    ],
)
def test_a_missing_channel_gives_no_figure(
    report: Report, platform_file: Path, build: Build, missing: tuple[type, ...]
) -> None:
    flight = build(platform_file)
    for record in missing:
        flight.channels.pop(record.topic, None)
    page = report(flight).page
    assert "Provenance" in page.text
    for name, figure in page.figures.items():
        assert figure["data"], name


@pytest.mark.parametrize("build", [drawing, servoing, hold, force_evaluation])
def test_a_flight_cut_short_is_told(report: Report, platform_file: Path, build: Build) -> None:
    for end_s in (0.0, 2.5, 7.0, 12.5):
        page = report(build(platform_file).cut_at(end_s)).page
        assert "The log was cut off" in page.text


@pytest.mark.parametrize("build", [drawing, servoing, hold, force_evaluation])
@pytest.mark.parametrize("force", [np.inf, 0.0])
def test_a_diverged_flight_is_told(
    report: Report, platform_file: Path, build: Build, force: float
) -> None:
    flight = build(platform_file)
    state = flight.rows(State)
    for k, field in enumerate(("p_WB", "p_WT", "q_WB", "q_WT")):
        state[field][600:] = (1e200, np.nan, 0.0, np.nan)[k]
    state["f_normal"][600:] = force
    flight.status = "diverged"
    assert "The simulation diverged" in report(flight).page.text


def test_what_was_never_reached_is_said(report: Report, platform_file: Path) -> None:
    flight = drawing(platform_file)
    reference = flight.rows(Reference)
    reference["mode"], reference["target"] = Mode.HOVER, -1.0
    flight.rows(State)["f_normal"] = 0.0
    text = report(flight).page.text
    assert "There is nothing to draw" in text
    assert "their difference was not measured" in text


def test_readings_and_pulls_stand_in_one_report(report: Report, platform_file: Path) -> None:
    flight = survey(platform_file, 1, 3)
    state = flight.rows(State)
    felt = np.zeros(len(state), TrueDisturbance.dtype())
    felt["t_s"] = state["t_s"]
    felt["pull"][800:1200], felt["f_rope_W"][800:1200, 1] = 1.0, 3.0
    flight.channels[TrueDisturbance.topic] = felt
    page = report(flight).page
    sections = [a["id"] for tag, a in page.tags if tag == "section"]
    assert sections[:3] == ["summary", "survey", "pulls"]
    assert "Inspection report · half-cell potential by contact, rope pulls" in page.text
    assert "One pull at a cord with up to 3 N" in page.text
