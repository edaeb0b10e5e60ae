"""What a log calls the things in it that are not records."""

from __future__ import annotations

MISSION, PLATFORM, PLAN = "mission.json", "platform.json", "plan.json"
"""Attachments without which a log cannot be evaluated."""
MODE_TABLE = "modes.json"
"""Attachment: the vehicle's table of modes (``schema.modes``), which numbers in a log refer to."""
TRUTH = "truth.json"
"""Attachment of simulated flights only."""
SPECIMEN = "truth/specimen.npz"
"""Attachment of simulated flights over a specimen: ``log.rasters``."""
RUN = "run.json"
"""Attachment: ``{"seed": n, "versions": {name: version}}``."""
OUTCOME = "outcome"
"""Metadata record with ``status`` and ``reason``."""
EVENTS = "/events"
SCENE = "/scene"
