"""A cap on a path, and a person who presses it at exactly the asked speed, for boards in lockstep."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fdvv.device.plant import Inputs
from fdvv.model.press import Press
from fdvv.protocol.messages import CN64_PER_cN, UM16_PER_mm, travel_mm_of
from fdvv.protocol.tables import Settings
from fdvv.units import FloatArray

Meddle = Callable[[int, Inputs], Inputs]
"""Changes what the board reads in a tick: a broken wire, a low supply, a missed tick."""


class ScriptedPlant:
    """A cap on a path; the rendered force is that of the duty. `record` has one row per tick.

    Parameters
    ----------
    path_mm : (n,) displacement at each tick; the last one holds on.
    settings : of the board, for the converter's scale and the duty's.
    noise_counts : largest deviation of the sum of readings, so that the sensor is not stuck.
    meddle : changes readings on their way to the board.
    """

    def __init__(
        self,
        path_mm: FloatArray,
        velocity_mm_s: float,
        settings: Settings,
        random: np.random.Generator,
        noise_counts: int = 8,
        meddle: Meddle | None = None,
    ) -> None:
        self._path_mm, self._velocity_mm_s, self._settings = path_mm, velocity_mm_s, settings
        self.meddle = meddle
        self._noise = random.integers(-noise_counts, noise_counts + 1, 1024)
        self._tick = 0
        self._rendered_cN: list[float] = []

    @property
    def ticks(self) -> int:
        return self._path_mm.size

    def step(self, duty_q15: int, enable: int, stop_us: int, slot: int) -> Inputs:
        rendered = duty_q15 * 65536 / self._settings.duty_gain_q16 / CN64_PER_cN if enable else 0.0
        self._rendered_cN.append(rendered)
        x_um16 = UM16_PER_mm * float(self._path_mm[min(self._tick, self.ticks - 1)])
        scale = self._settings.position_gain_q14 / 2**14
        total = round((x_um16 - self._settings.position_offset_um16) / scale)
        total += int(self._noise[self._tick % self._noise.size])
        mean = total // self._settings.reads
        inputs = Inputs(0, total, mean, mean + 1, supply_mV=self._settings.nominal_supply_mV)
        inputs = self.meddle(self._tick, inputs) if self.meddle else inputs
        self._tick += 1
        return inputs

    def record(self) -> Press:
        n = self._tick
        path = self._path_mm[np.minimum(np.arange(n), self.ticks - 1)]
        t_s = np.arange(n, dtype=np.float64) * (self._settings.tick_us * 1e-6)
        force = np.array(self._rendered_cN, dtype=np.float64)
        every = np.ones(n, dtype=np.bool_)
        return Press(t_s, path, force, self._velocity_mm_s, tick=every, simulated=True)


class ScriptedPerson:
    """Presses at exactly the asked speed: down, 20 ms at the stop, up, 40 ms of rest.

    Parameters
    ----------
    seed : of the sensor's noise.
    meddle : what goes wrong during presses, by tick of the press.
    settings : of the board.
    """

    def __init__(self, seed: int = 0, meddle: Meddle | None = None, settings: Settings | None = None) -> None:
        self._random = np.random.default_rng(seed)
        self.meddle = meddle
        self.settings = settings or Settings()
        self.settle_s = 0.0

    def press(self, image: bytes, velocity_mm_s: float, settings: Settings) -> ScriptedPlant:
        travel_mm = travel_mm_of(image)
        down_s = travel_mm / velocity_mm_s
        corners_s = np.cumsum([0.0, 0.01, down_s, 0.02, down_s, 0.04])
        t_s = np.arange(round(corners_s[-1] / (settings.tick_us * 1e-6))) * settings.tick_us * 1e-6
        path: FloatArray = np.interp(t_s, corners_s, [0.0, 0.0, travel_mm, travel_mm, 0.0, 0.0])
        return ScriptedPlant(path, velocity_mm_s, settings, self._random, meddle=self.meddle)

    def load(self, image: bytes) -> None:
        """Do nothing: there is no vibration board."""

    def rest(self, settings: Settings) -> ScriptedPlant:
        return ScriptedPlant(np.zeros(1), 0.0, settings, self._random)
