"""The flight stack of a fully actuated vehicle: it sees the surface, follows and controls a pose.

IMU, pose ─▶ estimate ─────────────────────────────────────────────▶ impedance control ─▶ command
depth image ─▶ local surface ─▶ normal-tracking pursuit ─▶ reference ─────────╯

One estimator and one controller serve all modes.
"""

from __future__ import annotations

from collections.abc import Mapping

from inspect_cli.compiled import Bound
from inspect_cli.compiled.joined import joined
from inspect_cli.guidance.local_surface import LocalSurface
from inspect_cli.guidance.pursuit import Pursuit
from inspect_cli.interfaces import TOOL, Capabilities, Posture
from inspect_cli.records import DepthImage, Imu, Pose, Record, SurfaceEstimate
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.primitives import primitive_of
from inspect_cli.schema.vehicle import DepthCameraModel, PlatformBase
from inspect_cli.spatial.arrays import Matrix, Vector
from inspect_cli.spatial.mounting import Mounting
from inspect_cli.vehicles.fully_actuated.impedance_control import ImpedanceControl


class FullyActuatedStack:
    """Impedance control of a vehicle behind a pursuit that tracks the surface which is seen."""

    def __init__(
        self,
        platform: PlatformBase,
        capabilities: Capabilities,
        controller: ImpedanceControl,
        plan: Plan,
    ) -> None:
        believed = {surface.name: primitive_of(surface.shape) for surface in plan.surfaces}
        self.guidance = Pursuit(capabilities, plan.start.posture, believed)
        self.reference = self.guidance.reference
        self.estimate, self.command = controller.estimate, controller.command
        self.armed = False
        self.loops: Mapping[str, int] = {"guidance": platform.rates.guidance_hz}
        self.surface = SurfaceEstimate.create()
        self._controller = controller
        self._control = joined(self.guidance.evaluate, *controller.bind(self.reference))
        self._capabilities = capabilities
        camera = platform.sensor(DepthCameraModel)
        self._mounting = Mounting(camera.mount)
        self._local_surface = LocalSurface(camera)
        self._neighbourhood_m = camera.neighbourhood_m

    def start(self, pose: Pose) -> None:
        """Begin at rest at a measured pose."""
        self._controller.start(pose)

    def propagation(self, imu: Imu) -> Bound:
        """The propagation of the estimate by the samples of an inertial unit."""
        return self._controller.propagation(imu)

    def hear(self, sample: Record | DepthImage) -> Record | None:
        """Correct the estimate, or see the surface; the rest passes."""
        if isinstance(sample, Pose):
            return sample if self._controller.correct(sample) else None
        if isinstance(sample, DepthImage):
            return self._see(sample)
        return sample

    def enter(self, t_s: float, mode: str, target: int | None) -> None:
        """Nothing changes: one estimator and one controller serve all modes."""

    def run(self, loop: str, t_s: float) -> None:
        """Let the surface that is seen correct the reference."""
        self.guidance.track(t_s, self.surface)

    def refer(self, t_s: float) -> None:
        """Write the reference of the instant."""
        self.guidance.write(t_s)

    def control(self, t_s: float) -> None:
        """Write the reference of the instant and the command that follows it."""
        self.guidance.prepare(t_s)
        if self._controller.prepare(self.reference, self.armed):
            self._control()
        else:
            self.guidance.evaluate()

    def believed(self, frame: str) -> tuple[Vector, Matrix]:
        """(p, R) in W of ``tool``, or of the depth camera by any other name.

        By the estimate, with the arm where it was asked to be.
        """
        estimate, arm_angle = self.estimate, self.reference.arm_angle
        posture = Posture(estimate.p_WB, estimate.q_WB, arm_angle)
        p_WT, R_WT = self._capabilities.frame_pose(posture, TOOL)
        if frame == "tool":
            return p_WT, R_WT
        return self._mounting.pose(estimate.p_WB, estimate.q_WB, p_WT, R_WT)

    def _see(self, image: DepthImage) -> SurfaceEstimate:
        """The surface that a depth image shows; one record, overwritten with each image."""
        p_WT, R_WT = self.believed("tool")
        estimate = self.estimate
        p_WD, R_WD = self._mounting.pose(estimate.p_WB, estimate.q_WB, p_WT, R_WT)
        tip_D, axis_D = R_WD.T @ (p_WT - p_WD), R_WD.T @ R_WT[:, 2]
        points_D = image.pixels.near(tip_D, axis_D, self._neighbourhood_m)
        along_T = points_D if R_WD is R_WT else points_D @ (R_WT.T @ R_WD).T
        self._local_surface.update(along_T, p_WD, p_WT, R_WT, self.surface)
        self.surface.t_s = image.t_s
        return self.surface
