"""A rig in closed form: a prescribed motion, finely stepped lags, nothing shared with what is tested."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from fdvv.compensation.identification.rig_model import RigModel
from fdvv.model.press import Press
from fdvv.units import FloatArray

FINE = 10
"""Steps per tick."""
TRAVEL_mm = 4.0


@dataclass(frozen=True)
class Plant:
    """A rig's numbers, in the units of their names; noise is rms per tick."""

    gain: tuple[float, float, float] = (0.85, 0.08, -0.012)
    viscous_N_s_m: float = 0.4
    back_emf_N_s_m: float = 4.0
    friction_cN: float = 5.0
    weight_cN: float = 18.0
    mass_g: float = 20.0
    cone_g: float = 2.0
    half_play_cN: float = 0.0
    position_lag_s: float = 7e-4
    command_delay_s: float = 2e-4
    electric_lag_s: float = 4e-4
    filter_s: float = 3.33e-4
    position_noise_mm: float = 0.0
    force_noise_cN: float = 0.0
    tick_s: float = 2.5e-4

    def motion(self, velocity_mm_s: float, tremor_mm: float = 0.1) -> tuple[FloatArray, ...]:
        """Return time, place, speed and acceleration (mm, s), finely: down and back along cosines."""
        step = self.tick_s / FINE
        stroke, rest = TRAVEL_mm / velocity_mm_s, 0.02
        t = np.arange(0.0, 4 * rest + 2 * stroke, step)
        down, up = np.clip((t - rest) / stroke, 0, 1), np.clip((t - 3 * rest - stroke) / stroke, 0, 1)
        x = 0.5 * TRAVEL_mm * (np.cos(np.pi * up) - np.cos(np.pi * down))
        shake = np.sin(np.pi * down) ** 2 * np.sin(np.pi * up / 2 + np.pi / 2) ** 2
        x = x + tremor_mm * (shake + np.sin(np.pi * up) ** 2) * np.sin(2 * np.pi * 45 * t)
        v = np.gradient(x, step)
        return t, x, v, np.gradient(v, step)

    def press(self, velocity_mm_s: float, seed: int = 0) -> Press:
        """Press with a tremor, commanding waves over time."""
        t, *motion = self.motion(velocity_mm_s)
        command = 70 + 12 * np.sin(2 * np.pi * 37 * t) + 9 * np.sin(2 * np.pi * 83 * t + velocity_mm_s)
        return self.pressed(velocity_mm_s, (t, *motion), command, seed)

    def pressed(
        self, velocity_mm_s: float, motion: tuple[FloatArray, ...], command: FloatArray, seed: int = 0
    ) -> Press:
        """Return the record of a motion under a command, both finely over time."""
        random = np.random.default_rng((seed, round(velocity_mm_s)))
        t, x, _, a = motion
        step, rows = self.tick_s / FINE, slice(None, None, FINE)
        force = sum(self.forces_cN(motion, command)) + 1e-4 * self.cone_g * a
        reading = played(lagged(force, self.filter_s, step), self.half_play_cN)
        sensed = lagged(x, self.position_lag_s, step)[rows]
        sensed = sensed + self.position_noise_mm * random.standard_normal(sensed.size)
        measured = reading[rows] + self.force_noise_cN * random.standard_normal(sensed.size)
        nowhere = np.full(sensed.size, np.nan)
        return Press(t[rows], nowhere, nowhere, velocity_mm_s, sensed, measured, command[rows])

    def forces_cN(self, motion: tuple[FloatArray, ...], command: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the coil's force on the finger, its braking included, and the rig's own force."""
        t, x, v, a = motion
        gain = self.gain[0] + x * (self.gain[1] + x * self.gain[2])
        late = np.interp(t - self.command_delay_s, t, command)
        step = self.tick_s / FINE
        coil = lagged(gain * late + 0.1 * self.back_emf_N_s_m * gain**2 * v, self.electric_lag_s, step)
        own = 0.1 * self.viscous_N_s_m * v + self.friction_cN * np.sign(v) - self.weight_cN
        return coil, own + 1e-4 * self.mass_g * a


def known_of(plant: Plant) -> RigModel:
    """Return the model that identification would find, had it no error."""
    return RigModel(
        plant.gain,
        plant.command_delay_s + plant.electric_lag_s,
        plant.electric_lag_s,
        plant.position_lag_s,
        plant.viscous_N_s_m + plant.back_emf_N_s_m,
        plant.back_emf_N_s_m,
        plant.friction_cN,
        plant.weight_cN,
        plant.mass_g,
        2 * plant.half_play_cN,
    )


def keep_rows(press: Press, rows: slice | npt.NDArray[Any]) -> Press:
    """Return a press that has only these rows."""
    names = ("t_s", "displacement_mm", "force_cN", "sensed_mm", "sensed_cN", "commanded_cN")
    return replace(press, **{name: getattr(press, name)[rows] for name in names})


def lagged(signal: FloatArray, lag_s: float, step_s: float) -> FloatArray:
    """Follow a signal with a first-order lag, by the midpoint rule."""
    out, value = [], float(signal[0])
    ratio = step_s / lag_s
    for before, after in zip([signal[0], *signal[:-1].tolist()], signal.tolist(), strict=True):
        value += ratio / (1 + ratio / 2) * (0.5 * (before + after) - value)
        out.append(value)
    return np.array(out)


def played(signal: FloatArray, half: float) -> FloatArray:
    """Follow a signal with a play."""
    out, held = [], float(signal[0])
    for value in signal.tolist():
        held = min(max(held, value - half), value + half)
        out.append(held)
    return np.array(out)
