"""Why rows of the bench fall short of their limits: where the time goes, by row.

A text is shown only while its row is broken. Times are wall-clock µs per control tick (four steps
of physics), without the slowest percent of each part's calls; the clocks around the parts are in
the total.
"""

from __future__ import annotations

PROFILES: dict[str, str] = {
    "flight.ratio_to_open_loop": (
        "150 µs a tick: steps 50; control and reference 15, depth image and surface 14, log rows "
        "7, executive and surroundings 7, observing the state 6, filter's prediction 5, pose and "
        "its correction 5, probe 5, truth at the tip 3, correcting the approach 3, IMU 2, "
        "commands 2, wrenches on contacts 2: some fifteen small calls"
    ),
    "vault.ratio_to_open_loop": (
        "139 µs a tick: steps 52 with placing plates; depth image and surface 16, control and "
        "reference 13, executive and surroundings 7, observing the state 6, log rows 6, filter's "
        "prediction 5, correcting the approach 3, IMU 2, truth at the tip 2, commands 2, odometry"
        " and its correction 2, wrenches on contacts 1"
    ),
    "uneven_vault.ratio_to_open_loop": (
        "189 µs a tick: steps 66 with placing plates; depth image and surface 43, of which "
        "casting its rays 37; executive and surroundings 15, control and reference 13, observing "
        "the state 8, log rows 6, filter's prediction 4, truth at the tip 4, IMU 2, correcting "
        "the approach 2, commands 2, odometry and its correction 2, wrenches on contacts 1"
    ),
}
