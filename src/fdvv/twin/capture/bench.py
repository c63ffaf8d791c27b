"""A capture bench with somebody at it, simulated: takes as a real one records them, and the truth beside."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.errors import ModelError
from fdvv.recording import Bench, Stage, Take
from fdvv.twin._button import ButtonPhysics
from fdvv.twin._capture_press import Presser
from fdvv.twin._capture_rig import CaptureRig
from fdvv.twin._capture_stand import record_probe
from fdvv.twin._capture_streams import Instruments, Setup, draw_setup
from fdvv.twin._finger import Finger
from fdvv.twin._pace_button import solve_button_pace
from fdvv.twin._participant import Intent, Participant, draw_intent
from fdvv.twin._probe_button import ProbedCurve
from fdvv.twin._rig_senses import ForceSensor
from fdvv.twin._simulate_button import ButtonTrace
from fdvv.units import cN_from_N

APART_s = 4.0
"""A take begins this much after the one before it, give or take 0.2 s."""
REST_s = 1.0
PROBE_mm_s = 0.5


@dataclass(frozen=True, eq=False)
class TakeTruth:
    """What the twin knows of a take and the bench does not.

    Attributes
    ----------
    trace : what happened; its time runs from begin_s. None for a probe.
    probed : what the stand led the cap through; None but for a probe.
    intent : what the participant did.
    begin_s : when the take began, on the board clock.
    setup : of the session; with it the true relation of the clocks.
    """

    trace: ButtonTrace | None
    probed: ProbedCurve | None
    intent: Intent
    begin_s: float
    setup: Setup


@dataclass(frozen=True, eq=False)
class SimulatedTake:
    """A take as the bench wrote it down, and the truth behind it."""

    take: Take
    truth: TakeTruth


class CaptureBench:
    """A bench for one button and one session.

    Parameters
    ----------
    button : that is captured.
    rig, sensor : what the instruments get wrong.
    finger, participant : who presses, and how often it goes wrong.
    random : the session is drawn from it, once: a take depends on its number, stage and pace alone, whatever
        was taken before.
    """

    def __init__(
        self,
        button: ButtonPhysics,
        rig: CaptureRig,
        finger: Finger,
        sensor: ForceSensor,
        participant: Participant,
        random: np.random.Generator,
    ) -> None:
        self.button, self.finger, self.participant = button, finger, participant
        self._seed = int(random.integers(2**63))
        setup = draw_setup(rig, np.random.default_rng(self._seed))
        self._instruments = Instruments(rig, sensor, setup)
        self._presser = Presser(button, finger, sensor, setup.force_zero_N)
        self._pace_s: dict[float, float] = {}

    @property
    def setup(self) -> Setup:
        """How the bench stands in this session: a truth."""
        return self._instruments.setup

    def facts(self) -> Bench:
        """State what its builder knows of the instruments."""
        return bench_facts(self._instruments.rig, self._instruments.sensor)

    def take(self, number: int, stage: Stage, velocity_mm_s: float | None = None) -> SimulatedTake:
        """Make one take: a press at a pace, a slow probe (0.5 mm/s unless said), or the bench at rest.

        Raises ModelError on a press without a pace, or one too slow to end before the next take.
        """
        random = np.random.default_rng([self._seed, number])
        # the board samples on its whole milliseconds
        begin_s = round(APART_s * number + float(random.uniform(-0.2, 0.2)), 3)
        if stage is Stage.PROBE:
            return self._probe(number, velocity_mm_s or PROBE_mm_s, begin_s, random)
        if stage is Stage.REST:
            intent, trace = Intent(), self._presser.rest(REST_s, random)
        else:
            if velocity_mm_s is None:
                raise ModelError("a press needs a pace, got none")
            intent = draw_intent(self.participant, random)
            trace = self._presser.press(self._stroke_s(velocity_mm_s), velocity_mm_s, intent, random)
        if trace.t_s[-1] > APART_s - 0.4:
            raise ModelError(f"a press of {trace.t_s[-1]:.1f} s is too slow for this bench, probe instead")
        streams, marks = self._instruments.record(trace, begin_s, intent, random)
        pace = velocity_mm_s if stage is Stage.PRESS else None
        truth = TakeTruth(trace, None, intent, begin_s, self.setup)
        return SimulatedTake(Take(number, streams, marks, stage, pace), truth)

    def _probe(
        self, number: int, speed_mm_s: float, begin_s: float, random: np.random.Generator
    ) -> SimulatedTake:
        sensor, zero_N = self._instruments.sensor, self.setup.force_zero_N
        streams, marks, curve = record_probe(self.button, sensor, zero_N, speed_mm_s, random)
        take = Take(number, streams, marks, Stage.PROBE, speed_mm_s)
        return SimulatedTake(take, TakeTruth(None, curve, Intent(), begin_s, self.setup))

    def _stroke_s(self, velocity_mm_s: float) -> float:
        if velocity_mm_s not in self._pace_s:
            found_s = solve_button_pace(self.button, self.finger, velocity_mm_s, self._instruments.sensor)
            self._pace_s[velocity_mm_s] = found_s
        return self._pace_s[velocity_mm_s]


def bench_facts(rig: CaptureRig, sensor: ForceSensor) -> Bench:
    """State what a builder knows of a bench: filters and exposure to 0.01 ms, tip to 0.1 g, play 0.1 cN."""
    return Bench(
        force_filter_ms=round(1e3 * sensor.filter_s, 2),
        force_play_cN=round(float(cN_from_N(sensor.hysteresis_N)), 1),
        sound_filter_ms=round(1e3 * rig.sound_filter_s, 2),
        sound_V_s_m=rig.sound_V_s_m,
        tip_mass_g=round(1e3 * sensor.mass_kg, 1),
        exposure_ms=round(1e3 * rig.exposure_s, 2),
    )
