"""Many presses at once: the compiled ones release the interpreter, so threads use every core."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import TypeVar

from fdvv.twin._finger import Finger
from fdvv.twin._gesture import Gesture
from fdvv.twin._noise import Noise
from fdvv.twin._rig import Rig
from fdvv.twin._simulate import simulate_program
from fdvv.twin._trace import Trace

AHEAD = 4
"""Presses under way or waiting per thread, so that memory does not grow with their number."""

Plan = TypeVar("Plan")
Result = TypeVar("Result")


@dataclass(frozen=True, eq=False)
class RigPress:
    """One press to simulate; image is a program as the firmware holds it (image_of)."""

    rig: Rig
    finger: Finger
    gesture: Gesture
    image: bytes
    noise: Noise
    announced_mm_s: float

    def simulate(self) -> Trace:
        """Simulate it."""
        return simulate_program(
            self.rig, self.finger, self.gesture, self.image, self.noise, self.announced_mm_s
        )


def simulate_rig_batch(presses: Iterable[RigPress], threads: int = 2) -> Iterator[Trace]:
    """Simulate many presses on the rig, as they are asked for; give them in the order of presses."""
    return in_threads(RigPress.simulate, presses, threads)


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
