"""What fully actuated vehicles share: flight stack, modes and failsafes of paper A.

They hold any pose in free air, so that attitude is commanded, and a press is a set-point behind
the surface. A kind of platform adds its model, its capabilities and its allocation.
"""

from inspect_cli.autonomy.modes import Behaviour
from inspect_cli.vehicles.fully_actuated.failsafes import FAILSAFES
from inspect_cli.vehicles.fully_actuated.modes import MODES, context_of, orders_of, stop

BEHAVIOUR = Behaviour(
    modes=MODES,
    failsafes=FAILSAFES,
    first="idle",
    orders=orders_of,
    stop=stop,
    context=context_of,
)
