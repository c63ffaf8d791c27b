"""The twin as a capture bench: a simulated participant presses a simulated button."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from fdvv.device._bench import BenchInfo, Cue
from fdvv.errors import DeviceError, ModelError
from fdvv.recording import Mark, Stage, Take
from fdvv.twin import (
    BOARD,
    PARTICIPANTS,
    ButtonPhysics,
    CaptureBench,
    CaptureRig,
    Finger,
    ForceSensor,
    LEAD_s,
)

GLANCE_s = 0.004
"""Time between two looks at the cue."""


@dataclass(frozen=True)
class Pacing:
    """By which clock a cue is shown; a paced bench takes as long as a person would."""

    now_s: Callable[[], float] = time.monotonic
    sleep: Callable[[float], None] = time.sleep


class TwinBench:
    """A bench, a button and somebody at it, all simulated; a take depends on the seed and its number alone.

    Parameters
    ----------
    button : that is captured.
    participant : one of fdvv.twin.PARTICIPANTS.
    seed : of everything random.
    pacing : shows the cue in its own time; None: as fast as it can, without showing it.
    """

    def __init__(
        self, button: ButtonPhysics, participant: str = "typical", seed: int = 0, pacing: Pacing | None = None
    ) -> None:
        if participant not in PARTICIPANTS:
            raise ModelError(f"participant must be one of {', '.join(PARTICIPANTS)}, got {participant!r}")
        person, random = PARTICIPANTS[participant], np.random.default_rng(seed)
        self._bench = CaptureBench(button, CaptureRig(), Finger(), ForceSensor(), person, random)
        self._person, self._pacing = f"simulated, {participant}, seed {seed}", pacing

    def facts(self) -> BenchInfo:
        """Tell who this is."""
        return BenchInfo("twin", True, self._bench.facts(), self._person)

    def take(self, number: int, stage: Stage, velocity_mm_s: float | None, cue: Cue) -> Take:
        """Make one take; DeviceError on a pace that the bench cannot record."""
        if self._pacing:
            _shown(cue, self._pacing)
        try:
            made = self._bench.take(number, stage, velocity_mm_s)
        except ModelError as error:
            raise DeviceError(f"twin: {error}") from error
        if stage is not Stage.PRESS:
            return made.take
        # the simulated finger sets out when the cue tells of contact
        contact_s = dict(cue.events).get("cue contact", 0.0)
        begun_s = made.truth.begin_s + LEAD_s - contact_s
        told = [Mark(name, BOARD, round(begun_s + t_s, 6)) for name, t_s in cue.events]
        return replace(made.take, marks=(*made.take.marks, *told))

    def close(self) -> None:
        """Let it go."""


def _shown(cue: Cue, pacing: Pacing) -> None:
    begun_s = pacing.now_s()
    while (t_s := pacing.now_s() - begun_s) < cue.length_s:
        cue.show(t_s)
        pacing.sleep(GLANCE_s)
    cue.show(cue.length_s)
