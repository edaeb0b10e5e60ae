"""The flight loop against the bare physics.

A flight with everything (sensors, estimation, guidance, control, recording, the log down to its
last byte) is timed in turns with a replay of its physics alone (``tests.bench.replay``).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import perf_counter

from inspect_cli.commands.plan import plan_loaded, vehicle_of
from inspect_cli.log.writer import LogWriter
from inspect_cli.records import CORE_RECORDS
from inspect_cli.schema.loading import Loaded
from inspect_cli.simulation.loop import Flight
from inspect_cli.truth.geometry import true_structure
from inspect_cli.vehicles.contacts import wrench_record
from tests.bench.replay import Replay
from tests.bench.rows import Row, Times

PAIRS = 5
LOG_SHARE = 0.10
END_STATE = 1e-9
"""Largest allowed difference of the replay's end from the flight's, in SI units."""


@dataclass(frozen=True)
class Timed:
    """One flight: wall-clock times of the whole and of its log, and the time that was flown."""

    wall_s: float
    log_s: float
    flight_s: float


class Pair:
    """Flies a mission, and replays the physics of its first flight."""

    def __init__(self, loaded: Loaded, folder: Path) -> None:
        self._loaded = loaded
        self._vehicle = vehicle_of(loaded)
        self._plan = plan_loaded(loaded, self._vehicle)
        self._file = folder / "flight.mcap"
        flight, log = self._flight()  # compiles every kernel, too
        self.replay = Replay(flight.plant)
        ending = flight.run()
        log.close(ending.status, ending.reason)
        self.replay.finish()

    def fly(self) -> Timed:
        """Fly once and close the log."""
        flight, log = self._flight()
        begun = perf_counter()
        ending = flight.run()
        landed = perf_counter()
        log.close(ending.status, ending.reason)
        closed = perf_counter()
        log_s = ending.log_wall_s + closed - landed
        return Timed(closed - begun, log_s, ending.flight_s)

    def _flight(self) -> tuple[Flight, LogWriter]:
        lengths = self._vehicle.capabilities.lengths
        contacts = [wrench_record(contact.name) for contact in self._vehicle.contacts]
        log = LogWriter(self._file, [*CORE_RECORDS, *contacts], lengths)
        loaded = self._loaded
        seed = loaded.mission.seeds[0]
        structure = true_structure(loaded.truth, self._plan.surfaces, loaded.root)
        estimation = loaded.mission.estimation
        flight = Flight(self._vehicle, self._plan, loaded.truth, structure, seed, log, estimation)
        return flight, log


def measure(loaded: Loaded, name: str, limit: float, pairs: int = PAIRS) -> Iterator[Row]:
    """Medians over pairs of a flight and a replay, and how true the replay is.

    A replay that ends elsewhere breaks its own row: then the ratio means nothing.
    """
    with TemporaryDirectory() as folder:
        pair = Pair(loaded, Path(folder))
        timed = [(pair.fly(), pair.replay.run_s()) for _ in range(pairs)]
        error = pair.replay.error
    ratio = median(flown.wall_s / bare_s for flown, bare_s in timed)
    times = Times(
        median(flown.wall_s for flown, _ in timed),
        median(bare_s for _, bare_s in timed),
        "s",
        f"the physics alone, {timed[0][0].flight_s:.0f} s of flight",
    )
    yield Row(f"{name}.ratio_to_open_loop", ratio, "1", limit, times=times)
    yield Row(f"{name}.replay_state_error", error, "1", END_STATE)
    share = median(flown.log_s / flown.wall_s for flown, _ in timed)
    yield Row(f"{name}.log_share", share, "1", LOG_SHARE)
