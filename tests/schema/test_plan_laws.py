"""The law of contact on a target: which kinds there are, and what of it is refused."""

from __future__ import annotations

import json
from typing import Annotated

import pytest
from pydantic import Field, TypeAdapter, ValidationError

from inspect_cli.interfaces import ContactLaw, DepthLaw, ForceLaw

LAW = TypeAdapter(Annotated[ContactLaw, Field(discriminator="kind")] | None)


@pytest.mark.parametrize("law", [DepthLaw(0.1, "contact_ndt", 1.8), ForceLaw(2.0), None])
def test_a_law_comes_back_from_json(law):
    assert LAW.validate_json(LAW.dump_json(law)) == law


def test_both_laws_say_how_deep_and_how_hard():
    assert (DepthLaw(0.1, "soft", 1.8).depth_m, DepthLaw(0.1, "soft", 1.8).expected_force_n) == (
        0.1,
        1.8,
    )
    assert (ForceLaw(2.0).depth_m, ForceLaw(2.0).expected_force_n) == (0.0, 2.0)


@pytest.mark.parametrize(
    "law",
    [
        {"kind": "depth", "depth_m": -0.1, "profile": "soft", "expected_force_n": 1.0},
        {"kind": "depth", "depth_m": 0.1, "profile": "soft", "expected_force_n": float("nan")},
        {"kind": "force", "force_n": -1.0},
        {"kind": "magnet", "force_n": 1.0},
    ],
)
def test_what_is_no_law_is_refused(law):
    with pytest.raises(ValidationError):
        LAW.validate_json(json.dumps(law))
