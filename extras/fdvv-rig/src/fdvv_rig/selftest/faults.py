"""Parts of a simulated rig that are wrong on purpose, to see whether the self-test names them. Simulated."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from fdvv.device.plant import Inputs
from fdvv.twin.rig import Rig

SLOW_PWM_Hz = 48e6 / 2**16
"""What the board's core libraries would leave the timer at."""
BOARD_SILENT = 1 << 3
"""The controller's note that the vibration board does not answer (firmware/core/inputs.h)."""
FULL = 32767


@dataclass(frozen=True)
class RigFault:
    """One thing that is wrong.

    Attributes
    ----------
    part : that ought to be named. about : for people.
    rig : changes what the rig is made of.
    duty : changes the bridge's output, given ratio, time and tick in s; None is an open bridge.
    inputs : changes what the board reads, given its reads and converter steps.
    stop_mm : where the stop is stuck; None: it moves. stop_us : added to every pulse.
    silent : nothing is played.
    """

    part: str
    about: str
    rig: Callable[[Rig], Rig] = lambda rig: rig
    duty: Callable[[float, float, float], float | None] = lambda ratio, _t, _tick: ratio
    inputs: Callable[[Inputs, int, int], Inputs] = lambda inputs, _reads, _steps: inputs
    stop_mm: float | None = None
    stop_us: int = 0
    silent: bool = False


def _with(section: str, **factors: float) -> Callable[[Rig], Rig]:
    def change(rig: Rig) -> Rig:
        part: Any = getattr(rig, section)
        changed = replace(part, **{name: getattr(part, name) * k for name, k in factors.items()})
        return replace(rig, **{section: changed})

    return change


def _set(section: str, **values: float) -> Callable[[Rig], Rig]:
    return lambda rig: replace(rig, **{section: replace(getattr(rig, section), **values)})


def _mapped(scale: float, shift: float = 0.0) -> Callable[[Inputs, int, int], Inputs]:
    def change(inputs: Inputs, reads: int, steps: int) -> Inputs:
        def one(count: float, times: int) -> int:
            middle = times * steps / 2
            wanted = middle + scale * (count - middle) + shift * times * steps
            return int(min(max(wanted, 0), times * (steps - 1)))

        ends = sorted((one(inputs.lowest, 1), one(inputs.highest, 1)))
        return inputs._replace(sum=one(inputs.sum, reads), lowest=ends[0], highest=ends[1])

    return change


def _frozen(inputs: Inputs, reads: int, steps: int) -> Inputs:
    return inputs._replace(sum=reads * steps // 2, lowest=steps // 2, highest=steps // 2)


def _broken_wire(inputs: Inputs, _reads: int, _steps: int) -> Inputs:
    return inputs._replace(sum=0, lowest=0, highest=0)


def _force(scale: float) -> Callable[[Inputs, int, int], Inputs]:
    def change(inputs: Inputs, _reads: int, steps: int) -> Inputs:
        return inputs._replace(force_counts=round(steps / 2 + scale * (inputs.force_counts - steps / 2)))

    return change


def _slow_pwm(ratio: float, t_s: float, tick_s: float) -> float:
    begin, end, share = t_s * SLOW_PWM_Hz, (t_s + tick_s) * SLOW_PWM_Hz, abs(ratio)

    def on(periods: float) -> float:
        whole = math.floor(periods)
        return whole * share + min(periods - whole, share)

    return math.copysign((on(end) - on(begin)) / (end - begin), ratio)


def _silent_board(inputs: Inputs, _reads: int, _steps: int) -> Inputs:
    return inputs._replace(board=inputs.board | BOARD_SILENT)


RIG_FAULTS = {
    "coil-reversed": RigFault("coil", "its two wires are exchanged", duty=lambda r, _t, _s: -r),
    "coil-open": RigFault("coil", "a wire is off", duty=lambda _r, _t, _s: None),
    "coil-weak": RigFault("coil", "it pushes with half its force", _with("coil", force_constant_N_A=0.5)),
    "position-reversed": RigFault("position sensor", "its secondaries are exchanged", inputs=_mapped(-1.0)),
    "position-dead": RigFault("position sensor", "its conditioner stands at mid scale", inputs=_frozen),
    "position-off": RigFault("position sensor", "its wire is off", inputs=_broken_wire),
    "position-noisy": RigFault(
        "position sensor", "20 times its noise", _with("position_sensor", noise_m=20.0)
    ),
    "position-scale": RigFault("position sensor", "reads a fifth too little", inputs=_mapped(0.8)),
    "position-shifted": RigFault("position sensor", "is mounted 0.6 mm off", inputs=_mapped(1.0, 0.6 / 12.7)),
    "force-dead": RigFault("force sensor", "its wire is off", inputs=_force(0.0)),
    "force-reversed": RigFault("force sensor", "is mounted the other way", inputs=_force(-1.0)),
    "force-scale": RigFault("force sensor", "reads a third too little", inputs=_force(0.67)),
    "slider-stuck": RigFault("slider", "2 N of friction", _set("mover", coulomb_N=2.0)),
    "slider-rubs": RigFault("slider", "0.35 N of friction", _set("mover", coulomb_N=0.35)),
    "supply-low": RigFault("supply", "9.6 V instead of 12 V", _with("coil", supply_V=0.8)),
    "supply-weak": RigFault("supply", "sags: 6 ohm inside", _set("coil", source_ohm=6.0)),
    "stop-stuck": RigFault("travel stop", "does not move", stop_mm=4.3),
    "stop-shifted": RigFault("travel stop", "its horn is a tooth off", stop_us=160),
    "exciter-dead": RigFault("exciter", "a wire is off", silent=True),
    "wire-dead": RigFault("vibration board", "I2C is off", silent=True, inputs=_silent_board),
    "slow-pwm": RigFault("coil driver", "driven with 732 Hz instead of 23.4 kHz", duty=_slow_pwm),
}
"""What may be wrong, by name."""
