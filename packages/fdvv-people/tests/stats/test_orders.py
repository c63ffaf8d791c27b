from __future__ import annotations

from collections import Counter
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv.errors import ModelError
from fdvv_people.stats.orders import counterbalanced, williams_orders


@given(st.integers(2, 12))
def test_every_condition_stands_everywhere_and_follows_every_other_equally_often(count: int) -> None:
    orders = williams_orders(count)
    assert len(orders) == (count if count % 2 == 0 else 2 * count)
    assert all(sorted(order) == list(range(count)) for order in orders)
    places = Counter((place, one) for order in orders for place, one in enumerate(order))
    follows = Counter(pair for order in orders for pair in pairwise(order))
    assert len(places) == count**2
    assert len(set(places.values())) == 1
    assert len(follows) == count * (count - 1)
    assert len(set(follows.values())) == 1


def test_blocks_take_the_orders_in_turn() -> None:
    blocks = counterbalanced("abcdef", 40)
    assert blocks[:6] == blocks[6:12]
    places = Counter((place, one) for block in blocks for place, one in enumerate(block))
    assert set(places.values()) <= {6, 7}


def test_one_condition_has_no_order() -> None:
    with pytest.raises(ModelError, match="at least 2"):
        williams_orders(1)
