"""The random disturbances of one press, drawn beforehand so that every solver gets the same."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import accumulate

import numpy as np

from fdvv.errors import ModelError
from fdvv.twin.finger import Finger, PressVariability
from fdvv.twin.gesture import Gesture
from fdvv.twin.rig import Rig
from fdvv.units import FloatArray

SETTLE_s = 0.08
"""The rig runs this long before the record starts, so that filters and the cap come to rest."""


@dataclass(frozen=True, eq=False)
class Noise:
    """Random disturbances of one press; n counts every tick, those of settling included.

    Attributes
    ----------
    position_m : (n, reads) added to each converter read of the position.
    force_N : (n,) added to each sample of the finger's force sensor.
    effort_ratio : (n,) modulation of the finger's own force at the end of a tick, linear between ticks.
    keycap : (n,) added to each sample of the cap's sensor, in proportion to its range.
    latency : (n,) of a vibration that starts in that tick, in standard deviations.
    """

    position_m: FloatArray
    force_N: FloatArray
    effort_ratio: FloatArray
    keycap: FloatArray
    latency: FloatArray

    def check(self, reads: int) -> None:
        """Raise ModelError unless every array is as long as the others."""
        n = self.force_N.size
        if self.position_m.shape != (n, reads):
            raise ModelError(f"position_m must be {(n, reads)}, got {self.position_m.shape}")
        for name in ("force_N", "effort_ratio", "keycap", "latency"):
            if getattr(self, name).shape != (n,):
                raise ModelError(f"{name} must be {(n,)}, got {getattr(self, name).shape}")

    def arrays(self) -> list[FloatArray]:
        """Return the arrays as the kernel takes them, in its order."""
        parts = (self.position_m, self.force_N, self.keycap, self.effort_ratio, self.latency)
        return [np.ascontiguousarray(part) for part in parts]


def settle_ticks(rig: Rig) -> int:
    """Count the ticks before the record starts."""
    return round(SETTLE_s / rig.controller.tick_s)


def count_ticks(rig: Rig, gesture: Gesture) -> int:
    """Count the ticks of the record."""
    return int(np.ceil(gesture.duration_s / rig.controller.tick_s))


def silence(rig: Rig, gesture: Gesture) -> Noise:
    """Return no noise at all."""
    return silent_ticks(rig, settle_ticks(rig) + count_ticks(rig, gesture))


def silent_ticks(rig: Rig, n: int) -> Noise:
    """Return no noise for n ticks."""
    return Noise(np.zeros((n, rig.position_sensor.reads)), *np.zeros((4, n)))


def draw_noise(rig: Rig, finger: Finger, gesture: Gesture, random: np.random.Generator) -> Noise:
    """Draw the noise of sensors, muscle and vibration for one press."""
    return draw_ticks(rig, finger, settle_ticks(rig) + count_ticks(rig, gesture), random)


def draw_ticks(
    rig: Rig, finger: Finger, n: int, random: np.random.Generator, effort: Effort | None = None
) -> Noise:
    """Draw the noise of n ticks.

    effort : goes on with this muscle; a new one begins if None.

    Noise of the demodulator is common to the reads of a burst (its band is far below their rate), noise
    of the converter is not.
    """
    position = rig.position_sensor
    common = position.noise_m * random.standard_normal((n, 1))
    lsb = lsb_of(position.range_m, position.converter_bits)
    single = position.converter_noise_ratio * lsb * random.standard_normal((n, position.reads))
    samples = rig.force_sensor.noise_N * random.standard_normal(n)
    muscle = (effort or Effort(finger.habit, rig.controller.tick_s)).draw(n, random)
    cap = rig.load_cell if rig.has_cell else rig.keycap_sensor
    keycap = cap.noise_ratio * random.standard_normal(n)
    return Noise(common + single, samples, muscle, keycap, random.standard_normal(n))


def lsb_of(span: float, bits: int) -> float:
    """Return one step of a converter over a span; 0 for a continuous one."""
    return span / 2**bits if bits else 0.0


class Effort:
    """Muscle noise of one pole plus a tremor of random phase, which goes on from one draw to the next."""

    def __init__(self, habit: PressVariability, tick_s: float) -> None:
        self._habit, self._tick_s = habit, tick_s
        self._last: float | None = None
        self._turns = 0.0

    def draw(self, n: int, random: np.random.Generator) -> FloatArray:
        """Return the modulation of the next n ticks, (n,)."""
        habit, first = self._habit, self._last is None
        keep = float(np.exp(-2 * np.pi * habit.effort_noise_Hz * self._tick_s))
        white = random.standard_normal(n)
        # the first sample of all is already as wide as the process, so it does not build up
        white[int(first) :] *= np.sqrt(1 - keep**2)
        slow = list(accumulate(white.tolist(), lambda past, fresh: keep * past + fresh, initial=self._last))
        if first:
            self._turns = random.random()
        turns = habit.tremor_Hz * self._tick_s * np.arange(n) + self._turns
        self._last, self._turns = slow[-1], self._turns + habit.tremor_Hz * self._tick_s * n
        slow_n = np.array(slow[-n:])
        return np.asarray(habit.effort_noise_ratio * slow_n + habit.tremor_ratio * np.sin(2 * np.pi * turns))
