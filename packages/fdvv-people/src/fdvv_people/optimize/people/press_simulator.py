"""A button or program under a simulated finger on the twin, settled once and pressed often. Simulated."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from functools import lru_cache

import numpy as np

from fdvv.errors import InputError, ModelError
from fdvv.model.curve import Stroke
from fdvv.model.model import FDVVModel
from fdvv.program.button import compile_button
from fdvv.program.check import require_accepted
from fdvv.program.compile import compile_program
from fdvv.program.program import Program
from fdvv.protocol.tables import Settings
from fdvv.twin.files import load_rig
from fdvv.twin.finger import Finger, Impedance, PressVariability
from fdvv.twin.gesture import Gesture, depth_m
from fdvv.twin.interactive import InteractiveRig, InteractiveTicks
from fdvv.twin.noise import Noise, draw_ticks
from fdvv.twin.rig import Rig
from fdvv.twin.settings import settings_of
from fdvv.units import FloatArray, N_from_cN, m_from_mm, mm_from_m
from fdvv_people.optimize.people.user import SimulatedUser
from fdvv_studio.live.press_subject import rig_limits

TASK_RIGS = IDEAL, _, _ = "ideal", "paper", "light"
"""Shipped rigs that tasks are played on; on all but the ideal one the rig's own forces come on top."""
KEY_mm = 4.0
"""Travel of the usual key, on which a stroke has the person's pace."""
BEFORE_s = 0.015
"""From the finger's rest in this press to the onset of its movement."""
AFTER_s = 0.02
"""Recorded after the finger's referent has arrived."""
FIRST_ratio, PIECE_s = 0.55, 0.015
"""The cap is looked for at the stop after so much of the referent's stroke, then every so often."""
SETTLE_s, HELD_s, SHORTEST_s = 0.05, 1.0, 0.01
"""For the finger to lie still on a rig at rest (assumed). A press is held for longer than it is recorded, so
that no record holds its release. No stroke is shorter: 400 mm/s over KEY_mm (assumed)."""
POOL_TICKS = 1 << 15  # 3.3 s at 10 kHz, tens of presses (assumed): fewer repeat noise, more fill memory


@dataclass(frozen=True, eq=False)
class PressTrace:
    """One press of a task, its clock at 0 where the movement began.

    Attributes
    ----------
    ticks : what happened, columns per tick. t_s : (n,) on that clock.
    """

    ticks: InteractiveTicks
    t_s: FloatArray


@lru_cache(maxsize=512)
def _compiled(button: FDVVModel | Program, rig_name: str) -> bytes:
    limits = rig_limits(known_rig(rig_name)[0])
    if isinstance(button, Program):
        require_accepted(button)
        return compile_program(button, limits).image
    if not button.of(Stroke.PRESS):
        raise InputError(button.name, "curves", "it has no press to feel", "merge one into it")
    return compile_button(button, limits=limits).image


def refusal_of(button: FDVVModel | Program, rig_name: str = "ideal") -> str:
    """Return why the firmware of a rig cannot hold a design, else "". Raises InputError on an unknown rig."""
    known_rig(rig_name)
    try:
        PressSimulator(button, SimulatedUser(), rig_name)
    except (InputError, ModelError) as error:
        return str(error)
    return ""


@lru_cache(maxsize=8)
def known_rig(rig_name: str) -> tuple[Rig, Settings]:
    """Load a rig of TASK_RIGS with its settings. Raises InputError if there is no such rig."""
    if rig_name not in TASK_RIGS:
        raise InputError("rig", "name", f"none is called {rig_name!r}", f"use one of: {', '.join(TASK_RIGS)}")
    rig = load_rig(rig_name)
    return rig, settings_of(rig)


@lru_cache(maxsize=8)
def _pool(rig_name: str) -> Noise:
    """Draw noise once; every press takes a stretch of it."""
    rig, _ = known_rig(rig_name)
    return draw_ticks(rig, Finger(), POOL_TICKS, np.random.default_rng(0))


def _finger(user: SimulatedUser) -> Finger:
    return Finger(
        Impedance(user.mass_kg, user.stiffness_N_m, user.damping_N_s_m),
        habit=PressVariability(
            lift_m=m_from_mm(user.lift_mm),
            rest_N=max(0.0, N_from_cN(user.rest_cN)),
            push_N=N_from_cN(user.push_cN),
        ),
    )


class PressSimulator:
    """A design, or a program, under one person's finger. The same draws give the same presses.

    Attributes
    ----------
    button, rig, user, finger : what is pressed, on what, by whom. travel_mm : of the button. tick_s : of the
        controller.

    Raises InputError if the rig's firmware cannot hold the design or there is no such rig.
    """

    def __init__(self, button: FDVVModel | Program, user: SimulatedUser, rig_name: str = "ideal") -> None:
        self.button, self.user, self.finger = button, user, _finger(user)
        self.travel_mm = button.travel_mm
        self.rig, settings = known_rig(rig_name)
        self.tick_s = self.rig.controller.tick_s
        self._pool = _pool(rig_name)
        self._settled = self._settle(_compiled(button, rig_name), settings)

    @property
    def model(self) -> FDVVModel:
        """Return the model whose force is felt. ModelError of a program, which has more than one."""
        if isinstance(self.button, Program):
            raise ModelError(f"the program {self.button.name} has no one force to feel")
        return self.button

    def press(
        self, random: np.random.Generator, push_ratio: float = 1.0, pace_ratio: float = 1.0
    ) -> PressTrace | None:
        """Press once, in proportion to the person's own push and pace; None if the motion diverged.

        Always takes as many draws.
        """
        gesture = self.draw(random, push_ratio, pace_ratio)
        count = self.ticks_in(BEFORE_s + gesture.press_s + AFTER_s)
        rig = self.settled(random, count)
        rig.press(gesture)
        try:
            ticks = self._until_stop(rig, count, self.ticks_in(BEFORE_s + FIRST_ratio * gesture.press_s))
        except ModelError:
            return None
        return PressTrace(ticks, self.tick_s * np.arange(ticks.t_s.size, dtype=np.float64) - BEFORE_s)

    def settled(self, random: np.random.Generator, count: int) -> InteractiveRig:
        """Return the rig with the finger at rest on it, and noise for so many ticks."""
        return self._settled.copy(self.noise(random, count))

    def noise(self, random: np.random.Generator, count: int) -> Noise:
        """Take so many ticks of the noise that all presses share, from anywhere."""
        at = int(random.integers(POOL_TICKS)) % max(1, POOL_TICKS - count)
        drawn = Noise(*(getattr(self._pool, one.name)[at : at + count] for one in fields(Noise)))
        more = self.user.effort_noise_ratio / Finger().habit.effort_noise_ratio
        return replace(drawn, effort_ratio=more * drawn.effort_ratio)

    def ticks_in(self, duration_s: float) -> int:
        """Count the ticks of a duration."""
        return max(1, round(duration_s / self.tick_s))

    def draw(self, random: np.random.Generator, push_ratio: float = 1.0, pace_ratio: float = 1.0) -> Gesture:
        """Draw a press as the person varies, its movement beginning BEFORE_s after its start."""
        user = self.user
        rest, push, pace, stiff = np.clip(random.standard_normal(4), -3, 3).tolist()
        stiffness = user.stiffness_N_m * max(0.1, 1 + user.stiffness_spread_ratio * stiff)
        pushed_cN = user.push_cN * push_ratio * max(0.1, 1 + user.push_spread_ratio * push)
        travel_m = m_from_mm(self.travel_mm)
        end_m = travel_m + depth_m(self.finger, N_from_cN(pushed_cN), stiffness)
        pace_mm_s = user.pace_mm_s * pace_ratio * max(0.1, 1 + user.pace_spread_ratio * pace)
        # of the person's usual push: who pushes harder goes deeper in the same time
        usual_mm = self._usual_mm(stiffness)
        longer = (usual_mm + self.travel_mm - KEY_mm) / usual_mm
        press_s = max(SHORTEST_s, usual_mm / pace_mm_s * longer ** (1 - user.isochrony_ratio))
        return self._gesture(user.rest_cN + user.rest_spread_cN * rest, end_m, press_s, stiffness)

    @property
    def usual_press_s(self) -> float:
        """How long the person's stroke takes on the usual key."""
        return max(SHORTEST_s, self._usual_mm(self.user.stiffness_N_m) / self.user.pace_mm_s)

    def _usual_mm(self, stiffness: float) -> float:
        return KEY_mm + mm_from_m(depth_m(self.finger, N_from_cN(self.user.push_cN), stiffness))

    def resting(self, rest_cN: float, more_cN: float, grown_s: float) -> Gesture:
        """Return a finger whose force on the cap grows within grown_s, were the cap to hold still."""
        stiffness = self.user.stiffness_N_m
        end_m = depth_m(self.finger, N_from_cN(more_cN), stiffness)
        return self._gesture(rest_cN, end_m, grown_s, stiffness)

    def _gesture(self, rest_cN: float, end_m: float, press_s: float, stiffness: float) -> Gesture:
        start_m = -m_from_mm(self.user.lift_mm)
        if not self.user.lift_mm:
            start_m = depth_m(self.finger, max(0.0, N_from_cN(rest_cN)), stiffness)
        return Gesture(start_m, end_m, BEFORE_s, press_s, HELD_s, press_s, stiffness, self.user.damping_N_s_m)

    def _until_stop(self, rig: InteractiveRig, count: int, first: int) -> InteractiveTicks:
        """Advance by count ticks, or fewer once the cap was at the stop and the key is down."""
        parts, done, travel_mm = [rig.advance(first)], first, self.travel_mm
        while done < count and not (parts[-1].displacement_mm.max() >= travel_mm and parts[-1].key[-1]):
            parts.append(rig.advance(min(self.ticks_in(PIECE_s), count - done)))
            done += parts[-1].t_s.size
        return InteractiveTicks.concatenate(parts)

    def _settle(self, image: bytes, settings: Settings) -> InteractiveRig:
        rig = InteractiveRig(image, self.rig, self.finger, settings, seed=None)
        rig.announce(self.user.pace_mm_s)
        rest = self.resting(self.user.rest_cN, self.user.rest_cN, 1.0)
        rig.press(replace(rest, end_m=rest.start_m))
        rig.advance(self.ticks_in(SETTLE_s))
        return rig
