"""Colours and textures of a rendered scene."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np

Rgba = tuple[float, float, float, float]

CONCRETE: Rgba = (0.80, 0.785, 0.76, 1.0)
HULL: Rgba = (0.90, 0.91, 0.92, 1.0)
BOOM: Rgba = (0.16, 0.18, 0.21, 1.0)
FRONT: Rgba = (0.0, 0.447, 0.698, 1.0)
"""Booms on the tool's side, and the tip."""
ROTOR: Rgba = (0.22, 0.25, 0.29, 1.0)
"""The ring around a rotor."""
BLADE: Rgba = (0.10, 0.11, 0.13, 1.0)
TOOL: Rgba = (0.30, 0.32, 0.35, 1.0)
PLANNED: Rgba = (0.35, 0.37, 0.40, 1.0)
"""Points that are still to be touched."""
TRACE: Rgba = (0.12, 0.14, 0.16, 1.0)
"""Where the tool slid."""
INVISIBLE: Rgba = (0.0, 0.0, 0.0, 0.0)

HORIZON = (0.90, 0.915, 0.93)
ZENITH = (0.97, 0.98, 0.99)
GLOW = 4.0
DIMMED = 1.0 / (GLOW + 0.8)
"""A surface of colour c under light l shows c (GLOW + l): with l from 0.5 to 1.1, and c dimmed
so, a mark comes out within 6 % of its colour."""
TILE_PX = 256
CONCRETE_TILE_M = 1.0
CONCRETE_SEED = 1
"""The grain is a drawing, not a measurement: always the same."""


def add_materials(spec: mujoco.MjSpec) -> None:
    """Sky, concrete and floor: textures and materials by the names 'concrete' and 'floor'."""
    spec.add_texture(
        name="sky",
        type=mujoco.mjtTexture.mjTEXTURE_SKYBOX,
        builtin=mujoco.mjtBuiltin.mjBUILTIN_GRADIENT,
        rgb1=list(ZENITH),
        rgb2=list(HORIZON),
        width=128,
        height=128 * 6,
    )
    _add_glow(spec)
    _add_material(spec, "concrete", _concrete(), in_metres=False)
    _add_material(spec, "floor", _floor(), in_metres=True)


def _add_glow(spec: mujoco.MjSpec) -> None:
    """A glowing material for marks: their colour has a meaning and must not depend on light."""
    material = spec.add_material(name="mark")
    material.emission, material.specular, material.shininess = GLOW, 0.0, 0.0


def _add_material(spec: mujoco.MjSpec, name: str, image: Any, in_metres: bool) -> None:
    texture = spec.add_texture(
        name=name,
        type=mujoco.mjtTexture.mjTEXTURE_2D,
        width=image.shape[1],
        height=image.shape[0],
        nchannel=3,
    )
    texture.data = image.tobytes()
    """``in_metres``: a tile is a metre wide; else the mesh says where the texture lies."""
    material = spec.add_material(name=name, texrepeat=[1.0, 1.0], texuniform=in_metres)
    material.specular, material.shininess = 0.05, 0.1
    material.emission = 0.12 if in_metres else 0.0
    roles = material.textures
    roles[mujoco.mjtTextureRole.mjTEXROLE_RGB] = name
    material.textures = roles


def _concrete() -> Any:
    """A tile that repeats without seams: noise whose amplitude falls as 1/f, and a faint joint."""
    rng = np.random.default_rng(CONCRETE_SEED)
    f = np.hypot(np.fft.fftfreq(TILE_PX)[:, None], np.fft.fftfreq(TILE_PX)[None, :]) * TILE_PX
    phase = np.exp(2j * np.pi * rng.random((TILE_PX, TILE_PX)))
    noise = np.fft.ifft2(phase / np.maximum(f, 2.0) ** 1.2).real
    grey = 240.0 + 4.0 * noise / noise.std()
    grey[:1, :] -= 22.0
    grey[:, :1] -= 22.0
    return _grey_image(grey)


def _floor() -> Any:
    """A tile of one metre with fine lines along its edges."""
    grey = np.full((TILE_PX, TILE_PX), 246.0)
    grey[:3, :] = grey[:, :3] = 222.0
    return _grey_image(grey)


def _grey_image(grey: Any) -> Any:
    levels = np.clip(np.rint(grey), 0, 255).astype(np.uint8)
    return np.repeat(levels[:, :, None], 3, axis=2)
