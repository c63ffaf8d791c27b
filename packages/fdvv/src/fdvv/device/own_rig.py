"""A rig of your own: a few lines of physics, connected to the firmware and pressed by a simulated hand."""

from __future__ import annotations

import importlib
import importlib.util
import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar, Protocol, cast

import numpy as np

from fdvv import extras
from fdvv.device.plant import Inputs
from fdvv.errors import BuildError, InputError, ModelError
from fdvv.model.press import Press
from fdvv.protocol.messages import CN64_PER_cN, UM16_PER_mm, travel_mm_of
from fdvv.protocol.tables import BoardFlag, Settings

CONVERTER_counts, READS = 4095, 25
"""A converter of 12 bits, read so often in a tick."""
STEP_s = 25e-6
"""Longest step of the physics: stops and skin are stiff."""
SETTLE_s = 0.3
RANGES = {
    "full_duty_N": (0.5, 5000.0),
    "force_limit_N": (0.01, 5.0),
    "supply_V": (3.0, 48.0),
    "tick_us": (50, 4000),
    "force_sensor_N": (0.0, 5.1),
    "travel_mm": (1.0, 20.0),
    "rise_K": (1.0, 16383.0),
    "heat_s": (0.1, 600.0),
}
"""What the firmware's numbers can hold (protocol/fdvv.toml)."""
FASTEST_mm_s, STUCK_s = 2000.0, 0.5
"""No cap moves faster, and no sensor reads the same for so long; beyond it a reading is a fault."""
USUAL_us_mm, LONGEST_PULSE_us = 150.0, 1600.0
"""Servo pulse per travel, and the longest beyond that at travel 0."""
MIDDLE = (0.1, 0.9)
"""Parts of the travel between which a hand feels its pace."""
SWITCHED_OFF_mm = -1.0
"""Where a finger waits that presses nothing."""


@dataclass(frozen=True)
class RigNumbers:
    """What the firmware must know of a rig, from its drawing and data sheets.

    Attributes
    ----------
    name : short, for messages.
    full_duty_N : force of the motor in the middle of the stroke at full duty and nominal supply.
    force_limit_N : largest force that may be commanded.
    supply_V : nominal.
    tick_us : period of the control loop, 50 to 4000.
    sensor_mm : displacement of the cap where the position sensor reads 0, and where it reads full scale;
        the first may be the larger one.
    force_sensor_N : range, both signs, of a force sensor under the finger; 0 if there is none.
    travel_mm : the deepest place that the bottom stop can be set to.
    travel_limiter : whether there is a stop that can be set; else the one of the mechanism.
    vibration_board : whether one is connected.
    rise_K, heat_s : how much warmer the coil would end at full duty held for ever, and its time constant.
    """

    name: str
    full_duty_N: float
    force_limit_N: float
    supply_V: float = 12.0
    tick_us: int = 250
    sensor_mm: tuple[float, float] = (-6.35, 6.35)
    force_sensor_N: float = 0.0
    rise_K: float = 600.0
    heat_s: float = 60.0
    travel_mm: float = 6.2
    travel_limiter: bool = True
    vibration_board: bool = False

    LEAST_RANGE_mm: ClassVar[float] = 1.0
    SENSOR_mm: ClassVar[tuple[float, float]] = (25.0, 32.7)
    """Largest displacement at a reading of 0, both signs, and widest range."""

    def __post_init__(self) -> None:
        for name, (low, high) in RANGES.items():
            if not low <= getattr(self, name) <= high:
                raise ModelError(
                    f"{self.name}: {name} is {getattr(self, name):g}, the firmware takes {low:g} to {high:g}"
                )
        if self.force_limit_N > self.full_duty_N:
            raise ModelError(
                f"{self.name}: force_limit_N is {self.force_limit_N:g}, at full duty the motor gives "
                f"{self.full_duty_N:g}: write what may be commanded, a little less than that"
            )
        zero_mm, range_mm = abs(self.sensor_mm[0]), abs(self.sensor_mm[1] - self.sensor_mm[0])
        if range_mm < self.LEAST_RANGE_mm:
            raise ModelError(f"{self.name}: sensor_mm spans {self.sensor_mm}, less than the cap travels")
        furthest_mm, widest_mm = self.SENSOR_mm
        if zero_mm > furthest_mm or range_mm > widest_mm:
            raise ModelError(
                f"{self.name}: sensor_mm is {self.sensor_mm}, the firmware takes {furthest_mm:g} mm at a "
                f"reading of 0 and a range of {widest_mm:g}"
            )

    def settings(self) -> Settings:
        """Return the settings of a board for this rig."""
        low_mm, high_mm = self.sensor_mm
        um16_count = UM16_PER_mm * (high_mm - low_mm) / (CONVERTER_counts * READS)
        force_cN64_count = CN64_PER_cN * 100 * 2 * self.force_sensor_N / (CONVERTER_counts + 1)
        nominal_mV = round(1000 * self.supply_V)
        return Settings(
            position_gain_q14=round(2**14 * um16_count),
            position_offset_um16=round(UM16_PER_mm * low_mm),
            duty_gain_q16=round(2**31 / (100 * CN64_PER_cN * self.full_duty_N)),
            force_gain_q14=round(2**14 * force_cN64_count),
            force_offset_counts=(CONVERTER_counts + 1) // 2 if self.force_sensor_N else 0,
            tick_us=self.tick_us,
            force_limit_cN64=round(100 * CN64_PER_cN * self.force_limit_N),
            nominal_supply_mV=nominal_mV,
            supply_low_mV=round(0.75 * nominal_mV),
            supply_high_mV=round(1.167 * nominal_mV),
            full_duty_rise_K=math.ceil(self.rise_K),
            heat_time_ms=round(1000 * self.heat_s),
            reads=READS,
            jump_um16=min(65_535, round(UM16_PER_mm * FASTEST_mm_s * 1e-6 * self.tick_us)),
            stuck_ticks=round(STUCK_s / (1e-6 * self.tick_us)),
            window_start_um16=round(UM16_PER_mm * min(0.5, 0.2 * self.travel_mm)),
            window_end_um16=round(UM16_PER_mm * min(1.0, 0.5 * self.travel_mm)),
            stop_us_mm=math.floor(min(USUAL_us_mm, LONGEST_PULSE_us / self.travel_mm)),
        )

    @property
    def fitted(self) -> BoardFlag:
        """Return the parts beside motor and sensors."""
        limiter = BoardFlag.SERVO if self.travel_limiter else BoardFlag(0)
        return limiter | (BoardFlag.VIBRATION if self.vibration_board else BoardFlag(0))


class OwnRig(Protocol):
    """The physics of a rig, at rest with its cap at the top when it is made.

    Attributes
    ----------
    numbers : what the firmware must know.
    """

    numbers: RigNumbers

    def step(self, motor_N: float, finger_N: float, stop_mm: float, dt_s: float) -> float:
        """Move on by dt_s and return the displacement of the cap in mm, 0 at the top, positive downwards.

        motor_N : of the motor, positive upwards, against the finger. finger_N : of the finger, 0 or more,
        downwards. stop_mm : where the bottom stop is.
        """


class Hand:
    """A simulated finger: a mass on a muscle that follows a path down and up, with a pad in front.

    Ranges as in docs/reference/rig.md (finger); here it is the middle of each, the path varies by a tenth.
    It finds the pace that it was asked for from press to press, as a person does.
    """

    MASS_kg, MUSCLE_N_mm, DAMPING_N_s_mm = 6e-3, 0.6, 5e-3
    PAD_N_mm, PAD_N_s_mm = 1.5, 1.5e-3
    SPREAD_ratio, REST_s, HOLD_s = 0.1, 0.03, 0.05
    DEEP_N = 3.0
    """How hard it means to push at the bottom: harder than buttons resist."""
    FIRST_ratio, ADAPTED_ratio = 1.5, 0.7
    """Of the stroke's duration before the first press; part of its error that the next press mends."""

    def __init__(self, random: np.random.Generator) -> None:
        self._random = random
        self.x_mm, self.v_mm_s, self._t_s = SWITCHED_OFF_mm, 0.0, 0.0
        self._reach_mm, self._stroke_s = 0.0, 1.0
        self._asked_mm_s, self._slowness = 0.0, {}  # type: float, dict[float, float]
        self.duration_s = 0.0

    def press(self, travel_mm: float, velocity_mm_s: float) -> None:
        """Begin a press that goes through the travel at about this mean speed."""
        self._asked_mm_s = velocity_mm_s
        self._reach_mm = travel_mm + self.DEEP_N / self.MUSCLE_N_mm - SWITCHED_OFF_mm
        varied = 1.0 + self.SPREAD_ratio * float(self._random.uniform(-1.0, 1.0))
        slowness = self._slowness.setdefault(velocity_mm_s, self.FIRST_ratio)
        self._stroke_s = self._reach_mm / velocity_mm_s * slowness * varied
        self._t_s = 0.0
        self.duration_s = 2 * (self.REST_s + self._stroke_s) + self.HOLD_s

    def learn_speed(self, velocity_mm_s: float) -> None:
        """Learn from the speed that the last press reached."""
        ratio = velocity_mm_s / self._asked_mm_s
        self._slowness[self._asked_mm_s] *= ratio**self.ADAPTED_ratio

    def _target_mm(self) -> float:
        down = _minimum_jerk((self._t_s - self.REST_s) / self._stroke_s)
        up = _minimum_jerk((self._t_s - self.REST_s - self._stroke_s - self.HOLD_s) / self._stroke_s)
        return SWITCHED_OFF_mm + self._reach_mm * (down - up)

    def step(self, cap_mm: float, cap_mm_s: float, dt_s: float) -> float:
        """Move on by dt_s; return the force on the cap in N."""
        depth_mm = self.x_mm - cap_mm
        pad_N = self.PAD_N_mm * depth_mm + self.PAD_N_s_mm * (self.v_mm_s - cap_mm_s)
        force_N = max(0.0, pad_N) if depth_mm > 0 else 0.0
        muscle_N = self.MUSCLE_N_mm * (self._target_mm() - self.x_mm) - self.DAMPING_N_s_mm * self.v_mm_s
        self.v_mm_s += 1000.0 * (muscle_N - force_N) / self.MASS_kg * dt_s
        self.x_mm += self.v_mm_s * dt_s
        self._t_s += dt_s
        return force_N


def _minimum_jerk(part: float) -> float:
    s = min(1.0, max(0.0, part))
    return s**3 * (10.0 - 15.0 * s + 6.0 * s**2)


class OwnRigPerson:
    """A rig of one's own and a hand at it, as a board needs them: a person and a plant; simulated.

    Parameters
    ----------
    make : returns the rig; seed : of the hand and the sensors' noise.
    """

    NOISE_counts = 0.7

    def __init__(self, make: Callable[[], OwnRig], seed: int = 0) -> None:
        self.rig = make()
        self.settings = self.rig.numbers.settings()
        self.settle_s = SETTLE_s
        self._random = np.random.default_rng(seed)
        self._hand = Hand(self._random)
        self._x_mm = self._v_mm_s = self._force_N = 0.0
        self._rows: list[tuple[float, float]] = []
        self._speed_mm_s, self._travel_mm, self._ticks = 0.0, 0.0, 0

    @property
    def ticks(self) -> int:
        return self._ticks

    @property
    def travel_limit_mm(self) -> float:
        return self.rig.numbers.travel_mm

    @property
    def fitted(self) -> BoardFlag:
        return self.rig.numbers.fitted

    def press(self, image: bytes, velocity_mm_s: float, settings: Settings) -> OwnRigPerson:
        self._notice_pace()
        self._travel_mm = travel_mm_of(image)
        self._hand.press(self._travel_mm, velocity_mm_s)
        self._speed_mm_s = velocity_mm_s
        self._ticks = math.ceil(self._hand.duration_s / (settings.tick_us * 1e-6))
        self._rows = []
        return self

    def _notice_pace(self) -> None:
        """Let the hand know how fast the cap went through the middle of its travel in the last press."""
        if not self._rows or not self._travel_mm:
            return
        x_mm = np.array(self._rows, dtype=np.float64)[:, 0]
        between = [int(np.argmax(x_mm > part * self._travel_mm)) for part in MIDDLE]
        if 0 < between[0] < between[1]:
            took_s = (between[1] - between[0]) * self.rig.numbers.tick_us * 1e-6
            self._hand.learn_speed((MIDDLE[1] - MIDDLE[0]) * self._travel_mm / took_s)

    def rest(self, settings: Settings) -> OwnRigPerson:
        """Leave the button alone: the finger stays up once its press is over."""
        return self

    def load(self, image: bytes) -> None:
        """Do nothing: there is no vibration board."""

    def record(self) -> Press:
        """Return the true displacement and force at every tick since the press began."""
        x_mm, force_cN = np.array(self._rows, dtype=np.float64).T
        tick_s = self.rig.numbers.tick_us * 1e-6
        t_s = np.arange(x_mm.size, dtype=np.float64) * tick_s
        every = np.ones(x_mm.size, dtype=np.bool_)
        return Press(t_s, x_mm, force_cN, self._speed_mm_s, tick=every, simulated=True)

    def step(self, duty_q15: int, enable: int, stop_us: int, slot: int) -> Inputs:
        numbers = self.rig.numbers
        motor_N = duty_q15 / 2**15 * numbers.full_duty_N if enable else 0.0
        stop_mm = (stop_us - self.settings.stop_zero_us) / self.settings.stop_us_mm if stop_us else math.inf
        tick_s = numbers.tick_us * 1e-6
        count = math.ceil(tick_s / STEP_s - 1e-9)
        for _ in range(count):
            self._move(motor_N, stop_mm, tick_s / count)
        self._rows.append((self._x_mm, 100.0 * self._force_N))
        return self._read_sensors()

    def _move(self, motor_N: float, stop_mm: float, dt_s: float) -> None:
        self._force_N = self._hand.step(self._x_mm, self._v_mm_s, dt_s)
        x_mm = float(self.rig.step(motor_N, self._force_N, stop_mm, dt_s))
        if not math.isfinite(x_mm):
            raise InputError("step", self.rig.numbers.name, f"returned {x_mm} mm", "use a shorter step")
        self._v_mm_s = (x_mm - self._x_mm) / dt_s
        self._x_mm = x_mm

    def _read_sensors(self) -> Inputs:
        numbers, settings = self.rig.numbers, self.settings
        scale = settings.position_gain_q14 / 2**14
        exact = (UM16_PER_mm * self._x_mm - settings.position_offset_um16) / scale / READS
        reads = np.rint(exact + self.NOISE_counts * self._random.standard_normal(READS))
        reads = np.clip(reads, 0, CONVERTER_counts)
        force_counts = 0
        if settings.force_gain_q14:
            per_count = settings.force_gain_q14 / 2**14 / CN64_PER_cN / 100
            wanted = settings.force_offset_counts + self._force_N / per_count
            force_counts = min(CONVERTER_counts, max(0, round(wanted + self._random.normal())))
        readings = int(reads.sum()), int(reads.min()), int(reads.max())
        supply_mV = round(1000 * numbers.supply_V)
        return Inputs(0, *readings, supply_mV=supply_mV, force_counts=force_counts)


def find_rig(name: str) -> Callable[[], OwnRig]:
    """Return what makes a rig: one that a package registers, or ``FILE.py:NAME``.

    A file is run as it is imported. Raises InputError if there is none, with what there is.
    """
    path, colon, attribute = name.rpartition(":")
    if colon and path.endswith(".py"):
        return _of_file(Path(path), attribute)
    if name in extras.names("rigs"):
        return cast(Callable[[], OwnRig], extras.load("rigs", name))
    known = ", ".join(extras.names("rigs")) or "none is installed"
    raise InputError("rig", name, "names no rig", f"write FILE.py:NAME, or one of the installed: {known}")


def _of_file(path: Path, attribute: str) -> Callable[[], OwnRig]:
    spec = importlib.util.spec_from_file_location(f"own_rig_{path.stem}", path)
    if not path.is_file() or spec is None or spec.loader is None:
        raise InputError("rig", str(path), "is no file of Python", "write FILE.py:NAME")
    module = importlib.util.module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
    except Exception as error:
        raise BuildError(f"{path}: cannot be imported: {type(error).__name__}: {error}") from error
    factory = getattr(module, attribute, None)
    if not callable(factory):
        raise InputError("rig", f"{path}:{attribute}", "is no class or function", "write FILE.py:NAME")
    return cast(Callable[[], OwnRig], factory)
