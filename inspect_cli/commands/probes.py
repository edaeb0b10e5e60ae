"""What ``inspect doctor`` tries, each in a process of its own so that a crash is a finding.

    python -m inspect_cli.commands.probes NAME

prints what was found, or ends with an exception.
"""

from __future__ import annotations

import os
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

PHYSICS_STEPS = 20_000

FALLING_BOX = """
<mujoco>
  <option timestep="0.001"/>
  <worldbody>
    <light pos="0 0 3"/>
    <geom type="plane" size="1 1 0.1" rgba="0.3 0.6 0.3 1"/>
    <body pos="0 0 0.3">
      <freejoint/>
      <geom type="box" size="0.1 0.1 0.1" rgba="0.8 0.2 0.2 1"/>
    </body>
  </worldbody>
</mujoco>
"""


def kernels() -> str:
    """Compile and run a kernel, and see that its machine code can be kept."""
    from inspect_cli.spatial.rotations import cross

    begin = time.perf_counter()
    product = cross(np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]))
    took = time.perf_counter() - begin
    if not np.array_equal(product, [0.0, 0.0, 1.0]):
        raise RuntimeError(f"a compiled cross product gave {product}")
    stats = getattr(cross, "stats", None)
    if stats is None:
        return "compilation is switched off: the same code runs as plain Python, slowly"
    if not os.access(stats.cache_path, os.W_OK):
        raise RuntimeError(f"the cache {stats.cache_path} cannot be written")
    return f"ready in {took:.2f} s, kept in {stats.cache_path}"


def physics() -> str:
    """Time the physics steps of a box that falls on a plane."""
    import mujoco

    model = mujoco.MjModel.from_xml_string(FALLING_BOX)
    data = mujoco.MjData(model)
    begin = time.perf_counter()
    mujoco.mj_step(model, data, PHYSICS_STEPS)
    step_us = (time.perf_counter() - begin) / PHYSICS_STEPS * 1e6
    height = float(data.qpos[2])
    if not abs(height - 0.1) < 0.01:
        raise RuntimeError(f"a box of 0.1 m half height came to rest at {height:.3f} m")
    return f"{step_us:.1f} µs per step, {1000.0 / step_us:.0f} times real time at 1 kHz"


def rendering() -> str:
    """Render one frame without a screen, and see that a film of it could be encoded."""
    import av
    import mujoco

    model = mujoco.MjModel.from_xml_string(FALLING_BOX)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    with mujoco.Renderer(model, height=48, width=64) as renderer:
        renderer.update_scene(data)
        image = renderer.render()
    if image.max() == 0:
        raise RuntimeError("the frame is black")
    av.CodecContext.create("libx264", "w")
    return (
        f"a frame of {image.shape[1]} × {image.shape[0]}, {os.environ.get('MUJOCO_GL', '')}; H.264"
    )


def clouds() -> str:
    """Write a small cloud and read it back."""
    from inspect_cli.scans.clouds import read_cloud

    points = np.random.default_rng(0).normal(size=(100, 3)).astype(np.float32)
    header = f"ply\nformat ascii 1.0\nelement vertex {len(points)}\n"
    header += "property float x\nproperty float y\nproperty float z\nend_header\n"
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "cloud.ply"
        file.write_text(header + "\n".join(" ".join(map(repr, p)) for p in points.tolist()) + "\n")
        read = read_cloud(file).points
    if not np.allclose(read, points, rtol=0.0, atol=1e-6):
        raise RuntimeError("a cloud came back different from what was written")
    return f"{len(read)} points of a PLY file"


def logs() -> str:
    """Write a small log and read it back."""
    from inspect_cli.log.reader import read_log
    from inspect_cli.log.writer import LogWriter
    from inspect_cli.records import NO_LENGTHS, Pose

    pose = Pose.create(NO_LENGTHS)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "flight.mcap"
        with LogWriter(file, (Pose,), NO_LENGTHS) as log:
            for tick in range(100):
                pose.t_s = 0.01 * tick
                log.log(pose)
            log.close("completed", "")
        rows = read_log(file).rows(Pose)
    if rows is None or not np.allclose(rows["t_s"], 0.01 * np.arange(100)):
        raise RuntimeError("a log came back different from what was written")
    return f"{len(rows)} rows of an MCAP file"


PROBES: dict[str, Callable[[], str]] = {
    "kernels": kernels,
    "physics": physics,
    "rendering": rendering,
    "clouds": clouds,
    "logs": logs,
}

if __name__ == "__main__":
    sys.stdout.write(PROBES[sys.argv[1]]())
