"""Why rows of the bench fall short of their limits: where the time goes, by row.

A text is shown only while its row is broken.
"""

from __future__ import annotations

PROFILES: dict[str, str] = {}
