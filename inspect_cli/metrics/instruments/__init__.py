"""The instruments whose readings are evaluated: one file and one row each.

A package outside this one adds a row, an ``Instrument``, as an entry point of the group
``inspect_cli.instruments``, under the name that its sensor has in ``inspect_cli.sensors``.
"""

from __future__ import annotations

from collections.abc import Mapping

from inspect_cli.errors import EnvironmentFault
from inspect_cli.metrics.instrument import Instrument
from inspect_cli.metrics.instruments import half_cell
from inspect_cli.plugins import registered

GROUP = "inspect_cli.instruments"


def _checked(rows: Mapping[str, Instrument]) -> dict[str, Instrument]:
    """The rows, whose metrics are told apart by the names of their instruments.

    Raises:
        EnvironmentFault: a row has another name than its instrument, or metrics of another.
    """
    for kind, row in rows.items():
        if row.reader.kind != kind:
            raise EnvironmentFault(
                f"the row {kind!r} of {GROUP} holds the instrument {row.reader.kind!r}",
                hint="the name of the entry point is the kind of the sensor",
            )
        others = [name for name in row.metrics if not name.startswith(f"{kind}.")]
        if others:
            raise EnvironmentFault(
                f"the instrument {kind!r} has the metric {others[0]!r}",
                hint=f"name it {kind}.… so that it can hide no other",
            )
    return dict(rows)


INSTRUMENTS: dict[str, Instrument] = _checked(
    registered(GROUP, {"half_cell": half_cell.ROW}, Instrument)
)
