"""The twin as a device, and its person at a board that runs the firmware."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import replace

import numpy as np

from fdvv.device.contract import DeviceInfo, check_speed, check_table, check_travel
from fdvv.device.plant import Inputs
from fdvv.errors import DeviceError, ModelError
from fdvv.firmware.core import Core
from fdvv.firmware.limits import limits_like
from fdvv.model.press import Press
from fdvv.model.surface import ForceSurface
from fdvv.protocol.messages import CN64_PER_cN, travel_mm_of
from fdvv.protocol.tables import BoardLimits, CellSpec, ForceLoopGains, Mode, Settings
from fdvv.twin.finger import Finger, bare
from fdvv.twin.gesture import Gesture, vary
from fdvv.twin.image import image_of
from fdvv.twin.noise import Noise, draw_noise
from fdvv.twin.pace import solve_program_pace
from fdvv.twin.plant import RigPlant
from fdvv.twin.rig import Rig
from fdvv.twin.rig_kernel import LoopConstants
from fdvv.twin.settings import cell_of, limits_of, settings_of, thermistor_limits
from fdvv.twin.simulate import simulate_program
from fdvv.twin.trace import Trace
from fdvv.units import m_from_mm, mm_from_m

SETTLE_s = 0.3
"""Without force the cap lies at the stop; it must be up before anyone presses."""


class TwinDevice:
    """A rig and a person, both simulated; every press is drawn afresh, and seed repeats the session.

    Parameters
    ----------
    rig, finger : the default ones if None.
    seed : of everything random.

    The person holds the asked pace on whatever is uploaded, as someone does who follows a pace indicator,
    within the spread of the finger's habit. The controller, which is the firmware's own core, gets the
    asked pace and uses it until it has measured its own. Every press begins with a cold coil.
    """

    def __init__(self, rig: Rig | None = None, finger: Finger | None = None, seed: int = 0) -> None:
        self._rig, self._finger = rig or Rig(), finger or Finger()
        if self._rig.has_cell:
            self._finger = bare(self._finger)
        self.loop: ForceLoopGains | None = None
        self._settings = settings_of(self._rig)
        self._random = np.random.default_rng(seed)
        self._active: bytes | None = None
        self._paced_on = b""
        self._paces: dict[float, float] = {}
        self._fresh: set[float] = set()
        self._made: list[tuple[Gesture, Noise]] = []
        self._made_before: list[tuple[Gesture, Noise]] = []
        self._again: deque[tuple[Gesture, Noise]] = deque()

    def info(self) -> DeviceInfo:
        control, stops = self._rig.controller, self._rig.stops
        limits = self._settings.force_limit_cN64 / CN64_PER_cN, mm_from_m(stops.travel_limit_m)
        return DeviceInfo("twin", True, *limits, control.tick_s)

    def settings(self) -> Settings:
        """Return calibration and limits: those of the rig until others were configured."""
        return self._settings

    def configure(self, settings: Settings) -> None:
        """Replace calibration and limits, and forget the table; DeviceError if the firmware refuses them.

        The rig reads its sensor as it did: tick_us and reads stay what they are.
        """
        for name in ("tick_us", "reads"):
            fixed, requested = getattr(self._settings, name), getattr(settings, name)
            if fixed != requested:
                raise DeviceError(f"twin: {name} is {fixed} in this rig and cannot be {requested}")
        try:
            Core(settings, limits=limits_of(self._rig))  # refuses them as a board does
        except ModelError as error:
            raise DeviceError(f"twin: {error}") from error
        self._settings, self._active, self.loop = settings, None, None

    @property
    def has_exciter(self) -> bool:
        return self._rig.exciter.fitted == "yes"

    def repeat_presses(self) -> None:
        """Let the next presses be those of the program before, gesture and noise alike; later ones are fresh.

        What differs is then the doing of the program: nobody but a simulated person can press like that.
        """
        self._again = deque(self._made_before)

    @property
    def _constants(self) -> LoopConstants | None:
        return None if self.loop is None else self.loop.pack()

    @property
    def load_cell(self) -> CellSpec | None:
        return cell_of(self._rig)

    def close_loop(self, gains: ForceLoopGains | None) -> None:
        if gains is not None and not self._rig.has_cell:
            raise DeviceError("twin: this rig has no load cell; name one with [load_cell] fitted")
        self.loop, self._active = gains, None

    def upload(self, surface: ForceSurface, travel_mm: float, paced: bool = False) -> None:
        """Make surface the active command table and set the stop; DeviceError beyond the limits.

        The table is rounded to 1/64 cN and, if it has more places than a device holds, sampled to fit.
        """
        check_table(self.info(), surface, travel_mm)
        try:
            self._activate(image_of(surface, travel_mm, paced=paced).image)
        except ModelError as error:
            raise DeviceError(f"twin: {error}; upload a coarser or smoother table") from error

    def upload_program(self, image: bytes, paced_on: bytes | None = None) -> None:
        """Make a program (a checked image, protocol/fdvv.toml) active; DeviceError beyond the travel.

        paced_on : image on which the person learned the pace, if not on this one: a cap that a program moves
            by itself says nothing about the speed of the hand.
        """
        check_travel(self.info(), travel_mm_of(image))
        self._activate(image)
        self._paced_on = paced_on or image

    def press(self, velocity_mm_s: float) -> Press:
        return self.press_trace(velocity_mm_s).press(velocity_mm_s)

    def press_trace(self, velocity_mm_s: float) -> Trace:
        """Press as press() does and give all that the twin knows of it, the program's states included."""
        if self._active is None:
            raise DeviceError("twin: press before upload; upload a surface first")
        check_speed("twin", velocity_mm_s)
        gesture, noise = self._again.popleft() if self._again else self._draw(velocity_mm_s, self._active)
        trace = simulate_program(
            self._rig,
            self._finger,
            gesture,
            self._active,
            noise,
            velocity_mm_s,
            settings=self._settings,
            loop=self._constants,
        )
        fault = trace.mode == Mode.FAULT
        if fault.any():
            raise DeviceError(
                f"twin: the supervisor let go after {trace.t_s[np.argmax(fault)]:.3f} s; "
                "look for a rig whose sensor, supply or heat is beyond its limits"
            )
        return trace

    def _draw(self, velocity_mm_s: float, image: bytes) -> tuple[Gesture, Noise]:
        """Draw a fresh press, and keep it to be repeated."""
        press_s = self._pace_s(velocity_mm_s, self._paced_on)
        travel_m, speed_m_s = m_from_mm(travel_mm_of(image)), m_from_mm(velocity_mm_s)
        gesture = vary(self._finger, travel_m, press_s, speed_m_s, self._random)
        self._made.append((gesture, draw_noise(self._rig, self._finger, gesture, self._random)))
        return self._made[-1]

    def _activate(self, image: bytes) -> None:
        self._active = self._paced_on = image
        self._fresh.clear()
        self._made_before, self._made = self._made, []
        self._again.clear()

    def _pace_s(self, velocity_mm_s: float, image: bytes) -> float:
        """Return the stroke's duration, found once per upload and speed, from the last one found."""
        if velocity_mm_s not in self._fresh:
            guess = self._paces.get(velocity_mm_s)
            self._paces[velocity_mm_s] = solve_program_pace(
                self._rig, self._finger, image, velocity_mm_s, guess, self._settings, self._constants
            )
            self._fresh.add(velocity_mm_s)
        return self._paces[velocity_mm_s]


class SimulatedPerson:
    """Presses the twin's rig as the person of `TwinDevice` does, but on any board; all simulated."""

    def __init__(self, rig: Rig | None = None, finger: Finger | None = None, seed: int = 0) -> None:
        rig, finger = rig or Rig(), finger or Finger()
        self._plant = RigPlant(rig, bare(finger) if rig.has_cell else finger, seed)
        self.loop: ForceLoopGains | None = None
        self._random = np.random.default_rng(seed)
        self._paces: dict[tuple[bytes, float, Settings, ForceLoopGains | None], float] = {}
        self._ticks = 0
        self.settle_s = SETTLE_s
        self.settings: Settings = settings_of(self._plant.rig)

    @property
    def load_cell(self) -> CellSpec | None:
        return cell_of(self._plant.rig)

    @property
    def limits(self) -> BoardLimits:
        return replace(limits_like(self.settings), **thermistor_limits(self._plant.rig))

    @property
    def travel_limit_mm(self) -> float:
        return float(mm_from_m(self._plant.rig.stops.travel_limit_m))

    @property
    def ticks(self) -> int:
        return self._ticks

    def step(self, duty_q15: int, enable: int, stop_us: int, slot: int) -> Inputs:
        return Inputs(*self._plant.step(duty_q15, bool(enable), stop_us, slot).item())

    def press(self, image: bytes, velocity_mm_s: float, settings: Settings) -> SimulatedPerson:
        """Begin a press at about this speed; what happened before it is forgotten."""
        travel_m, speed_m_s = float(m_from_mm(travel_mm_of(image))), float(m_from_mm(velocity_mm_s))
        pace_s = self._pace_s(image, velocity_mm_s, settings)
        gesture = vary(self._plant.finger, travel_m, pace_s, speed_m_s, self._random)
        self._plant.record()
        self._plant.press(gesture)
        self._ticks = math.ceil(gesture.duration_s / (settings.tick_us * 1e-6))
        return self

    def _pace_s(self, image: bytes, velocity_mm_s: float, settings: Settings) -> float:
        key = image, velocity_mm_s, settings, self.loop
        if key not in self._paces:
            self._paces[key] = solve_program_pace(
                self._plant.rig,
                self._plant.finger,
                image,
                velocity_mm_s,
                settings=settings,
                loop=None if self.loop is None else self.loop.pack(),
            )
        return self._paces[key]

    def record(self) -> Trace:
        return self._plant.record()

    def load(self, image: bytes) -> None:
        self._plant.load(image)

    def lift(self) -> None:
        self._plant.lift()

    def rest(self, settings: Settings) -> SimulatedPerson:
        """Leave the button alone: the finger rests once its press is over."""
        return self
