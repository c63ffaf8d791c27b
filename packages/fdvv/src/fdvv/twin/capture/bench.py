"""A simulated capture bench with a participant and a probing stand: takes, and the truth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.errors import ModelError
from fdvv.recording.types import Bench, Mark, Quantity, Stage, Stream, Take
from fdvv.twin.button import ButtonPhysics
from fdvv.twin.capture.participant import Intent, Participant, Presser, draw_intent
from fdvv.twin.capture.rig import CaptureRig
from fdvv.twin.capture.streams import FORCE_ZERO, Instruments, Setup, draw_setup, quantize
from fdvv.twin.finger import Finger
from fdvv.twin.noise import lsb_of
from fdvv.twin.pace import solve_button_pace
from fdvv.twin.rig import ForceSensor
from fdvv.twin.simulate_button import BEYOND_mm, ButtonTrace, ProbedCurve, probe_button, read_force_N
from fdvv.units import FloatArray, N_from_cN, cN_from_N, mm_from_m

STAND = "stand"
RATE_Hz = 100.0
ABOVE_mm = 0.2
"""The stand begins this far above the cap, and returns there."""
COUNT_mm = 0.001
"""Resolution of its displacement."""
PLACE_mm = 0.1
"""Spread of where its zero lies off the cap's rest."""
APART_s = 4.0
"""A take begins this much after the one before it, give or take 0.2 s."""
REST_s = 1.0  # as fdvv.bench.plan.REST_s: a take of the untouched bench
PROBE_mm_s = 0.5  # as fdvv.bench.plan.PROBE_mm_s: the speed of force testers


def record_probe(
    button: ButtonPhysics, sensor: ForceSensor, zero_N: float, speed_mm_s: float, random: np.random.Generator
) -> tuple[tuple[Stream, ...], tuple[Mark, ...], ProbedCurve]:
    """Lead the cap down to the bottom and back; streams, marks, and the truth."""
    curve = probe_button(button, speed_mm_s, speed_mm_s / RATE_Hz)
    t_s, down_mm, force_cN, bottom = _whole_way(curve, speed_mm_s)
    place_mm = PLACE_mm * float(random.standard_normal())
    noise_N = zero_N + sensor.noise_N * random.standard_normal(t_s.size)
    read_cN = cN_from_N(read_force_N(sensor, N_from_cN(force_cN), noise_N))
    lsb_cN = float(cN_from_N(lsb_of(sensor.full_scale_N, sensor.converter_bits)))
    streams = (
        quantize("force", Quantity.FORCE, STAND, t_s, read_cN, lsb_cN, FORCE_ZERO),
        quantize("displacement", Quantity.DISPLACEMENT, STAND, t_s, down_mm + place_mm, COUNT_mm, 0),
    )
    leaf = button.curve.kind == "leaf"
    close_mm, open_mm = (float(mm_from_m(m)) for m in (button.curve.close_m, button.curve.open_m))
    closed = int(np.argmax(down_mm >= close_mm))
    opened = bottom + int(np.argmax(down_mm[bottom:] < (close_mm if leaf else open_mm)))
    marks = (Mark("closed", STAND, float(t_s[closed])), Mark("open", STAND, float(t_s[opened])))
    return streams, marks, curve


def _whole_way(curve: ProbedCurve, speed_mm_s: float) -> tuple[FloatArray, FloatArray, FloatArray, int]:
    """Join approach, press, release and retreat: time, displacement, force, the row where it turns.

    The rows beyond the bottom, where only the stand bends, are left out.
    """
    apart_mm = float(curve.displacement_mm[1] - curve.displacement_mm[0])
    free_mm = -apart_mm * np.arange(int(ABOVE_mm / apart_mm), 0, -1)
    down_mm = np.concatenate([free_mm, curve.displacement_mm])
    forces = np.concatenate([np.zeros(free_mm.size), curve.press_cN])
    back = np.concatenate([curve.release_cN[::-1], np.zeros(free_mm.size)])
    t_s = apart_mm / speed_mm_s * np.arange(down_mm.size)
    turned_s = t_s[-1] + 2 * BEYOND_mm / speed_mm_s
    times_s, places_mm = np.concatenate([t_s, turned_s + t_s]), np.concatenate([down_mm, down_mm[::-1]])
    return times_s, places_mm, np.concatenate([forces, back]), down_mm.size


@dataclass(frozen=True, eq=False)
class TakeTruth:
    """What the twin knows of a take and the bench does not.

    Attributes
    ----------
    trace : what happened; its time runs from begin_s. None for a probe.
    probed : the curve that the stand measured; None but for a probe.
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
        """Offsets and poses of the bench in this session: a truth."""
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
            stroke_s = solve_button_pace(self.button, self.finger, velocity_mm_s, self._instruments.sensor)
            self._pace_s[velocity_mm_s] = stroke_s
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
