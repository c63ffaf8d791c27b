"""Compensation that knows its rig, on the twin and on the board's own program. Figures are simulated."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fdvv.compensation.identification.rig_file import LearnedRig
from fdvv.compensation.method import Tuning
from fdvv.compensation.rig_aware import RigAware
from fdvv.device.contract import Device
from fdvv.device.twin import TwinDevice
from fdvv.errors import DeviceError, InputError
from fdvv.model.file import load_builtin
from fdvv.model.model import FDVVModel
from fdvv.model.press import Press
from fdvv.model.surface import ForceSurface
from fdvv.protocol.tables import Settings
from fdvv.rendering.compensate import CompensationResult, compensate, start_surface
from fdvv.rendering.probe import probe
from fdvv.rendering.session import Session
from fdvv.rendering.session_log import PRESSES, PressLog
from fdvv.rendering.session_run import Guide
from fdvv.rendering.tuning import open_device
from fdvv.twin.finger import Finger
from fdvv.twin.rig import Rig
from tests.support.rig_truth import draw_fast_rig

MODEL = load_builtin("mx-clear")
SPEEDS = [50.0, 100.0, 150.0, 200.0]
TWO = [50.0, 150.0]


def light_rig(seed: int) -> tuple[Rig, Finger]:
    """Draw a rig with current drive, a mover of 12 g and a loop of 4 kHz, and a finger."""
    rig, finger = draw_fast_rig(seed, "current")
    return replace(rig, mover=replace(rig.mover, mass_kg=0.012)), finger


def judged_cN(rig: Rig, finger: Finger, model: FDVVModel, surface: ForceSurface, tuning: Tuning) -> float:
    """Return the mean over the curves of the mean error on fresh presses, in true displacement."""
    curves = probe(TwinDevice(rig, finger, 9001), model, surface, SPEEDS, 4, tuning=tuning).curves
    return float(np.mean([np.median(c.mean_errors_cN) for c in curves]))


@dataclass(frozen=True)
class Learned:
    """A rig and what was learned on it."""

    rig: Rig
    finger: Finger
    result: CompensationResult

    @property
    def memory(self) -> LearnedRig:
        assert self.result.learned_rig is not None
        return self.result.learned_rig

    def left_cN(self, model: FDVVModel, result: CompensationResult) -> float:
        return judged_cN(self.rig, self.finger, model, result.surface, result.outcome.tuning)

    def before_cN(self, model: FDVVModel) -> float:
        device = TwinDevice(self.rig, self.finger)
        surface = start_surface(device, model, SPEEDS)
        return judged_cN(self.rig, self.finger, model, surface, Tuning())


@pytest.fixture(scope="module", params=[203, pytest.param(206, marks=pytest.mark.slow)])
def learned(request: pytest.FixtureRequest) -> Learned:
    rig, finger = light_rig(request.param)
    return Learned(rig, finger, compensate(TwinDevice(rig, finger, 1), MODEL, SPEEDS, RigAware()))


def test_sixteen_presses_more_than_halve_the_felt_error_on_fresh_presses(learned: Learned) -> None:
    assert learned.result.outcome.presses == 16
    assert learned.result.presses <= 20
    assert learned.left_cN(MODEL, learned.result) < 0.5 * learned.before_cN(MODEL)


def test_an_edited_button_is_rendered_from_the_memory_without_a_press(learned: Learned) -> None:
    # a designer pulls at the middle of every curve
    points = [c.control_points_cN + 10.0 * np.hanning(c.control_points_cN.size) for c in MODEL.curves]
    curves = zip(MODEL.curves, points, strict=True)
    edited = replace(MODEL, curves=tuple(replace(c, control_points_cN=p) for c, p in curves))
    method, device = (
        RigAware(rounds=0, learned_rig=learned.memory),
        TwinDevice(learned.rig, learned.finger, 2),
    )
    result = compensate(device, edited, SPEEDS, method)
    assert (result.presses, len(result.outcome.curves)) == (0, 8)
    assert all("expected" in c.explanation for c in result.outcome.curves)
    assert learned.left_cN(edited, result) < 0.5 * learned.before_cN(edited)


def notices_of(device: Device, memory: LearnedRig, session: Session | None = None) -> list[str]:
    notices = list[str]()
    method = RigAware(rounds=1, learned_rig=memory)
    compensate(device, MODEL, SPEEDS, method, session=session, guide=Guide(notice=notices.append))
    return notices


def test_a_rig_that_has_changed_is_reported_once_after_its_first_press(
    learned: Learned, tmp_path: Path
) -> None:
    worn = replace(learned.rig, mover=replace(learned.rig.mover, mass_kg=0.030))
    session = Session(tmp_path / "s")
    notices = notices_of(TwinDevice(worn, learned.finger, 31), learned.memory, session)
    assert len(notices) == 1
    assert notices[0].startswith("warning: the rig is not as its file says: ")
    assert "mass rose" in notices[0] or "weight rose" in notices[0]
    assert "\n" not in notices[0]
    # a session that is only read again has nothing new to tell of the rig
    again = notices_of(TwinDevice(worn, learned.finger, 31), learned.memory, session)
    assert [text.startswith("the session in") for text in again] == [True]


class PressByPress:
    """A twin whose n-th press depends on n and on what is rendered alone, so that stops leave no trace."""

    def __init__(self, rig: Rig, finger: Finger, done: int = 0, stop_at: int = 0) -> None:
        self._parts, self._made, self._stop_at = (rig, finger), done, stop_at
        self._twin, self._program = TwinDevice(rig, finger), list[Callable[[TwinDevice], None]]()

    def info(self) -> Any:
        return self._twin.info()

    def settings(self) -> Settings:
        return self._twin.settings()

    def configure(self, settings: Settings) -> None:
        self._twin.configure(settings)
        self._program = [lambda twin: twin.configure(settings)]

    def upload(self, surface: ForceSurface, travel_mm: float, paced: bool = False) -> None:
        self._twin.upload(surface, travel_mm, paced)
        self._program = [*self._program[:1], lambda twin: twin.upload(surface, travel_mm, paced)]

    def press(self, velocity_mm_s: float) -> Press:
        if self._made + 1 == self._stop_at:
            raise KeyboardInterrupt
        self._made += 1
        twin = TwinDevice(*self._parts, 500 + self._made)
        for step in self._program:
            step(twin)
        return twin.press(velocity_mm_s)


STOPPED = RigAware(rounds=2)


def run(device: PressByPress, folder: Path | None) -> CompensationResult:
    return compensate(device, MODEL, TWO, STOPPED, session=Session(folder))


@pytest.fixture(scope="module")
def whole() -> CompensationResult:
    """Return the result of a session that was never stopped."""
    return run(PressByPress(*light_rig(203)), None)


STOPS = [3, pytest.param(5, marks=pytest.mark.slow), 7]


@pytest.mark.parametrize("stop_at", STOPS, ids=["meeting the rig", "first on it", "learning"])
def test_a_session_that_was_stopped_goes_on_to_the_result_of_one_that_was_not(
    whole: CompensationResult, tmp_path: Path, stop_at: int
) -> None:
    rig, finger = light_rig(203)
    with pytest.raises(KeyboardInterrupt):
        run(PressByPress(rig, finger, stop_at=stop_at), tmp_path / "s")
    # as if it had been killed while it wrote its last record
    path = tmp_path / "s" / PRESSES
    _, entries, end = PressLog.read(path)
    path.write_bytes(path.read_bytes() + b'{"record": {"press": ')
    again = run(PressByPress(rig, finger, len(entries)), tmp_path / "s")
    assert len(entries) == stop_at - 1
    assert end < path.stat().st_size
    assert again.to_dict() == whole.to_dict()
    np.testing.assert_array_equal(again.surface.press_cN, whole.surface.press_cN)
    np.testing.assert_array_equal(again.surface.release_cN, whole.surface.release_cN)
    assert again.outcome.tuning == whole.outcome.tuning
    assert again.learned_rig is not None
    assert whole.learned_rig is not None
    assert again.learned_rig.rig == whole.learned_rig.rig
    np.testing.assert_array_equal(again.learned_rig.residual.press_cN, whole.learned_rig.residual.press_cN)


def test_a_session_that_goes_on_does_not_tell_again_what_changed(learned: Learned, tmp_path: Path) -> None:
    worn = replace(learned.rig, mover=replace(learned.rig.mover, mass_kg=0.030))
    session = Session(tmp_path / "s")
    with pytest.raises(KeyboardInterrupt):
        notices_of(PressByPress(worn, learned.finger, stop_at=3), learned.memory, session)
    notices = notices_of(PressByPress(worn, learned.finger, done=2), learned.memory, session)
    assert [text.endswith("goes on") for text in notices] == [True]


def test_a_session_with_another_memory_is_another_session(learned: Learned, tmp_path: Path) -> None:
    def begin(memory: LearnedRig) -> CompensationResult:
        device = TwinDevice(learned.rig, learned.finger, 2)
        method = RigAware(rounds=0, learned_rig=memory)
        return compensate(device, MODEL, SPEEDS, method, session=Session(tmp_path / "s"))

    assert begin(learned.memory).receipt is not None
    with pytest.raises(InputError, match=r"settings\.memory\.known\.mass_g is"):
        begin(replace(learned.memory, rig=replace(learned.memory.rig, mass_g=99.0)))


def test_the_boards_own_program_learns_to_the_end(tmp_path: Path) -> None:
    rig = tmp_path / "rig.toml"
    rig.write_text('[keycap_sensor]\nkind = "force"\n')
    session = Session(tmp_path / "s", seed=1, rig=rig)
    device = session.open_device("host")
    try:
        result = compensate(device, MODEL, TWO, RigAware(rounds=1), session=session)
    finally:
        device.close()  # type: ignore[attr-defined] # a board is one that closes
    assert (result.outcome.complete, result.outcome.presses) == (True, 6)
    assert result.learned_rig is not None
    assert result.learned_rig.rig.presses == 4
    assert result.receipt is not None
    assert result.receipt.used == 6
    # the tuning is on the board
    log = PressLog(tmp_path / "s")
    assert {kept.tuning.bandwidth_Hz for kept in list(log.records())[4:]} == {RigAware().bandwidth_Hz}
    log.close()


def test_a_board_without_a_force_sensor_takes_a_memorys_tables_but_is_not_pressed(
    learned: Learned,
) -> None:
    device = open_device("host")
    try:
        result = compensate(device, MODEL, TWO, RigAware(rounds=0, learned_rig=learned.memory))
        assert result.presses == 0
        with pytest.raises(DeviceError, match="no force sensor"):
            compensate(device, MODEL, TWO, RigAware(rounds=1, learned_rig=learned.memory))
    finally:
        device.close()  # type: ignore[attr-defined] # a board is one that closes
