"""The world, the plant (the only mj_step), the clock and the flight loop. May read the truth."""
