"""The streams that the instruments of a simulated bench record of a press."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fdvv.errors import ModelError
from fdvv.recording.types import Mark, Quantity, Stream
from fdvv.twin.capture.participant import Intent
from fdvv.twin.capture.rig import CaptureRig
from fdvv.twin.noise import lsb_of
from fdvv.twin.rig import ForceSensor
from fdvv.twin.simulate_button import ButtonTrace
from fdvv.units import FloatArray, cN_from_N, m_from_mm, mm_from_m

BOARD, CAMERA = "board", "camera"
"""The clocks: of the microcontroller, which runs true, and of the cameras."""
MARKERS = ("left", "right")
FORCE_ZERO = 102
"""Count of the force's converter at no force, as stated."""
BLINKS_s = ((0.0, 0.009), (0.020, 0.035), (0.048, 0.057), (0.076, 0.088))
"""The light goes on and off, from its first edge: spaced unevenly, each longer than two frames."""
LIGHTS = ("light on", "light off")


@dataclass(frozen=True, eq=False)
class Setup:
    """Offsets and poses of the bench in one session; drawn once.

    Attributes
    ----------
    camera_offset_s, camera_ratio : the camera clock reads offset + ratio * board clock.
    phase_s : of the frames, on the camera clock.
    turn : (3, 3) from the cap's axes (the third points out of the button) to the cameras'.
    places_mm : (2, 3) of the markers, the cap at rest.
    force_zero_N : where the force sensor's zero lies off what is stated.
    """

    camera_offset_s: float
    camera_ratio: float
    phase_s: float
    turn: FloatArray
    places_mm: FloatArray
    force_zero_N: float

    def camera_s(self, board_s: FloatArray) -> FloatArray:
        """Return what the camera clock reads when the board clock reads board_s."""
        return np.asarray(self.camera_offset_s + self.camera_ratio * board_s)


def draw_setup(rig: CaptureRig, random: np.random.Generator) -> Setup:
    """Set the bench up."""
    from scipy.spatial.transform import Rotation

    turn = Rotation.from_rotvec(rig.askew_rad * random.standard_normal(3)).as_matrix()
    levers = mm_from_m(_levers_m(rig))
    origin = np.array([*random.uniform(-60.0, 60.0, 2), random.uniform(20.0, 60.0)])
    return Setup(
        float(random.uniform(5.0, 60.0)),
        1 + 1e-6 * rig.clock_ppm * float(random.standard_normal()),
        float(random.random()) / rig.frame_Hz,
        turn,
        origin + np.outer(levers, turn[:, 0]),
        rig.force_zero_N * float(random.standard_normal()),
    )


def _levers_m(rig: CaptureRig) -> FloatArray:
    uneven = rig.lever_mismatch_ratio / 2
    return np.asarray(rig.lever_m * np.array([1 + uneven, uneven - 1]))


@dataclass(frozen=True, eq=False)
class Instruments:
    """The instruments of one bench in one session."""

    rig: CaptureRig
    sensor: ForceSensor
    setup: Setup

    def record(
        self, trace: ButtonTrace, begin_s: float, intent: Intent, random: np.random.Generator
    ) -> tuple[tuple[Stream, ...], tuple[Mark, ...]]:
        """Record a press that began at begin_s of the board clock; the trace needs a worn force sensor."""
        if trace.sensed_cN is None:
            raise ModelError("a capture needs a press with a force sensor, this finger was bare")
        blinks_s = np.round(begin_s + float(random.uniform(0.005, 0.02)) + np.array(BLINKS_s), 6)
        event_s = _event_s(trace, intent)
        board = (self._force(trace, begin_s, intent, event_s), self._sound(trace, begin_s, random))
        camera = self._camera(trace, begin_s, blinks_s, intent, event_s, random)
        lights = [
            Mark(name, BOARD, float(s)) for pair in blinks_s for name, s in zip(LIGHTS, pair, strict=True)
        ]
        return (*board, *camera, *self._shake(trace, begin_s, random)), (*lights, *_switching(trace, begin_s))

    # -- on the board's clock --

    def _force(self, trace: ButtonTrace, begin_s: float, intent: Intent, event_s: float) -> Stream:
        assert trace.sensed_cN is not None
        t_s, sensed_cN = trace.t_s[trace.tick], trace.sensed_cN[trace.tick]
        if intent.kind == "sensor slipped":
            sensed_cN = np.where(t_s < event_s, 1.0, intent.amount) * sensed_cN
        lsb_cN = float(cN_from_N(lsb_of(self.sensor.full_scale_N, self.sensor.converter_bits)))
        return quantize("force", Quantity.FORCE, BOARD, begin_s + t_s, sensed_cN, lsb_cN, FORCE_ZERO)

    def _sound(self, trace: ButtonTrace, begin_s: float, random: np.random.Generator) -> Stream:
        """Hear cap and plate in the near field, without a filter against aliases but the RC."""
        from scipy.signal import lfilter

        rig, step_s = self.rig, float(trace.t_s[1] - trace.t_s[0])
        heard = rig.sound_V_s_m * m_from_mm(trace.velocity_mm_s + trace.plate_velocity_mm_s)
        keep = math.exp(-2 * math.pi * rig.sound_low_Hz * step_s)
        heard = lfilter([1.0, -1.0], [1.0, -keep], heard) if rig.sound_low_Hz else heard
        fade = math.exp(-step_s / rig.sound_filter_s) if rig.sound_filter_s else 0.0
        heard = lfilter([1 - fade], [1.0, -fade], heard)
        t_s = np.arange(int(trace.t_s[-1] * rig.sound_Hz + 1e-9) + 1) / rig.sound_Hz
        volts = np.interp(t_s, trace.t_s, heard) + rig.sound_noise_V * random.standard_normal(t_s.size)
        half = rig.sound_range_V / 2
        lsb_V = lsb_of(rig.sound_range_V, rig.sound_bits)
        middle = 2 ** (rig.sound_bits - 1) if rig.sound_bits else 0
        volts = np.clip(volts, -half, half - lsb_V)
        return quantize("sound", Quantity.SOUND, BOARD, begin_s + t_s, volts, lsb_V, middle)

    def _shake(self, trace: ButtonTrace, begin_s: float, random: np.random.Generator) -> tuple[Stream, ...]:
        """Feel the housing shake, if the bench has an accelerometer on it."""
        rig = self.rig
        if not rig.shake_Hz:
            return ()
        t_s = np.arange(int(trace.t_s[-1] * rig.shake_Hz + 1e-9) + 1) / rig.shake_Hz
        shaken_m_s2 = np.gradient(m_from_mm(trace.plate_velocity_mm_s), trace.t_s)
        shaken = np.interp(t_s, trace.t_s, shaken_m_s2) + rig.shake_noise_m_s2 * random.standard_normal(
            t_s.size
        )
        shake = quantize("shake", Quantity.ACCELERATION, BOARD, begin_s + t_s, shaken, rig.shake_step_m_s2, 0)
        return (shake,)

    # -- on the cameras' clock --

    def _camera(
        self, trace: ButtonTrace, begin_s: float, blinks_s: FloatArray, intent: Intent, event_s: float,
        random: np.random.Generator,
    ) -> tuple[Stream, ...]:  # fmt: skip
        rig = self.rig
        own_s = self._frames_s(begin_s, begin_s + float(trace.t_s[-1]) - rig.exposure_s)
        at_s = (own_s - self.setup.camera_offset_s) / self.setup.camera_ratio
        places_mm = self._places_mm(trace, at_s - begin_s, random)
        lit = _part_lit(at_s, blinks_s, rig.exposure_s) + rig.light_noise * random.standard_normal(at_s.size)
        unseen = random.random((2, at_s.size)) < rig.unseen_ratio
        kept = random.random(at_s.size) >= rig.dropped_ratio
        way = random.standard_normal(3)
        after = at_s - begin_s >= event_s
        if intent.kind == "marker knocked":
            places_mm[intent.marker, after] += intent.amount * way / np.linalg.norm(way)
        if intent.kind == "marker hidden":
            unseen[intent.marker] |= after & (at_s - begin_s < event_s + intent.amount)
        places_mm[unseen] = np.nan
        seen = [
            Stream(name, Quantity.MARKER, CAMERA, own_s[kept], places[kept])
            for name, places in zip(MARKERS, places_mm, strict=True)
        ]
        return (*seen, Stream("light", Quantity.LIGHT, CAMERA, own_s[kept], lit[kept]))

    def _frames_s(self, first_s: float, last_s: float) -> FloatArray:
        """Return the cameras' times of the frames that begin between two times of the board."""
        span = self.setup.camera_s(np.array([first_s, last_s])) - self.setup.phase_s
        first, last = math.ceil(span[0] * self.rig.frame_Hz), math.floor(span[1] * self.rig.frame_Hz)
        return np.asarray(self.setup.phase_s + np.arange(first, last + 1) / self.rig.frame_Hz)

    def _places_mm(self, trace: ButtonTrace, at_s: FloatArray, random: np.random.Generator) -> FloatArray:
        """See the two markers, (2, frames, 3): exposure, rocking, play, bias, noise."""
        rig = self.rig
        down_m = m_from_mm(_average_exposure(trace.t_s, trace.displacement_mm, at_s, rig.exposure_s))
        part = np.clip(down_m / max(float(down_m.max()), 1e-4), 0.0, 1.0)
        tilt = rig.rocking_rad * float(random.uniform(-1.0, 1.0)) * part
        angle = float(random.uniform(0.0, 2 * math.pi))
        across_m = rig.sideways_m * part[:, None] * np.array([math.cos(angle), math.sin(angle)])
        bias_m = rig.marker_bias_m * random.standard_normal(3)
        moved_m = np.empty((2, at_s.size, 3))
        moved_m[..., :2] = across_m
        moved_m[..., 2] = -(down_m + np.sin(tilt) * _levers_m(rig)[:, None])
        moved_m = moved_m @ self.setup.turn.T + bias_m
        moved_m += rig.marker_noise_m * random.standard_normal(moved_m.shape)
        return self.setup.places_mm[:, None, :] + mm_from_m(moved_m)


def quantize(
    name: str, quantity: Quantity, clock: str, t_s: FloatArray, values: FloatArray, lsb: float, zero: int
) -> Stream:
    """Write values as counts of a converter, or as they are where it is continuous (lsb 0)."""
    if not lsb:
        return Stream(name, quantity, clock, t_s, values)
    raw = (np.floor(values / lsb + 0.5) + zero).astype(np.int16)
    return Stream(name, quantity, clock, t_s, raw, lsb, zero)


def _event_s(trace: ButtonTrace, intent: Intent) -> float:
    level_mm = intent.part * float(trace.displacement_mm.max())
    return float(trace.t_s[np.argmax(trace.displacement_mm >= level_mm)])


def _switching(trace: ButtonTrace, begin_s: float) -> list[Mark]:
    """Mark where the circuit closes and opens, as the microcontroller samples it."""
    sampled, t_s = trace.closed[trace.tick], begin_s + trace.t_s[trace.tick]
    turns = np.flatnonzero(np.diff(sampled.astype(np.int8))) + 1
    return [Mark("closed" if sampled[i] else "open", BOARD, float(t_s[i])) for i in turns]


def _average_exposure(t_s: FloatArray, values: FloatArray, at_s: FloatArray, exposure_s: float) -> FloatArray:
    if exposure_s == 0:
        return np.interp(at_s, t_s, values)
    area = np.append(0.0, np.cumsum(0.5 * (values[1:] + values[:-1]) * np.diff(t_s)))
    edges = np.interp(np.stack([at_s, at_s + exposure_s]), t_s, area)
    return np.asarray((edges[1] - edges[0]) / exposure_s)


def _part_lit(at_s: FloatArray, blinks_s: FloatArray, exposure_s: float) -> FloatArray:
    if exposure_s == 0:
        return np.asarray(sum((at_s >= on) & (at_s < off) for on, off in blinks_s), dtype=np.float64)
    shared = [np.minimum(at_s + exposure_s, off) - np.maximum(at_s, on) for on, off in blinks_s]
    return np.asarray(np.clip(np.array(shared) / exposure_s, 0.0, 1.0).sum(axis=0))
