"""What a flight leaves behind: which records go into the log, and how often."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from time import perf_counter

from inspect_cli.autonomy.context import Context
from inspect_cli.interfaces import FlightStack
from inspect_cli.log.writer import LogWriter
from inspect_cli.records import (
    DepthImage,
    Imu,
    Record,
    State,
    SurfaceEstimate,
    TrueDisturbance,
)
from inspect_cli.spatial.arrays import Matrix, Vector

POSE_S = 0.1
"""Between the poses that viewers draw."""
CLOUD_S = 1.0
"""Between the depth images that are kept."""


class Recorder:
    """Writes the rows of one flight and keeps the wall-clock time that takes."""

    def __init__(
        self,
        log: LogWriter,
        state: State,
        contacts: tuple[Record, ...],
        stack: FlightStack,
        inertial: Sequence[Imu],
        disturbance: TrueDisturbance | None,
    ) -> None:
        self._log = log
        self._computed: tuple[Record, ...] = (stack.reference, stack.estimate, stack.command)
        if disturbance is not None:
            self._computed += (disturbance,)
        continuous = (state, *contacts, *self._computed, *inertial)
        self._copy_rows = log.tap(continuous)
        self._times = [record.views["t_s"] for record in self._computed]
        self._poses = {
            "/pose/estimate": (stack.estimate.p_WB, stack.estimate.q_WB),
            "/pose/reference": (stack.reference.p_WB, stack.reference.q_WB),
            "/truth/pose": (state.p_WB, state.q_WB),
        }
        self._next_pose_s = 0.0
        self._next_cloud_s = 0.0
        self.wall_s = 0.0
        """Time spent on the log."""

    def rows(self, t_s: float) -> None:
        """Log one row of every continuous channel, all with the same time."""
        begun = perf_counter()
        for time in self._times:
            time[0] = t_s
        self._copy_rows()
        if t_s >= self._next_pose_s:
            self._next_pose_s += POSE_S
            for topic, (p, q) in self._poses.items():
                self._log.pose(topic, t_s, p, q)
        self._log.flush_due(t_s)
        self.wall_s += perf_counter() - begun

    def row(self, record: Record) -> None:
        """Log one row of a channel with a rate of its own."""
        begun = perf_counter()
        self._log.log(record)
        self.wall_s += perf_counter() - begun

    def surface(
        self,
        surface: SurfaceEstimate,
        image: DepthImage,
        camera: Callable[[], tuple[Vector, Matrix]],
    ) -> None:
        """Log a surface estimate, and once a second the depth points behind it.

        ``camera`` returns (p_WD, R_WD), where the camera is believed to be.
        """
        begun = perf_counter()
        self._log.log(surface)
        if surface.t_s >= self._next_cloud_s:
            self._next_cloud_s += CLOUD_S
            p_WD, R_WD = camera()
            self._log.point_cloud("/tof/points", surface.t_s, p_WD + image.points_D @ R_WD.T)
        self.wall_s += perf_counter() - begun

    def decisions(self, context: Context) -> None:
        """Log the readings and events since the last call."""
        if not context.readings and not context.events:
            return
        begun = perf_counter()
        for reading in context.readings:
            self._log.log(reading)
        for event in context.events:
            self._log.event(event.t_s, event.level, event.text)
        context.readings.clear()
        context.events.clear()
        self.wall_s += perf_counter() - begun
