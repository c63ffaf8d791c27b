"""Presses of a simulated real button."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fdvv.io.files import write_atomic
from fdvv.rendering.compensate import check_speeds
from fdvv.twin.button import ButtonPhysics
from fdvv.twin.files import load_button, load_finger
from fdvv.twin.finger import Finger
from fdvv.twin.gesture import vary
from fdvv.twin.pace import mean_speed_mm_s, solve_button_pace
from fdvv.twin.rig import ForceSensor
from fdvv.twin.simulate_button import ButtonTrace, draw_button_noise, probe_button, simulate_button
from fdvv.units import m_from_mm, mm_from_m

COLUMNS = "press,asked_mm_s,t_s,displacement_mm,velocity_mm_s,force_cN,sensed_cN,closed"


@dataclass(frozen=True, eq=False)
class ButtonPress:
    """One simulated press of a real button.

    Attributes
    ----------
    asked_mm_s, achieved_mm_s : mean speed of the stroke down, asked for and reached.
    before_stop_cN : largest force on the cap before the last 0.1 mm of the travel.
    largest_cN : largest force of the whole press, including impact at the bottom.
    closing_ms : when the circuit closed, after the cap had begun to move; None if it never did.
    """

    asked_mm_s: float
    achieved_mm_s: float
    before_stop_cN: float
    largest_cN: float
    closing_ms: float | None
    trace: ButtonTrace


@dataclass(frozen=True, eq=False)
class SimulatedPresses:
    """Presses of one button, and its slow curve for comparison; simulated.

    Attributes
    ----------
    quasi_static_peak_cN : largest force of the press before the last 0.1 mm at 0.5 mm/s, as a force tester
        has it.
    """

    button: str
    travel_mm: float
    quasi_static_peak_cN: float
    presses: tuple[ButtonPress, ...]

    def write_csv(self, path: Path) -> None:
        """Write every row of every press, whole or not at all."""
        lines = [COLUMNS]
        for number, press in enumerate(self.presses, 1):
            t = press.trace
            sensed = t.force_cN if t.sensed_cN is None else t.sensed_cN
            columns = (t.t_s, t.displacement_mm, t.velocity_mm_s, t.force_cN, sensed)
            for row, closed in zip(zip(*columns, strict=True), t.closed, strict=True):
                numbers = ",".join(f"{value:.6g}" for value in row)
                lines.append(f"{number},{press.asked_mm_s:g},{numbers},{int(closed)}")
        write_atomic(path, "\n".join(lines) + "\n")


def press_button(
    button: Path | str,
    finger: Path | None,
    speeds_mm_s: Sequence[float],
    presses: int,
    seed: int = 0,
) -> SimulatedPresses:
    """Have the simulated person press a simulated real button, each press a fresh one.

    button : name of a shipped one or a TOML file; finger : a TOML file, the default person if None.
    speeds_mm_s : mean speeds of the stroke down; presses : of each. seed repeats everything.

    Raises InputError on an unusable name, file or speed.
    """
    physics, person = load_button(button), load_finger(finger) if finger else Finger()
    made = press_physics(physics, person, speeds_mm_s, presses, seed)
    travel_mm = float(mm_from_m(physics.curve.travel_m))
    return SimulatedPresses(str(button), travel_mm, quasi_static_peak_cN(physics), made)


def press_physics(
    physics: ButtonPhysics, person: Finger, speeds_mm_s: Sequence[float], presses: int, seed: int = 0
) -> tuple[ButtonPress, ...]:
    """Have a finger press a simulated real button; see press_button. InputError on an unusable speed."""
    speeds = check_speeds(speeds_mm_s)
    travel_mm = float(mm_from_m(physics.curve.travel_m))
    random, sensor = np.random.default_rng(seed), ForceSensor()
    made: list[ButtonPress] = []
    for speed in speeds:
        pace_s = solve_button_pace(physics, person, speed, sensor)
        for _ in range(presses):
            gesture = vary(person, physics.curve.travel_m, pace_s, float(m_from_mm(speed)), random)
            noise = draw_button_noise(person, gesture, random, sensor)
            made.append(
                _button_press(simulate_button(physics, person, gesture, noise, sensor), speed, travel_mm)
            )
    return tuple(made)


def quasi_static_peak_cN(physics: ButtonPhysics) -> float:
    """Return the largest force of a press at 0.5 mm/s before the last 0.1 mm of the travel."""
    slow = probe_button(physics)
    before = slow.displacement_mm < float(mm_from_m(physics.curve.travel_m)) - 0.1
    return float(slow.press_cN[before].max())


def _button_press(trace: ButtonTrace, asked_mm_s: float, travel_mm: float) -> ButtonPress:
    x = trace.displacement_mm
    arrived = np.flatnonzero(x >= travel_mm - 0.1)
    down = slice(0, int(arrived[0]) if arrived.size else int(x.argmax()) + 1)
    moved_s = trace.t_s[np.flatnonzero(x >= x[0] + 0.05)[0]] if np.ptp(x) > 0.05 else 0.0
    closing = None if trace.closing_s is None else 1e3 * float(trace.closing_s - moved_s)
    return ButtonPress(
        asked_mm_s,
        mean_speed_mm_s(trace.t_s, x, travel_mm),
        float(trace.force_cN[down].max(initial=0.0)),
        float(trace.force_cN.max()),
        closing,
        trace,
    )
