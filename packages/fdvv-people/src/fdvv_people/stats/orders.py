"""Counterbalanced orders of conditions: none profits from its place."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeVar

from fdvv.errors import ModelError

Condition = TypeVar("Condition")


def williams_orders(count: int) -> tuple[tuple[int, ...], ...]:
    """Return a Williams design of count conditions: orders of 0 to count - 1 (Williams 1949).

    Every condition has every place, and follows every other, equally often. An even count needs as many
    orders, an odd one twice as many. Raises ModelError below 2.
    """
    if count < 2:
        raise ModelError(f"an order needs at least 2 conditions, got {count}")
    # 0, 1, n-1, 2, n-2, ...: the steps between neighbours are all different
    first = [(i + 1) // 2 if i % 2 else (count - i // 2) % count for i in range(count)]
    square = [tuple((place + shift) % count for place in first) for shift in range(count)]
    mirrored = [tuple(reversed(order)) for order in square] if count % 2 else []
    return tuple(square + mirrored)


def counterbalanced(conditions: Sequence[Condition], blocks: int) -> tuple[tuple[Condition, ...], ...]:
    """Return each of some blocks of trials its order of all conditions, taking Williams' orders in turn.

    With blocks a multiple of the orders everything is balanced exactly; otherwise as nearly as can be.
    """
    orders = williams_orders(len(conditions))
    return tuple(tuple(conditions[i] for i in orders[block % len(orders)]) for block in range(blocks))
