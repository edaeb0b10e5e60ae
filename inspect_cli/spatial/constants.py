"""Numbers of the surroundings that several rooms share."""

from __future__ import annotations

from typing import Final

GRAVITY_MPS2: Final = 9.81
"""Standard value of MuJoCo's models; acts along −z_W."""
AIR_DENSITY_KGPM3: Final = 1.225
"""International standard atmosphere at sea level."""
