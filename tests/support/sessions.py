"""A scripted person who presses through a session."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from fdvv.compensation.paper import PaperLaw
from fdvv.compensation.tables import GainSchedule
from fdvv.model.file import load_builtin
from fdvv.model.press import Press
from fdvv.model.surface import ForceSurface
from fdvv.rendering.compensate import CompensationResult, compensate
from fdvv.rendering.session import Session
from fdvv.testing.scripted import ScriptedDevice

MODEL = load_builtin("mx-clear")
SPEEDS = [50.0, 100.0]
LAW = PaperLaw.literal(rounds=1, presses_per_round=4, start="target", gain=GainSchedule.constant(0.4))


class Hand(ScriptedDevice):
    """A person whose n-th press is changed, or ends in an error, as a script says."""

    def __init__(self, script: dict[int, Any] | None = None, **settings: Any) -> None:
        super().__init__(**settings)
        self.script, self.presses, self.uploads, self.stops = script or {}, 0, 0, 0

    def upload(self, surface: ForceSurface, travel_mm: float, paced: bool = False) -> None:
        self.uploads += 1
        super().upload(surface, travel_mm, paced)

    def press(self, velocity_mm_s: float) -> Press:
        self.presses += 1
        happens = self.script.get(self.presses)
        if isinstance(happens, BaseException):
            raise happens
        press = super().press(velocity_mm_s)
        return happens(press) if happens else press

    def stop(self) -> None:
        self.stops += 1


def learn(device: ScriptedDevice, folder: Path | None = None, **more: Any) -> CompensationResult:
    return compensate(device, MODEL, SPEEDS, LAW, session=Session(folder), **more)
