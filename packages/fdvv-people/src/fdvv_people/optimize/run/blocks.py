"""The end of a run: blocks in which start, recommended design and rivals are each played once, blind."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from fdvv_people.optimize.problem import Trial
from fdvv_people.optimize.run.rivals import Rival
from fdvv_people.stats.orders import williams_orders

Design = dict[str, float]


@dataclass(frozen=True)
class Played:
    """What a trial of the end plays: a design of the space, or the rival of this name."""

    design: Design
    rival: str = ""


def played_in_block(start: Design, found: Design, rivals: Sequence[Rival]) -> tuple[Played, ...]:
    """Return what a block has, each once: a rival that is the start, and a start that is found, come once."""
    own = (start,) if found == start else (start, found)
    beside = (Played(one.design or {}, one.name) for one in rivals if one.design != start)
    return (*map(Played, own), *beside)


def in_drawn_order(played: Sequence[Played], seed: int, block: int) -> tuple[Played, ...]:
    """Return the order of a block: who plays does not know what comes when.

    Of two, every two blocks have both orders. Of more, Williams' orders are taken in turn over a drawn
    numbering, so each has every place equally often.
    """
    if len(played) == 2:
        turned = bool(np.random.default_rng([seed, block // 2, 1]).integers(2)) != bool(block % 2)
        return (played[1], played[0]) if turned else (played[0], played[1])
    orders = williams_orders(len(played))
    numbered = np.random.default_rng([seed, block // len(orders), 2]).permutation(len(played))
    return tuple(played[numbered[place]] for place in orders[block % len(orders)])


@dataclass(frozen=True)
class Block:
    """The trials of one whole block, done or failed.

    Attributes
    ----------
    start, found : of both designs; the same trial where the start is recommended. rivals : by name.
    """

    start: Trial
    found: Trial
    rivals: Mapping[str, Trial] = field(default_factory=dict)


def blocks_of(trials: Sequence[Trial], start: Design | None, size: int) -> tuple[Block, ...]:
    """Sort the trials of the end into blocks of a size; one that is not whole is left out."""
    found = []
    for first in range(0, len(trials) - size + 1, size) if size else ():
        block = trials[first : first + size]
        own = [one for one in block if not one.rival]
        before = next(one for one in own if one.design == start)
        after = next((one for one in own if one.design != start), before)
        found.append(Block(before, after, {one.rival: one for one in block if one.rival}))
    return tuple(found)
