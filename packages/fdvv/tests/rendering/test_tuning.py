"""A tuning reaches the device, the log of presses and the file of an actuation."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fdvv.compensation.method import Trial, Tuning
from fdvv.compensation.paper import PaperLaw
from fdvv.device.boards import LibraryBoard
from fdvv.device.linked import LinkedDevice
from fdvv.device.twin import SimulatedPerson
from fdvv.errors import InputError
from fdvv.model.file import load_builtin
from fdvv.model.press import Press
from fdvv.model.surface import ForceSurface
from fdvv.protocol.tables import Settings
from fdvv.rendering.actuation_file import load_actuation, save_actuation
from fdvv.rendering.compensate import compensate
from fdvv.rendering.probe import probe
from fdvv.rendering.session import Session
from fdvv.rendering.session_log import PRESSES, PressLog
from fdvv.rendering.session_run import prepare
from fdvv.rendering.tuning import settings_with
from fdvv.testing.scripted import ScriptedDevice

MODEL = load_builtin("mx-clear")
SURFACE = ForceSurface.of_model(MODEL, [50.0, 100.0])
OTHER = ForceSurface.of_model(MODEL, [60.0, 100.0])
TUNING = Tuning(100.0, 3e-3, 2e-3, 3.0, 5.0, 20.0, paced=True)


class RecordingDevice(ScriptedDevice):
    """Records settings and uploads, in order."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(**settings)
        self.received: list[Any] = []

    def configure(self, settings: Settings) -> None:
        super().configure(settings)
        self.received.append(settings.predictor_q16)

    def upload(self, surface: ForceSurface, travel_mm: float, paced: bool = False) -> None:
        super().upload(surface, travel_mm, paced)
        self.received.append((surface, paced))


def test_a_tuning_becomes_whole_numbers_at_the_tick_of_the_settings() -> None:
    settings = settings_with(Settings(tick_us=500), TUNING)
    assert settings.predictor_q16 / 2**16 == pytest.approx(1 - np.exp(-2 * np.pi * 100 * 500e-6), abs=1e-5)
    assert (settings.lead_us, settings.brake_lead_us) == (3000, 2000)
    assert (settings.friction_cN64, settings.friction_mm_s16) == (320, 320)
    # 3 N s/m are 0.3 cN per mm/s
    assert settings.drag_q13 / 2**13 * 16 / 64 == pytest.approx(0.3, rel=1e-3)
    tuned = {"predictor_q16", "lead_us", "brake_lead_us", "drag_q13", "friction_cN64", "friction_mm_s16"}
    changed = {name for name, value in vars(settings).items() if value != vars(Settings(tick_us=500))[name]}
    assert changed == tuned


def test_a_tuning_without_bandwidth_turns_the_filter_off_and_touches_nothing_else() -> None:
    assert settings_with(Settings(lead_us=700), Tuning()) == Settings(lead_us=700)
    assert settings_with(settings_with(Settings(), TUNING), Tuning()).predictor_q16 == 0


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"lead_s": 0.03}, "lead_us"),
        ({"drag_N_s_m": 16.0}, "drag_q13"),
        ({"friction_cN": 101.0}, "friction_cN64"),
        ({"friction_mm_s": 1.0}, "friction_mm_s16"),
        ({"bandwidth_Hz": 1e6}, "predictor_q16"),
    ],
)
def test_a_tuning_that_no_device_holds_is_refused_by_name(change: dict[str, Any], field: str) -> None:
    with pytest.raises(InputError, match=field):
        settings_with(Settings(), replace(TUNING, **change))


def test_only_what_differs_is_put_on_a_device_and_settings_come_before_tables() -> None:
    device, plain, tuned = RecordingDevice(), Trial(SURFACE, 50.0), Trial(SURFACE, 50.0, TUNING)
    steps = [
        (plain, [(SURFACE, False)]),  # a device that does nothing by itself is not configured to do so
        (Trial(SURFACE, 100.0), []),
        (tuned, [settings_with(device.settings(), TUNING).predictor_q16, (SURFACE, True)]),
        (Trial(OTHER, 50.0, TUNING), [(OTHER, True)]),
        (Trial(OTHER, 50.0, replace(TUNING, paced=False)), [(OTHER, False)]),
        (Trial(OTHER, 100.0, Tuning()), [0, (OTHER, False)]),
    ]
    before = None
    for trial, wanted in steps:
        device.received.clear()
        prepare(device, trial, 4.0, before)
        assert device.received == wanted
        before = trial


def test_a_device_left_tuned_is_turned_off_for_whoever_does_not_ask_for_it() -> None:
    device = RecordingDevice()
    probe(device, MODEL, SURFACE, [50.0], 1, tuning=TUNING)
    assert device.settings().predictor_q16 > 0
    probe(device, MODEL, SURFACE, [50.0], 1)
    assert device.settings().predictor_q16 == 0


def test_a_probe_is_made_under_its_tuning_and_the_log_tells_which(tmp_path: Path) -> None:
    probe(RecordingDevice(), MODEL, SURFACE, [50.0], 2, session=Session(tmp_path / "t"), tuning=TUNING)
    probe(RecordingDevice(), MODEL, SURFACE, [50.0], 2, session=Session(tmp_path / "n"))
    for name, wanted in (("t", TUNING), ("n", Tuning())):
        log = PressLog(tmp_path / name)
        assert [kept.tuning for kept in log.records()] == [wanted, wanted]
        log.close()
    assert "tuning" not in (tmp_path / "n" / PRESSES).read_text()
    with pytest.raises(InputError, match="tuning"):
        probe(RecordingDevice(), MODEL, SURFACE, [50.0], 2, session=Session(tmp_path / "t"))


class Leaves(LinkedDevice):
    """A board whose person leaves after two presses."""

    left = 2

    def press(self, velocity_mm_s: float) -> Press:
        if not self.left:
            raise KeyboardInterrupt
        self.left -= 1
        return super().press(velocity_mm_s)


def test_a_session_goes_on_with_the_board_that_it_configured(tmp_path: Path) -> None:
    session = Session(tmp_path / "s")
    with Leaves(LibraryBoard(), SimulatedPerson(seed=3)) as board:
        with pytest.raises(KeyboardInterrupt):
            probe(board, MODEL, SURFACE, [50.0], 3, session=session, tuning=TUNING)
        assert board.settings().predictor_q16 > 0
        board.left = 9
        assert probe(board, MODEL, SURFACE, [50.0], 3, session=session, tuning=TUNING).presses == 3


def probed_under(lead_s: float, folder: Path) -> Session:
    """Return a session of two presses whose file holds this lead."""
    probe(RecordingDevice(), MODEL, SURFACE, [50.0], 2, session=Session(folder), tuning=TUNING)
    log = PressLog(folder)
    found = [replace(kept, tuning=replace(kept.tuning, lead_s=lead_s)) for kept in log.records()]
    run = log.runs[0]
    log.close()
    (folder / PRESSES).unlink()
    log = PressLog(folder)
    log.begin(run)
    for kept in found:
        log.add(kept)
    log.close()
    return Session(folder)


def test_presses_made_under_another_tuning_do_not_count(tmp_path: Path) -> None:
    session = probed_under(TUNING.lead_s * 1.001, tmp_path / "s")
    with pytest.raises(InputError, match="another table or tuning"):
        probe(RecordingDevice(), MODEL, SURFACE, [50.0], 2, session=session, tuning=TUNING)


def test_presses_of_a_processor_that_rounds_otherwise_count(tmp_path: Path) -> None:
    session = probed_under(TUNING.lead_s * (1 + 1e-14), tmp_path / "s")
    assert probe(RecordingDevice(), MODEL, SURFACE, [50.0], 2, session=session, tuning=TUNING).presses == 2


@pytest.fixture(scope="module")
def actuation(tmp_path_factory: pytest.TempPathFactory) -> Path:
    law = PaperLaw.literal(rounds=1, presses_per_round=2, start="target")
    result = compensate(ScriptedDevice(), MODEL, [50.0], law)
    path = tmp_path_factory.mktemp("learned") / "clear.actuation.json"
    save_actuation(replace(result, outcome=replace(result.outcome, tuning=TUNING)), path)
    return path


def test_a_file_from_before_tunings_has_none(actuation: Path, tmp_path: Path) -> None:
    found = json.loads(actuation.read_text())
    del found["tuning"]
    (tmp_path / "old.actuation.json").write_text(json.dumps(found))
    assert load_actuation(tmp_path / "old.actuation.json").outcome.tuning == Tuning()


@pytest.mark.parametrize(
    ("tuning", "reason"),
    [({"leads": 1.0}, "leads"), ({"lead_s": -1.0}, "at least 0"), ({"lead_s": "long"}, "tuning")],
)
def test_a_tuning_that_is_none_is_refused_in_one_line(
    actuation: Path, tmp_path: Path, tuning: dict[str, Any], reason: str
) -> None:
    path = tmp_path / "bad.actuation.json"
    path.write_text(json.dumps({**json.loads(actuation.read_text()), "tuning": tuning}))
    with pytest.raises(InputError, match=reason) as caught:
        load_actuation(path)
    assert "\n" not in str(caught.value)
