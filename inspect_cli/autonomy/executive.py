"""The mission executive: takes orders from a queue, mode by mode, and falls back by the failsafes.

It knows neither vehicle nor task: what a mode does stands in the vehicle's table
(``vehicles/<kind>/modes.py``), what a violation leads to in its failsafes. The queue begins with
the orders of the plan; whoever watches the flight may ``submit`` others.

    update:  failsafe due? ─▶ its fallback takes the place of the queue (abort, or try again)
             mode done?    ─▶ the next order whose guard lets it pass; none left: finished
"""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Sequence

from inspect_cli.autonomy.context import Context
from inspect_cli.autonomy.failsafe import Failsafe, Watch
from inspect_cli.autonomy.modes import Behaviour, Mode, Order
from inspect_cli.records import Record
from inspect_cli.schema.modes import Phase
from inspect_cli.schema.result import Status

OVERTIME = "flight took far longer than planned"


class Executive:
    """Carries out the orders of one flight."""

    def __init__(self, behaviour: Behaviour, context: Context, time_limit_s: float) -> None:
        self.context = context
        self.status: Status = "completed"
        self.reason = ""
        self.finished = False
        self._behaviour = behaviour
        self._plan_orders = tuple(behaviour.orders(context.plan))
        self._queue = deque(self._plan_orders)
        self._watch = Watch(behaviour.failsafes)
        self._time_limit_s = time_limit_s
        self._tries: Counter[str] = Counter()
        self._recovering: Failsafe | None = None
        self._to_repeat: tuple[Order, ...] = ()
        self._waiting_since_s: float | None = None

    @property
    def mode(self) -> Mode:
        """The mode that it is in."""
        return self.context.mode

    @property
    def armed(self) -> bool:
        """Whether the rotors shall turn."""
        return self.context.armed

    def hear(self, record: Record) -> None:
        """Take what the stack made of a sensor's sample, or an instrument's sample."""
        self.context.hear(record)

    def submit(self, *orders: Order) -> None:
        """Put orders in front of those that wait; the mode that runs comes to its end first.

        Raises:
            InputError: the vehicle has no such mode.
        """
        for order in orders:
            self._behaviour.mode(order.mode)
        self._queue.extendleft(reversed(orders))

    def update(self, t_s: float) -> Order | None:
        """Decide what to do now; called at the mission rate. Returns the order that was begun."""
        context = self.context
        context.refresh(t_s)
        row = self._watch.check(self.mode.name, t_s, context.inputs)
        if t_s > self._time_limit_s and self.mode.phase not in (Phase.SAFE, Phase.GROUND):
            begun = self._abort(self._behaviour.stop(context), OVERTIME)
        elif row is not None:
            begun = self._fall_back(row)
        elif self.mode.done(context):
            begun = self._advance()
        else:
            begun = None
        reference = context.stack.reference
        reference.mode = float(self.mode.number)
        index = context.order.target
        reference.target = -1.0 if index is None else float(index)
        return begun

    def give_up(self, status: Status, reason: str) -> None:
        """End the run from outside: the physics diverged, or somebody interrupted it."""
        self.status, self.reason, self.finished = status, reason, True

    def _advance(self) -> Order | None:
        """Go on to the next order; finish after the last."""
        if self._recovering is not None and not self._queue and not self._recover():
            return None
        if not self._queue:
            self.finished = True
            return None
        if self._behaviour.mode(self._queue[0].mode).guard(self.context):
            return None
        self.mode.end(self.context)
        return self._begin(self._queue.popleft())

    def _begin(self, order: Order) -> Order:
        mode = self._behaviour.mode(order.mode)
        self.context.enter(self.context.t_s, mode, order)
        mode.begin(self.context, order)
        return order

    def _fall_back(self, row: Failsafe) -> Order | None:
        """Follow a violated row: try the target again if the row allows it, or abort."""
        orders = self._runnable(row)
        interrupted = self.context.order
        if self._tries[row.name] >= row.retries or interrupted.target is None:
            return self._abort(orders, row.name)
        self._tries[row.name] += 1
        tried = f"try {self._tries[row.name]} of {row.retries}"
        self.context.note("warning", f"{row.name}; falling back, {tried}")
        self._recovering = row
        self._to_repeat = self._from_first_order_of(interrupted.target)
        return self._replace_queue(orders)

    def _recover(self) -> bool:
        """At the end of a fallback: go on if the row is clear, wait for it, or abort.

        Returns whether the executive may look at its queue.
        """
        row, context = self._recovering, self.context
        assert row is not None  # the caller saw to it
        if row.clear(context.inputs):
            self._queue.extend(self._to_repeat)
        else:
            if self._waiting_since_s is None:
                self._waiting_since_s = context.t_s
            if context.t_s - self._waiting_since_s < row.wait_s:
                return False
            self._mark_aborted(row.name)
        self._recovering, self._waiting_since_s = None, None
        return True

    def _abort(self, orders: Sequence[Order], reason: str) -> Order | None:
        self._mark_aborted(reason)
        self._recovering = None
        return self._replace_queue(orders)

    def _mark_aborted(self, reason: str) -> None:
        self.status, self.reason = "aborted", reason
        self.context.note("error", f"aborted: {reason}")
        self.context.give_up_readings()

    def _replace_queue(self, orders: Sequence[Order]) -> Order | None:
        self._waiting_since_s = None
        self._queue = deque(orders)
        return self._begin(self._queue.popleft()) if self._queue else None

    def _runnable(self, row: Failsafe) -> Sequence[Order]:
        """The orders of the mildest fallback whose modes have what they need, else the last's."""
        orders: Sequence[Order] = ()
        for fallback in row.fallbacks:
            orders = fallback(self.context)
            needs = {need for order in orders for need in self._behaviour.mode(order.mode).needs}
            if all(map(self.context.is_fresh, needs)):
                break
        return orders

    def _from_first_order_of(self, target: int) -> tuple[Order, ...]:
        for place, order in enumerate(self._plan_orders):
            if order.target == target:
                return self._plan_orders[place:]
        return ()
