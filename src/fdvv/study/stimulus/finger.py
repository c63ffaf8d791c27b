"""Labels under a simulated finger on the twin, without real time: for simulated participants and tests."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np

from fdvv.errors import DeviceError, ModelError
from fdvv.live.binary_finger import BinaryFinger
from fdvv.live.press import LiveEventKind, LivePress
from fdvv.live.press_subject import PRESS_RIGS
from fdvv.study.plan.plan import Stimulus
from fdvv.study.plan.trial import Rendered
from fdvv.study.stimulus.evidence import RenderingEvidence
from fdvv.study.stimulus.renderer import (
    ConstantTimeSwitch,
    PreparedStimulus,
    announce,
    check_label,
    keep,
    prepare_stimulus,
)

PACE_mm_s, PACE_SPREAD_ratio = 120.0, 0.12
"""Peak speed of the finger, and its spread between presses: people who follow a pace spread as much."""
PIECE_s, LONGEST_s = 0.02, 2.0
"""How often the finger checks whether it has arrived, and when it gives up."""
ARRIVED_ratio = 0.97
UP_mm = 0.05


class SimulatedFingerRenderer:
    """Presses what is shown on the twin, a fixed number of times. Simulated.

    Parameters
    ----------
    folder : of the study, where its files are.
    presses : of a label each time it is shown.
    rig_name : shipped rig for stimuli with an actuation; without one the ideal rig renders.
    seed : of everything random. switch_s, clock, sleep : see ConstantTimeSwitch; no time passes if left out.

    A fault ends it: show() raises DeviceError from then on.
    """

    simulated, person = True, False

    def __init__(
        self,
        folder: Path,
        presses: int = 1,
        rig_name: str = PRESS_RIGS[0],
        seed: int = 0,
        switch_s: float = 0.0,
        clock: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], None] = lambda _s: None,
    ) -> None:
        self._folder, self._presses, self._rig_name, self._seed = folder, presses, rig_name, seed
        self._switch = ConstantTimeSwitch(switch_s, clock, sleep)
        self._random = np.random.default_rng(seed)
        self._prepared: dict[str, PreparedStimulus] = {}
        self._live: dict[str, LivePress] = {}
        self._evidence: dict[str, RenderingEvidence] = {}
        self._fault, self._pace_mm_s = "", 0.0

    def prepare(self, labels: Mapping[str, Stimulus]) -> None:
        """Prepare the stimulus of each label, and clear the record."""
        self._check()
        self._live = {}
        self._prepared = {
            name: prepare_stimulus(labels[name], self._folder, self._rig_name) for name in sorted(labels)
        }
        self._evidence = {
            name: RenderingEvidence(name, of.name, of.model) for name, of in self._prepared.items()
        }

    def show(self, label: str) -> None:
        """Render a label and press it. Raises InputError on another label, DeviceError after a fault."""
        check_label(label, self._prepared)
        self._check()
        self._switch.make(lambda: None)
        press = self.live(label)
        announce(press, self._pace_mm_s)
        for _ in range(self._presses):
            self._press_once(label, press)
            self._check()

    def live(self, label: str) -> LivePress:
        """Return the rig under a label, for tests that make it fail or press it otherwise. InputError."""
        check_label(label, self._prepared)
        if label not in self._live:
            seed = int(self._random.integers(2**31))
            self._live[label] = LivePress(self._prepared[label].subject, seed)
        return self._live[label]

    def rendered(self) -> tuple[Rendered, ...]:
        """Return the record since prepare()."""
        return tuple(found.rendered() for found in self._evidence.values())

    def close(self) -> None:
        """Release the twin."""
        self._live = {}
        self._fault = self._fault or "the renderer is closed; open another"

    def _press_once(self, label: str, press: LivePress) -> None:
        travel_mm = self._prepared[label].model.travel_mm
        pace = PACE_mm_s * max(0.3, 1 + PACE_SPREAD_ratio * float(self._random.standard_normal()))
        hand = BinaryFinger(BinaryFinger.of(press.subject).bottom_mm, pace)
        hand.down(press)
        self._let_pass(label, press, lambda x: x >= ARRIVED_ratio * travel_mm)
        hand.up(press)
        self._let_pass(label, press, lambda x: x <= UP_mm)
        self._let_pass(label, press, lambda _x: True)

    def _let_pass(self, label: str, press: LivePress, arrived: Callable[[float], bool]) -> None:
        for _ in range(math.ceil(LONGEST_s / PIECE_s)):
            if self._fault or self._piece(label, press, arrived):
                return

    def _piece(self, label: str, press: LivePress, arrived: Callable[[float], bool]) -> bool:
        evidence = self._evidence[label]
        try:
            columns, events = press.advance(PIECE_s)
        except ModelError as error:
            evidence.failed("diverged")
            self._fault = f"the twin fell to zero force: {error}"
            return True
        self._fault = keep(evidence, self._prepared[label], press, columns, events)
        for event in events:
            if event.kind is LiveEventKind.PRESSED:
                self._pace_mm_s = event.velocity_mm_s
        return bool(self._fault) or arrived(float(columns.displacement_mm[-1]))

    def _check(self) -> None:
        if self._fault:
            self._live = {}
            raise DeviceError(self._fault)
