"""Each kind has a row on each of its floors, under its name."""

from __future__ import annotations

from collections.abc import Mapping
from typing import get_args

import pytest
from pydantic import BaseModel

from inspect_cli.metrics.instruments import INSTRUMENTS as EVALUATED
from inspect_cli.schema.disturbances import DISTURBANCES
from inspect_cli.schema.specimens import SPECIMENS
from inspect_cli.schema.vehicle.sensors import INSTRUMENTS, SENSORS
from inspect_cli.sensing.judges import JUDGES
from inspect_cli.sensing.sensors import SENSORS as SIMULATED
from inspect_cli.truth.disturbances import LOADS
from inspect_cli.truth.specimens import FIELDS


@pytest.mark.parametrize(
    ("models", "simulated", "key"),
    [
        (SENSORS, SIMULATED, "kind"),
        (DISTURBANCES, LOADS, "kind"),
        (SPECIMENS, FIELDS, "model"),
    ],
)
def test_a_kind_has_a_model_of_its_name_and_is_simulated(
    models: Mapping[str, type[BaseModel]], simulated: Mapping[str, object], key: str
) -> None:
    assert list(models) == list(simulated)
    for name, model in models.items():
        assert get_args(model.model_fields[key].annotation) == (name,)


def test_an_instrument_is_judged_and_evaluated() -> None:
    assert list(INSTRUMENTS) == list(JUDGES) == list(EVALUATED)
    for name, row in EVALUATED.items():
        assert row.reader.kind == name
