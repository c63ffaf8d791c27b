"""A small simulated recording and what was made of it, once for all tests that look at one."""

from __future__ import annotations

import functools
from dataclasses import replace

import numpy as np

from fdvv.bench.model import RecordedModel, model_of_recording
from fdvv.recording.types import Quantity, Recording, Stage, Take
from fdvv.twin.capture.bench import CaptureBench
from fdvv.twin.capture.participant import PARTICIPANTS
from fdvv.twin.capture.rig import CaptureRig
from fdvv.twin.files import load_button
from fdvv.twin.finger import Finger
from fdvv.twin.rig import ForceSensor

PLAN: tuple[tuple[Stage, float | None, int], ...] = (
    (Stage.REST, None, 1),
    (Stage.PROBE, None, 2),
    (Stage.PRESS, 50.0, 5),
    (Stage.PRESS, 150.0, 7),
)
SHORT_STROKE = 12
"""Number of a take whose press did not reach the bottom."""


@functools.cache
def capture(plan: tuple[tuple[Stage, float | None, int], ...] = PLAN) -> Recording:
    """Record presses by a plan, by default at two paces after two probes; one press is cut short."""
    random = np.random.default_rng(7)
    bench = CaptureBench(
        load_button("mx-clear"), CaptureRig(), Finger(), ForceSensor(), PARTICIPANTS["steady"], random
    )
    stages = [(stage, pace) for stage, pace, count in plan for _ in range(count)]
    takes = [unshaken(bench.take(number, *what).take) for number, what in enumerate(stages, 1)]
    takes[SHORT_STROKE - 1] = shallower(takes[SHORT_STROKE - 1])
    return Recording("mx-clear", tuple(takes), bench.facts(), simulated=True)


def unshaken(take: Take) -> Take:
    """Leave the accelerometer out: what the paper's bench had is force, sound, two markers and the light."""
    return replace(take, streams=tuple(s for s in take.streams if s.quantity is not Quantity.ACCELERATION))


def shallower(take: Take) -> Take:
    """Make the cap of a take go four fifths of its way."""
    streams = tuple(
        replace(s, raw=np.nanmedian(s.raw[:20], axis=0) + 0.8 * (s.raw - np.nanmedian(s.raw[:20], axis=0)))
        if s.quantity is Quantity.MARKER
        else s
        for s in take.streams
    )
    return replace(take, streams=streams)


@functools.cache
def recorded() -> RecordedModel:
    """Make the model of the small recording."""
    return model_of_recording(capture())
