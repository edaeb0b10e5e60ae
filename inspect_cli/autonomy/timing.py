"""How long a vehicle rests between the stretches of a flight; plans count on the same times."""

from __future__ import annotations

PAUSE_S = 0.2
"""At rest at the end of each stretch before the next begins."""
SIGHT_S = 0.1
"""From then on until the next image of the depth camera, on the average."""
