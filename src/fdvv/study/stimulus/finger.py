"""Labels under a simulated finger on the twin, without real time: for simulated participants and tests."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np

from fdvv.errors import DeviceError, ModelError
from fdvv.study import Rendered, Stimulus
from fdvv.workflow._key_hand import KeyHand
from fdvv.workflow._live_event import LiveEventKind
from fdvv.workflow._live_press import LivePress
from fdvv.workflow._press_subject import PRESS_RIGS
from fdvv.workflow._study_stage import EvenSwitch, check_label
from fdvv.workflow._study_stage_evidence import StageEvidence
from fdvv.workflow._study_stage_subject import StagedStimulus, announce, keep, staged

PACE_mm_s, PACE_SPREAD_ratio = 120.0, 0.12
"""Peak speed of the finger, and its spread between presses: people who follow a pace spread as much."""
PIECE_s, LONGEST_s = 0.02, 2.0
"""The finger looks so often whether it has arrived, and gives up after so long."""
ARRIVED_ratio = 0.97
UP_mm = 0.05


class SimulatedFingerStage:
    """Presses what is shown on the twin, as often as it was told to. Simulated.

    Parameters
    ----------
    folder : of the study, where its files are.
    presses : of a label each time it is shown.
    rig_name : shipped rig for stimuli with an actuation; without one the ideal rig renders.
    seed : of everything random. switch_s, clock, sleep : see EvenSwitch; no time passes if left out.

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
        self._switch = EvenSwitch(switch_s, clock, sleep)
        self._random = np.random.default_rng(seed)
        self._staged: dict[str, StagedStimulus] = {}
        self._live: dict[str, LivePress] = {}
        self._evidence: dict[str, StageEvidence] = {}
        self._fault, self._pace_mm_s = "", 0.0

    def prepare(self, labels: Mapping[str, Stimulus]) -> None:
        """Make ready what each label hides, and forget what was rendered before."""
        self._check()
        self._live = {}
        self._staged = {name: staged(labels[name], self._folder, self._rig_name) for name in sorted(labels)}
        self._evidence = {name: StageEvidence(name, of.name, of.model) for name, of in self._staged.items()}

    def show(self, label: str) -> None:
        """Render a label and press it. Raises InputError on another label, DeviceError after a fault."""
        check_label(label, self._staged)
        self._check()
        self._switch.make(lambda: None)
        press = self.live(label)
        announce(press, self._pace_mm_s)
        for _ in range(self._presses):
            self._press_once(label, press)
            self._check()

    def live(self, label: str) -> LivePress:
        """Give the rig under a label, to have it fail or to press it otherwise. Raises InputError."""
        check_label(label, self._staged)
        if label not in self._live:
            seed = int(self._random.integers(2**31))
            self._live[label] = LivePress(self._staged[label].subject, seed)
        return self._live[label]

    def rendered(self) -> tuple[Rendered, ...]:
        """Tell what was rendered since prepare()."""
        return tuple(found.rendered() for found in self._evidence.values())

    def close(self) -> None:
        """Let go of the twin."""
        self._live = {}
        self._fault = self._fault or "the stage is closed; open another"

    def _press_once(self, label: str, press: LivePress) -> None:
        """Go down until the cap is at the stop, and up until it is at the top."""
        travel_mm = self._staged[label].model.travel_mm
        pace = PACE_mm_s * max(0.3, 1 + PACE_SPREAD_ratio * float(self._random.standard_normal()))
        hand = KeyHand(KeyHand.of(press.subject).bottom_mm, pace)
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
        self._fault = keep(evidence, self._staged[label], press, columns, events)
        for event in events:
            if event.kind is LiveEventKind.PRESSED:
                self._pace_mm_s = event.velocity_mm_s
        return bool(self._fault) or arrived(float(columns.displacement_mm[-1]))

    def _check(self) -> None:
        if self._fault:
            self._live = {}
            raise DeviceError(self._fault)
