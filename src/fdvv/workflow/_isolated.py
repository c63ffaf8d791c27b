"""Chunks of items of which one may end every process that takes it: it costs the others nothing."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TypeVar

from fdvv.workflow._executor import ChunkLost, Executor

Item = TypeVar("Item")
Found = TypeVar("Found")
DEADLY = "every process that took it ended before it was done; look for a lack of memory"


def run_isolated(
    executor: Executor,
    work: Callable[[tuple[Item, ...]], list[Found]],
    chunks: Sequence[tuple[Item, ...]],
    deadly: Callable[[Item], Found],
) -> Iterator[list[Found]]:
    """Work on chunks of items, one result for each; give the results of every chunk as it is done.

    A chunk that lost all its processes is taken apart; deadly gives the result of an item that did it alone.
    Raises WorkerError if work raised anything.
    """
    waiting = list(chunks)
    while waiting:
        left, waiting = dict(enumerate(waiting)), []
        try:
            for number, found in executor.run(work, list(left.values())):
                del left[number]
                yield found
        except ChunkLost as lost:
            apart = left.pop(lost.number)
            if len(apart) == 1:
                yield [deadly(apart[0])]
            waiting = [*left.values(), *((item,) for item in apart if len(apart) > 1)]
