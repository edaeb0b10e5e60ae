"""Entries of ``truth: disturbances:``: kinds, what each refuses, and that they come back."""

from __future__ import annotations

import json
from collections.abc import Callable

import pytest
from pydantic import ValidationError

from inspect_cli.schema.disturbances import Cable, ConstantWrench, Rope, Wind
from inspect_cli.schema.truth import TruthModel

Refusal = Callable[[str, str], list[str]]

ENTRY = "m.yaml:28:7: truth.disturbances[0]"
DRAG = "drag_area_m2: [0.1, 0.1, 0.1]"
OVERLAP = "the pull at 2 s begins before the one at 1 s has ended at 5 s"


def read(*entries: dict[str, object]) -> TruthModel:
    return TruthModel.model_validate_json(json.dumps({"disturbances": entries}))


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        (
            "{kind: ropes, direction: [1, 0, 0]}",
            "m.yaml:28:14: truth.disturbances[0].kind: no such kind: ropes\n"
            "    did you mean 'rope'? choices: constant, rope, wind, cable",
        ),
        ("{kind: 7}", "kind: no such kind: 7\n    choices: constant, rope, wind, cable"),
        ("{kind: }", "kind: no such kind: nothing\n    choices: constant, rope, wind, cable"),
        ("hello", f"{ENTRY}: must be a mapping; found hello"),
        ("{force_kn: [1, 0, 0]}", "unknown key 'force_kn'\n    the key is 'force_n', in newtons"),
        ("{start_s: -1}", "truth.disturbances[0].start_s: must be at least 0; found -1"),
        ("{kind: rope, direction: [1, 0, 0]}", f"{ENTRY}: missing key 'pulls'"),
        (
            "{kind: rope, direction: [1, 0, 0], pulls: []}",
            "truth.disturbances[0].pulls: must not be empty",
        ),
        (
            "{kind: rope, direction: [0, 0, 0], pulls: [{start_s: 1, force_n: 5}]}",
            "truth.disturbances[0].direction: a direction must not be zero",
        ),
        (
            "{kind: rope, direction: [1, 0, 0], stiffness_npm: 5000,"
            " pulls: [{start_s: 1, force_n: 5}]}",
            "truth.disturbances[0].stiffness_npm: must be at most 300; found 5000",
        ),
        (
            "{kind: rope, direction: [1, 0, 0], pulls: [{start_s: 1, force_n: 0}]}",
            "truth.disturbances[0].pulls[0].force_n: must be above 0; found 0",
        ),
        (
            "{kind: rope, direction: [1, 0, 0],"
            " pulls: [{start_s: 1, force_n: 5}, {start_s: 2, force_n: 5}]}",
            f"{ENTRY}: {OVERLAP}",
        ),
        (
            "{kind: wind, mean_mps: [0, 0, 1], gust: {w20_mps: 3}, " + DRAG + "}",
            f"{ENTRY}: gusts are carried past the vehicle by a horizontal mean wind of at least "
            "0.5 m/s; mean_mps has 0 m/s",
        ),
        (
            "{kind: wind, mean_mps: [3, 0, 0], gust: {w20_mps: 3, altitude_m: 1}, " + DRAG + "}",
            "gust.altitude_m: must be at least 3.048; found 1",
        ),
        ("{kind: wind, mean_mps: [3, 0, 0]}", f"{ENTRY}: missing key 'drag_area_m2'"),
        (
            "{kind: cable, length_cm: 1200, mass_kgpm: 0.03}",
            "unknown key 'length_cm'\n    the key is 'length_m', in metres: write length_m: 12",
        ),
        (
            "{kind: cable, length_m: 12, mass_gpm: 30}",
            "the key is 'mass_kgpm', in kg/m: write mass_kgpm: 0.03",
        ),
        (
            "{kind: cable, length_m: 12, mass_kgpm: 0.03, attached: gear}",
            "truth.disturbances[0].attached: no such choice: gear\n    choices: tool, body",
        ),
    ],
)
def test_what_is_wrong_is_said_where_it_stands(refusal: Refusal, entry: str, message: str) -> None:
    (found,) = refusal("acceptance:", f"  disturbances:\n    - {entry}\nacceptance:")
    assert message in found


def test_pulls_of_two_ropes_do_not_overlap_either(refusal: Refusal) -> None:
    rope = "    - {kind: rope, direction: [0, 1, 0], pulls: [{start_s: %g, force_n: 5}]}\n"
    two = f"  disturbances:\n{rope % 2}{rope % 1}acceptance:"
    (found,) = refusal("acceptance:", two)
    assert OVERLAP in found
    assert ": truth: " in found


def test_there_is_one_wind(refusal: Refusal) -> None:
    wind = "    - {kind: wind, mean_mps: [3, 0, 0], " + DRAG + "}\n"
    (found,) = refusal("acceptance:", f"  disturbances:\n{wind}{wind}acceptance:")
    assert "there is one air: give one wind" in found


ENTRIES = (
    {"force_n": [1, 2, 3]},
    {"kind": "constant", "torque_nm": [1, 2, 3]},
    {"kind": "rope", "direction": [0, 0, 2], "pulls": [{"start_s": 3, "force_n": 4}]},
    {"kind": "wind", "mean_mps": [3, 0, 0], "gust": {"w20_mps": 3}, "drag_area_m2": [1, 1, 1]},
    {"kind": "cable", "length_m": 12, "mass_kgpm": 0.03, "clamp_m": [1, 2]},
)


def test_without_a_kind_it_is_constant_and_every_kind_comes_back() -> None:
    truth = read(*ENTRIES)
    kinds = [type(entry) for entry in truth.disturbances]
    assert kinds == [ConstantWrench, ConstantWrench, Rope, Wind, Cable]
    assert TruthModel.model_validate_json(truth.model_dump_json(by_alias=True)) == truth
    assert TruthModel.model_validate(truth.model_dump()) == truth
    assert TruthModel(disturbances=truth.disturbances) == truth


@pytest.mark.parametrize(("entries", "depend"), [(ENTRIES[:2], False), (ENTRIES[4:], True)])
def test_constant_loads_do_not_depend_on_the_flight(
    entries: tuple[dict[str, object], ...], depend: bool
) -> None:
    assert read(*entries).loads_depend_on_the_flight is depend


def test_a_cable_needs_its_length() -> None:
    with pytest.raises(ValidationError):
        read({"kind": "cable", "mass_kgpm": 0.03})
