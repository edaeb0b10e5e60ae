"""Images of a scene: joint angles in, RGB out. It knows neither a log nor a film."""

from __future__ import annotations

from types import TracebackType
from typing import Any

import mujoco
import numpy as np

from inspect_cli.scene.views import View
from inspect_cli.spatial.arrays import Indices, Mask, Vector


class SceneMotion:
    """A compiled scene whose joints and marks are set frame by frame.

    Only positions are computed (``mj_kinematics`` and what lights and cameras need): a frame is
    drawn from recorded angles, so that no force and no contact matters.
    """

    def __init__(self, model: mujoco.MjModel, marks: Indices) -> None:
        """``marks`` (n,): ids of the geoms that appear and vanish."""
        self.model = model
        self.data = mujoco.MjData(model)
        self._marks = marks

    def move(self, qpos: Vector, visible: Mask) -> None:
        """Set the joints ``qpos`` (nq,) and which marks (n,) are there."""
        self.data.qpos[:] = qpos
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_comPos(self.model, self.data)
        mujoco.mj_camlight(self.model, self.data)
        self.model.geom_rgba[self._marks, 3] = visible


class FrameRenderer:
    """Renders images of one size; a context, because it holds a graphics buffer."""

    def __init__(
        self, scene: SceneMotion, size_px: tuple[int, int], shadow_px: int, *, shadows: bool = True
    ) -> None:
        """Open a buffer of ``size_px`` (width, height): one that is larger costs time.

        Args:
            scene: what is rendered.
            size_px: of the images.
            shadow_px: width and height of the shadow map.
            shadows: whether anything throws a shadow.
        """
        model = scene.model
        model.vis.global_.offwidth, model.vis.global_.offheight = size_px
        model.vis.quality.shadowsize = shadow_px
        self._scene = scene
        self._shadows = shadows
        self._renderer = mujoco.Renderer(model, height=size_px[1], width=size_px[0])

    def __enter__(self) -> FrameRenderer:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._renderer.close()

    def image(self, view: View) -> Any:
        """The scene as it stands, (height, width, 3) uint8, from a view."""
        if not self._shadows:
            self._renderer.scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = 0
        self._renderer.update_scene(self._scene.data, _camera(view))
        return self._renderer.render()


def _camera(view: View) -> mujoco.MjvCamera:
    """A free camera at the view's eye: MuJoCo wants what it looks at, distance and two angles."""
    camera = mujoco.MjvCamera()
    camera.type = mujoco.mjtCamera.mjCAMERA_FREE
    ahead = view.at_W - view.eye_W
    camera.lookat = view.at_W
    camera.distance = float(np.linalg.norm(ahead))
    camera.azimuth = float(np.degrees(np.arctan2(ahead[1], ahead[0])))
    camera.elevation = float(np.degrees(np.arcsin(ahead[2] / camera.distance)))
    return camera
