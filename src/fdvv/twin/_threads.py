"""Many presses at once: the compiled ones release the interpreter, so threads use every core."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from typing import TypeVar

AHEAD = 4
"""Presses under way or waiting per thread, so that memory does not grow with their number."""

Plan = TypeVar("Plan")
Result = TypeVar("Result")


def in_threads(one: Callable[[Plan], Result], plans: Iterable[Plan], threads: int = 2) -> Iterator[Result]:
    """Call a function on each of many plans in a pool of threads; give what it gives, in order, one by one.

    Only a few are under way or waiting at a time. An error of one call is raised where its result would be.
    """
    from concurrent.futures import Future, ThreadPoolExecutor

    waiting: deque[Future[Result]] = deque()
    with ThreadPoolExecutor(threads) as pool:
        for plan in plans:
            waiting.append(pool.submit(one, plan))
            if len(waiting) > AHEAD * threads:
                yield waiting.popleft().result()
        while waiting:
            yield waiting.popleft().result()
