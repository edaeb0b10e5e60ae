"""The modes of a fully actuated vehicle by name, with their numbers in a log, and their table."""

from __future__ import annotations

from enum import IntEnum

from inspect_cli.vehicles.fully_actuated import BEHAVIOUR

Mode = IntEnum("Mode", {name.upper(): mode.number for name, mode in BEHAVIOUR.modes.items()})
TABLE = BEHAVIOUR.table
TABLE_JSON = TABLE.model_dump_json().encode()
