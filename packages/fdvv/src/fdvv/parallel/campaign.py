"""Campaigns: work done once for every item of a plan, stored as it is done and continued after a stop.

The caller owns the store: it says which items are done already and writes the results of each chunk. A run
that was killed repeats only the chunks whose results were not stored.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

from fdvv.parallel.executor import ChunkLost, Executor, LEAST_s, chunks_of

Item = TypeVar("Item")
Result = TypeVar("Result")
Progress = Callable[[int, int], None]
"""Called with the number of items done and of all items, at the start and after every chunk."""


@dataclass(frozen=True)
class EachItem(Generic[Item, Result]):
    """The work of a chunk from that of an item; picklable if `work` is."""

    work: Callable[[Item], Result]

    def __call__(self, items: Sequence[Item]) -> list[Result]:
        return [self.work(item) for item in items]


def run_campaign(
    executor: Executor,
    work: Callable[[tuple[Item, ...]], list[Result]],
    items: Sequence[Item],
    store: Callable[[tuple[Item, ...], list[Result]], None],
    *,
    done: Callable[[Item], bool] = lambda _item: False,
    progress: Progress = lambda _done, _total: None,
    item_s: float = math.inf,
    chunk_s: float = LEAST_s,
    lost: Callable[[Item], Result] | None = None,
) -> int:
    """Work on the items that are not done, in chunks on an executor; return how many those were.

    Parameters
    ----------
    work : returns one result per item of a chunk; see Executor.run for what it may be.
    store : called with each chunk and its results, as soon as they are there and in any order.
    item_s, chunk_s : about how long an item takes, and the least that a chunk should; by default a chunk is
        one item.
    lost : result of an item that ended every process that took it; None: ChunkLost is raised.

    Raises WorkerError if work raised, and whatever store raises.
    """
    left = [item for item in items if not done(item)]
    count = len(items) - len(left)
    progress(count, len(items))
    for chunk, results in run_isolated(executor, work, chunks_of(left, item_s, chunk_s), lost):
        store(chunk, results)
        count += len(chunk)
        progress(count, len(items))
    return len(left)


def run_isolated(
    executor: Executor,
    work: Callable[[tuple[Item, ...]], list[Result]],
    chunks: Sequence[tuple[Item, ...]],
    lost: Callable[[Item], Result] | None,
) -> Iterator[tuple[tuple[Item, ...], list[Result]]]:
    """Work on chunks so that an item that ends its processes costs the others nothing; see `run_campaign`.

    A chunk that lost all its processes is taken apart, and each of its items tried alone.
    """
    waiting = list(chunks)
    while waiting:
        left, waiting = dict(enumerate(waiting)), []
        try:
            for number, results in executor.run(work, list(left.values())):
                yield left.pop(number), results
        except ChunkLost as error:
            apart = left.pop(error.number)
            if len(apart) == 1:
                if lost is None:
                    raise
                yield apart, [lost(apart[0])]
            waiting = [*left.values(), *((item,) for item in apart if len(apart) > 1)]
