"""Many presses on the rig at once."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from fdvv.protocol import Settings
from fdvv.twin._finger import Finger
from fdvv.twin._gesture import Gesture
from fdvv.twin._noise import Noise
from fdvv.twin._rig import Rig
from fdvv.twin._simulate import simulate_program
from fdvv.twin._threads import in_threads
from fdvv.twin._trace import Trace


@dataclass(frozen=True, eq=False)
class RigPress:
    """One press to simulate; image and settings are what the firmware holds (settings_of(rig) if None)."""

    rig: Rig
    finger: Finger
    gesture: Gesture
    image: bytes
    noise: Noise
    announced_mm_s: float
    settings: Settings | None = None

    def simulate(self) -> Trace:
        """Simulate it."""
        return simulate_program(
            self.rig,
            self.finger,
            self.gesture,
            self.image,
            self.noise,
            self.announced_mm_s,
            settings=self.settings,
        )


def simulate_rig_batch(presses: Iterable[RigPress], threads: int = 2) -> Iterator[Trace]:
    """Simulate many presses on the rig, as they are asked for; give them in the order of presses."""
    return in_threads(RigPress.simulate, presses, threads)
