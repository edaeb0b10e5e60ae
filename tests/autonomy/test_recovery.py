"""Failsafes that try again, guards, modes that cannot run, and orders from outside the plan."""

from __future__ import annotations

from dataclasses import replace

import pytest
from script import TICK_S, Script

from inspect_cli.autonomy.failsafe import Failsafe
from inspect_cli.autonomy.modes import Mode, Order, by_name
from inspect_cli.errors import InputError
from inspect_cli.schema.modes import Phase
from inspect_cli.vehicles.fully_actuated import BEHAVIOUR
from inspect_cli.vehicles.fully_actuated.failsafes import BACK_OFF, NEAR_SURFACE
from inspect_cli.vehicles.fully_actuated.modes import MODES, back_off, stop

SLACK_S = 2.5 * TICK_S
GUST_N, CALM_N, WAIT_S = 8.0, 3.0, 4.0
GUST = Failsafe(
    "gust",
    NEAR_SURFACE,
    lambda i: not i.force_n <= GUST_N,
    0.1,
    BACK_OFF,
    (back_off,),
    retries=2,
    clear=lambda i: i.force_n <= CALM_N,
    wait_s=WAIT_S,
)


def script(**changes: object) -> Script:
    return Script(behaviour=replace(BEHAVIOUR, **changes))


def blow(flight: Script, force_n: float) -> None:
    flight.estimate.wrench_B[0] = force_n


def modes_of(flight: Script) -> list[str]:
    return [mode for mode, _ in flight.modes]


def test_after_a_gust_the_target_is_begun_again_from_its_first_order() -> None:
    flight = script(failsafes=(GUST,))
    flight.run_to("press", 0)
    blow(flight, GUST_N + 1.0)
    flight.run_to("hover")
    assert flight.executive.status == "completed"
    assert flight.guidance.calls[-1][0] == "approach A1"  # back to the standoff first
    blow(flight, 0.0)
    flight.run_until(lambda: flight.executive.finished)
    once = ["transit", "approach", "press"]
    assert modes_of(flight) == [
        *("idle", "takeoff", *once, "hover", *once, "retreat", *once, "retreat"),
        *("transit", "land", "landed"),
    ]
    assert flight.executive.status == "completed"
    assert [(r.target, r.valid) for r in flight.context.readings] == [(0.0, 1.0), (1.0, 1.0)]
    (warning,) = [event.text for event in flight.context.events if event.level == "warning"]
    assert warning == "gust; falling back, try 1 of 2"


def test_it_waits_in_its_fallback_until_the_row_is_clear() -> None:
    flight = script(failsafes=(GUST,))
    flight.run_to("press", 0)
    blow(flight, GUST_N + 1.0)
    flight.run_to("hover")
    blow(flight, 0.5 * (CALM_N + GUST_N))  # no violation, not clear either
    hovered = flight.guidance.takes_s + 3.0
    flight.run(hovered + 0.5 * WAIT_S)
    assert flight.mode == "hover"
    blow(flight, 0.0)
    assert flight.run_to("transit") < SLACK_S


def test_what_never_clears_ends_the_flight() -> None:
    flight = script(failsafes=(GUST,))
    flight.run_to("press", 0)
    blow(flight, GUST_N + 1.0)
    flight.run_to("hover")
    took = flight.run_until(lambda: flight.executive.finished)
    assert took == pytest.approx(flight.guidance.takes_s + 3.0 + WAIT_S, abs=2 * SLACK_S)
    assert (flight.executive.status, flight.executive.reason) == ("aborted", "gust")
    assert sorted(r.target for r in flight.context.readings) == [0.0, 1.0]


def test_after_its_last_try_a_row_aborts() -> None:
    flight = script(failsafes=(GUST,))
    for _ in range(3):
        assert flight.executive.status == "completed"
        blow(flight, 0.0)
        flight.run_to("press", 0)
        blow(flight, GUST_N + 1.0)
        flight.run_to("hover")
    assert (flight.executive.status, flight.executive.reason) == ("aborted", "gust")


def test_of_the_fallbacks_the_first_is_taken_whose_modes_have_what_they_need() -> None:
    """Without poses there is no hovering; the milder fallback would need them."""
    descend = Mode("descend", 11, Phase.SAFE, lambda c: c.t_s - c.since_s > 1.0)
    modes = MODES | by_name(replace(MODES["hover"], needs=frozenset({"pose"})), descend)
    row = replace(GUST, retries=0, fallbacks=(stop, lambda c: (Order("descend"),)))
    for poses, expected in ((True, "hover"), (False, "descend")):
        flight = script(failsafes=(row,), modes=modes)
        flight.run_to("press", 0)
        flight.poses = poses
        flight.run(0.5)
        blow(flight, GUST_N + 1.0)
        flight.run(0.3)
        assert flight.mode == expected


def test_a_guard_holds_an_order_back_and_the_mode_before_goes_on() -> None:
    opens_s = 20.0
    guarded = replace(MODES["approach"], guard=lambda c: "too early" if c.t_s < opens_s else "")
    flight = script(modes=MODES | by_name(guarded))
    flight.run_to("approach")
    assert flight.t_s == pytest.approx(opens_s, abs=SLACK_S)
    assert modes_of(flight)[:4] == ["idle", "takeoff", "transit", "approach"]


def test_submitted_orders_come_before_those_that_wait() -> None:
    """An inspector who watches the flight has it held once, and go on."""
    flight = script()
    flight.run_to("transit", 0)
    here = MODES["transit"]
    assert here.phase is Phase.FREE
    posture = flight.context.plan.start.posture
    flight.executive.submit(
        Order("transit", postures=(posture,), speed_mps=0.3),
        Order("transit", postures=(posture,), speed_mps=0.2),
    )
    flight.run_to("approach", 0)
    assert [speed for what, _, speed in flight.guidance.calls if what == "go_to"][2:4] == [0.3, 0.2]
    flight.run_until(lambda: flight.executive.finished)
    assert flight.executive.status == "completed"


def test_an_order_for_a_mode_that_is_not_there_is_refused() -> None:
    with pytest.raises(InputError, match="crawl"):
        script().executive.submit(Order("crawl"))
