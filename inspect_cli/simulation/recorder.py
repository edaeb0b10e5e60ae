"""What a flight leaves behind: which records go into the log, and how often."""

from __future__ import annotations

from time import perf_counter

from inspect_cli.autonomy.executive import Executive
from inspect_cli.interfaces import FlightStack
from inspect_cli.log.writer import LogWriter
from inspect_cli.records import Record, Reference, State, SurfaceEstimate, TrueContact
from inspect_cli.simulation.instruments import Instruments
from inspect_cli.spatial.types import Matrix, Points, Vector


class Recorder:
    """Writes the rows of one flight and keeps the wall-clock time that takes."""

    def __init__(self, log: LogWriter) -> None:
        self._log = log
        self._next_pose_s = 0.0
        self._next_cloud_s = 0.0
        self.wall_s = 0.0
        """Time spent on the log."""

    def rows(
        self,
        t_s: float,
        state: State,
        contact: TrueContact,
        reference: Reference,
        stack: FlightStack,
        instruments: Instruments,
    ) -> None:
        """Log one row of every continuous channel, all with the same time."""
        begun = perf_counter()
        log = self._log
        for record in (state, contact, reference, stack.estimate, stack.command):
            record.t_s = t_s
            log.log(record)
        log.log(instruments.imu.measurement)
        if t_s >= self._next_pose_s:
            self._next_pose_s += 0.1
            log.pose("/pose/estimate", t_s, stack.estimate.p_WB, stack.estimate.q_WB)
            log.pose("/pose/reference", t_s, reference.p_WB, reference.q_WB)
            log.pose("/truth/pose", t_s, state.p_WB, state.q_WB)
        log.flush_due(t_s)
        self.wall_s += perf_counter() - begun

    def row(self, record: Record) -> None:
        """Log one row of a channel with a rate of its own."""
        begun = perf_counter()
        self._log.log(record)
        self.wall_s += perf_counter() - begun

    def surface(
        self, surface: SurfaceEstimate, points_D: Points, p_WD: Vector, R_WD: Matrix
    ) -> None:
        """Log a surface estimate, and once a second the depth points behind it."""
        begun = perf_counter()
        self._log.log(surface)
        if surface.t_s >= self._next_cloud_s:
            self._next_cloud_s += 1.0
            self._log.point_cloud("/tof/points", surface.t_s, p_WD + points_D @ R_WD.T)
        self.wall_s += perf_counter() - begun

    def decisions(self, executive: Executive) -> None:
        """Log the executive's readings and events since the last call."""
        if not executive.readings and not executive.events:
            return
        begun = perf_counter()
        for reading in executive.readings:
            self._log.log(reading)
        for event in executive.events:
            self._log.event(event.t_s, event.level, event.text)
        executive.readings.clear()
        executive.events.clear()
        self.wall_s += perf_counter() - begun
