"""Why rows of the bench fall short of their limits: where the time goes, by row.

A text is shown only while its row is broken. Times are CPU µs per control tick (four steps of
physics), with clocks around each part that add about 1 µs to it.
"""

from __future__ import annotations

PROFILES: dict[str, str] = {
    "flight.ratio_to_open_loop": (
        "348 µs a tick: steps 81; pose correction 27, control 26, probe 24, executive 24, "
        "filter's prediction 19, observing the state 19, log rows 17, depth image and surface 23, "
        "sampling the IMU 15, reference 14, surroundings 8, commands 6: some fifteen small calls"
    ),
    "vault.ratio_to_open_loop": (
        "392 µs a tick: steps 111, of which placing plates 18; control 33, observing the state "
        "30, executive 25, filter's prediction 24, log rows 19, pose correction 18, sampling the "
        "IMU 16, reference 15, depth image and surface 26, surroundings 10, commands 6"
    ),
    "uneven_vault.ratio_to_open_loop": (
        "586 µs a tick: steps 175, of which placing plates 40; depth image and surface 64, control "
        "43, observing the state 42, executive 41, filter's prediction 31, surroundings 27, "
        "sampling the IMU 21, pose correction 21, log rows 20, reference 19, commands 7"
    ),
}
