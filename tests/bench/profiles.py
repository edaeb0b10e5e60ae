"""Why rows of the bench fall short of their limits: where the time goes, by row.

A text is shown only while its row is broken. Shares are of a flight's wall-clock time, the clocks
around the parts included; a control tick has four steps of physics.
"""

from __future__ import annotations

LOG = (
    "every 0.48 s of flight a chunk of 90 kB is written in 0.76 ms: compression 0.13, the file and "
    "its checksum 0.11, indices of messages 0.05, the rest the content's checksum and some two "
    "hundred small calls. The log takes what it took when a flight took 1.4 times as long"
)

PROFILES: dict[str, str] = {
    "flight.ratio_to_open_loop": (
        "steps and reading the state 45 %, depth image and surface 9, log 9, control and reference "
        "6, executive and surroundings 5, pose and its correction 5, probe 4, IMU and the filter's "
        "prediction 4, truth at the tip and wrenches 4, correcting the approach 2, commands 2, the "
        "loop itself 5. A third of the depth image is the noise of its 3072 pixels. What is no "
        "step is some twelve calls from Python per tick, each with a cold cache after the steps"
    ),
    "vault.ratio_to_open_loop": (
        "steps with placing plates and reading the state 48 %, depth image and surface 11, log 9, "
        "control and reference 6, IMU and the filter's prediction 5, executive and surroundings 4, "
        "truth at the tip and wrenches 4, correcting the approach 3, commands 2, odometry and its "
        "correction 2, the loop itself 5"
    ),
    "uneven_vault.ratio_to_open_loop": (
        "steps with placing plates and reading the state 47 %, depth image and surface 16, "
        "executive and surroundings 9, half of it the distances of twelve rotors from the relief, "
        "log 7, control and reference 4, IMU and the filter's prediction 3, truth "
        "at the tip and wrenches 3, commands 2, correcting the approach 2, odometry and its "
        "correction 2, the loop itself 3"
    ),
    "flight.log_share": LOG,
    "vault.log_share": LOG,
    "uneven_vault.log_share": LOG,
    "compile.first_run_over_kernel": (
        "119 compilations of 0.05 s to 4 s; the filter's two kernels 7.5 s, cutting cells 2.7, the "
        "local plane 2.4, checking limits 2.1, all others below 2. Of 40 s a third is LLVM's, the "
        "rest Numba's own inference and lowering in Python"
    ),
}
