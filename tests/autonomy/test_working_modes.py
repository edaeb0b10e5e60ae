"""The executive holds poses, draws strokes and follows surfaces: modes, times, profiles, aborts."""

from __future__ import annotations

import pytest
from script import (
    APPROACH_MPS,
    PRESS_M,
    PRESS_MPS,
    STANDOFF_M,
    TICK_S,
    Script,
    target,
    two_point_plan,
)

from inspect_cli.schema.flight_times import PAUSE_S
from inspect_cli.schema.plan import Following, Leg, LegKind, Plan, Stroke, Target
from inspect_cli.vehicles.fully_actuated.modes import BEFORE_CONTACT_M

HOLD_S, SETTLE_S, FOLLOW_S = 4.0, 2.0, 1.5
SLACK_S = 2.5 * TICK_S
POSE, STROKE, FOLLOWING = 0, 1, 2


def working_plan() -> Plan:
    """A pose, a stroke and a following, each with its own profile; nothing is read."""
    base = two_point_plan()

    def made(index: int, kind: str, **more: object) -> Target:
        update = {"kind": kind, "impedance": f"for_{kind}", "sensor": None, **more}
        return target(index).model_copy(update=update)

    stroke = Stroke(pieces_m=(((0.0, 0.0), (0.2, 0.0)),), speed_mps=0.1)
    following = Following(direction="y", distance_m=0.5, speed_mps=0.17)
    targets = (
        made(POSE, "pose", dwell_s=HOLD_S, law=None, standoff_m=0.0),
        made(STROKE, "stroke", dwell_s=SETTLE_S, stroke=stroke),
        made(FOLLOWING, "following", dwell_s=FOLLOW_S, following=following, surface=None),
    )
    pattern = {leg.kind: leg for leg in base.legs}

    def leg(kind: LegKind, index: int | None) -> Leg:
        like = pattern.get(kind, pattern["transit"])
        return like.model_copy(update={"kind": kind, "target": index})

    touching: tuple[LegKind, ...] = ("transit", "approach", "press", "slide", "retreat")
    legs = [leg("takeoff", None), leg("transit", POSE), leg("hold", POSE)]
    legs += [leg(kind, index) for index in (STROKE, FOLLOWING) for kind in touching]
    legs += [leg("transit", None), leg("land", None)]
    return base.model_copy(update={"targets": targets, "legs": tuple(legs)})


@pytest.fixture
def script() -> Script:
    return Script(working_plan())


def test_the_whole_script(script: Script) -> None:
    script.run_until(lambda: script.executive.finished)
    touching = ["transit", "approach", "press", "slide", "retreat"]
    assert script.modes == [
        ("idle", -1),
        ("takeoff", -1),
        ("transit", POSE),
        ("hold", POSE),
        *[(mode, STROKE) for mode in touching],
        *[(mode, FOLLOWING) for mode in touching],
        ("transit", -1),
        ("land", -1),
        ("landed", -1),
    ]
    assert script.executive.status == "completed"
    assert script.context.readings == []
    assert script.judges == []
    slides = [call[0] for call in script.guidance.calls if call[0].startswith("slide")]
    assert slides == ["slide A2", "slide A3"]


def test_each_target_has_its_profile_from_the_way_there_on(script: Script) -> None:
    script.run_until(lambda: script.executive.finished)
    assert len(script.guidance.impedances) == len(script.modes) - 1  # all but IDLE
    for (_, index), name in zip(script.modes[1:], script.guidance.impedances, strict=True):
        kind = {POSE: "pose", STROKE: "stroke", FOLLOWING: "following"}.get(index)
        assert name == (f"for_{kind}" if kind else "contact_ndt")


def test_a_pose_is_held_for_its_time(script: Script) -> None:
    script.run_to("hold")
    assert script.run_until(lambda: script.mode != "hold") == pytest.approx(HOLD_S, abs=SLACK_S)


@pytest.mark.parametrize(
    ("index", "mode", "takes_s"),
    [
        (STROKE, "press", 1.0 + SETTLE_S),
        (STROKE, "slide", 1.0 + PAUSE_S),
        (FOLLOWING, "press", 1.0 + FOLLOW_S),
        (FOLLOWING, "slide", 1.0 + FOLLOW_S),
    ],
)
def test_the_tool_settles_before_a_slide_and_after_a_following(
    script: Script, index: int, mode: str, takes_s: float
) -> None:
    """The scripted guidance arrives after a second."""
    script.run_to(mode, index)
    took = script.run_until(lambda: script.mode != mode)
    assert took == pytest.approx(takes_s, abs=SLACK_S)


@pytest.mark.parametrize(("index", "watches"), [(STROKE, False), (FOLLOWING, True)])
def test_a_following_watches_the_surface_while_it_slides(
    script: Script, index: int, watches: bool
) -> None:
    script.run_to("press", index)
    assert script.guidance.tracks_surface
    script.run_to("slide", index)
    assert script.guidance.tracks_surface == watches
    script.run_to("retreat", index)
    assert not script.guidance.tracks_surface


def test_what_is_seen_now_is_what_a_following_approaches(script: Script) -> None:
    script.run_to("approach", FOLLOWING)
    script.run(PAUSE_S + 3 * TICK_S)
    assert script.guidance.calls[-1] == ("approach A3", -BEFORE_CONTACT_M, APPROACH_MPS)
    assert script.guidance.observed == [script.guidance.observed[-1]]
    assert script.guidance.observed[-1] == pytest.approx(script.t_s, abs=PAUSE_S)
    script.run_to("press", FOLLOWING)
    assert script.guidance.calls[-1] == ("approach A3", PRESS_M, PRESS_MPS)


def test_a_following_waits_while_the_last_image_shows_no_surface(script: Script) -> None:
    """The estimate is one record that every image overwrites."""
    script.run_to("approach", FOLLOWING)
    calls = len(script.guidance.calls)
    script.blind_after_s = script.t_s + PAUSE_S - 2 * TICK_S
    script.run(PAUSE_S + 10 * TICK_S)
    assert len(script.guidance.calls) == calls
    script.blind_after_s = float("inf")
    script.run(2 * TICK_S)
    assert script.guidance.calls[-1][0] == "approach A3"


@pytest.mark.parametrize("index", [STROKE, FOLLOWING])
def test_a_surface_lost_while_sliding_ends_in_a_retreat(script: Script, index: int) -> None:
    script.guidance.takes_s = 5.0
    script.run_to("slide", index)
    script.surfaces = False
    took = script.run_to("hover")
    assert took == pytest.approx(0.5, abs=SLACK_S)
    assert script.executive.reason == "surface lost while sliding"
    assert script.guidance.calls[-1][:2] == (f"approach A{index + 1}", -STANDOFF_M)


@pytest.mark.parametrize("index", [STROKE, FOLLOWING])
def test_another_surface_while_sliding_ends_in_a_retreat(script: Script, index: int) -> None:
    script.guidance.takes_s = 5.0
    script.run_to("slide", index)
    script.guidance.contradicted = True
    script.run_to("hover")
    assert script.executive.reason == "surface contradicts the plan"
    assert script.guidance.calls[-1][:2] == (f"approach A{index + 1}", -STANDOFF_M)


@pytest.mark.parametrize(
    ("mode", "index"), [("hold", POSE), ("slide", STROKE), ("slide", FOLLOWING)]
)
def test_without_poses_a_hold_stays_and_a_slide_backs_off(
    script: Script, mode: str, index: int
) -> None:
    script.guidance.takes_s = 5.0
    script.run_to(mode, index)
    script.poses = False
    script.run_to("hover")
    assert script.executive.reason == "pose measurements lost"
    what = script.guidance.calls[-1][0]
    assert what == ("hold" if mode == "hold" else f"approach A{index + 1}")
    # After an abort, possibly in contact, the profile stays.
    assert script.guidance.impedances[-1] != "contact_ndt"
    script.run_until(lambda: script.executive.finished)
    assert script.context.readings == []
    assert script.executive.status == "aborted"


@pytest.mark.parametrize(
    ("distance_m", "waits", "ends"), [(1.0, True, "hold"), (1.0, False, "hold"),
                                      (0.1, False, "approach A3")]
)  # fmt: skip
def test_a_following_that_is_far_from_its_surface_stops_where_it_is(
    script: Script, distance_m: float, waits: bool, ends: str
) -> None:
    """Its standoff would lead forward, or back into what nobody looked at."""
    script.guidance.takes_s = 5.0
    script.distance_m = distance_m
    script.run_to("transit", FOLLOWING)
    script.guidance.contradicted = waits
    script.run_to("approach", FOLLOWING)
    if not waits:
        script.run(1.0)
    script.poses = False
    script.run_to("hover")
    assert script.guidance.calls[-1][0] == ends
