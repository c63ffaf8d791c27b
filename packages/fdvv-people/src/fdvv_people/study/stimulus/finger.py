"""Labels under a simulated finger on the twin, without real time: for simulated participants and tests."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping
from pathlib import Path

from fdvv.errors import ModelError
from fdvv_people.study.plan.plan import Stimulus
from fdvv_people.study.stimulus.renderer import ConstantTimeSwitch, TwinLabels, check_label
from fdvv_studio.live.binary_finger import BinaryFinger
from fdvv_studio.live.press import LivePress
from fdvv_studio.live.press_subject import TABLES_RIG

PACE_mm_s, PACE_SPREAD_ratio = 120.0, 0.12
"""Peak speed of the finger, and its spread between presses: people who follow a pace spread as much."""
PIECE_s, LONGEST_s = 0.02, 2.0
"""How often the finger checks whether it has arrived, and when it gives up."""
ARRIVED_ratio = 0.97  # assumed: at 1 a cap that rests short of the stop takes LONGEST_s; less turns early
UP_mm = 0.05  # below `press.TOP_mm`, where a press ends; at 0 a cap not quite up takes LONGEST_s (assumed)


class SimulatedFingerRenderer(TwinLabels):
    """Presses what is shown on the twin, a fixed number of times. Simulated.

    Parameters
    ----------
    folder : of the study, where its files are.
    presses : of a label each time it is shown.
    rig_name, seed : see TwinLabels.
    switch_s, clock, sleep : see ConstantTimeSwitch; no time passes if left out.

    A fault ends it: show() raises DeviceError from then on.
    """

    def __init__(
        self,
        folder: Path,
        presses: int = 1,
        rig_name: str = TABLES_RIG,
        seed: int = 0,
        switch_s: float = 0.0,
        clock: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], None] = lambda _s: None,
    ) -> None:
        super().__init__(folder, rig_name, seed)
        self._presses, self._switch = presses, ConstantTimeSwitch(switch_s, clock, sleep)

    def prepare(self, labels: Mapping[str, Stimulus]) -> None:
        self._check()
        self._live = {}
        self._prepare(labels)

    def show(self, label: str) -> None:
        """Render a label and press it. Raises InputError on another label, DeviceError after a fault."""
        check_label(label, self._prepared)
        self._check()
        self._switch.make(lambda: None)
        press = self.live(label)
        self._announce(press)
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

    def close(self) -> None:
        self._live = {}
        self.problem = self.problem or "the renderer is closed; open another"

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
            if self.problem or self._piece(label, press, arrived):
                return

    def _piece(self, label: str, press: LivePress, arrived: Callable[[float], bool]) -> bool:
        try:
            columns, events = press.advance(PIECE_s)
        except ModelError as error:
            self._evidence[label].failed("diverged")
            self.problem = f"the twin fell to zero force: {error}"
            return True
        self.problem = self._keep(label, press, columns, events)
        return bool(self.problem) or arrived(float(columns.displacement_mm[-1]))

    def _check(self) -> None:
        if self.problem:
            self._live = {}
        super()._check()
