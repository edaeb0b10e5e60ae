"""Times that every flight spends waiting: the executive waits them, the planner counts them."""

PAUSE_S = 0.2
"""At rest at the end of each stretch before the next begins."""
SIGHT_S = 0.1
"""From then on until the next image of the depth camera, on the average."""
