"""The self-test of a rig, on the firmware in lockstep with simulated rigs that are sound or broken."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from fdvv.device.boards import LibraryBoard
from fdvv.device.linked import LinkedDevice
from fdvv.device.telemetry import TickColumns
from fdvv.errors import DeviceError, InputError
from fdvv.protocol.tables import Settings
from fdvv.twin.rig import Rig
from fdvv_rig.selftest.diagnosis import Diagnosis, diagnose
from fdvv_rig.selftest.evidence import Evidence
from fdvv_rig.selftest.faults import RIG_FAULTS, SLOW_PWM_Hz
from fdvv_rig.selftest.measure import line_um, measure_rig
from fdvv_rig.selftest.open import open_rig, with_sensor
from fdvv_rig.selftest.operator import SOUND, PromptedOperator, SimulatedOperator
from fdvv_rig.selftest.receipt import calibrated, changed, read_selftest, write_selftest

HEAD = {"device": "host", "serial": 1, "simulated": True, "tested": "2026-01-01T00:00:00", "settings": {}}


def trial(fault: str | None = None, seed: int = 0) -> tuple[Evidence, Diagnosis]:
    hands = SimulatedOperator(with_sensor(Rig()), seed, RIG_FAULTS[fault] if fault else SOUND)
    device = LinkedDevice(LibraryBoard(), hands)
    try:
        before = device.settings()
        evidence = measure_rig(device, hands)
        assert device.settings() == before
    finally:
        device.close()
    return evidence, diagnose(evidence)


@pytest.fixture(scope="module")
def sound() -> tuple[Evidence, Diagnosis]:
    return trial()


def test_a_sound_rig_passes_and_its_receipt_can_be_read_again(
    sound: tuple[Evidence, Diagnosis], tmp_path: Path
) -> None:
    evidence, found = sound
    assert found.passed, found.wrong
    write_selftest(tmp_path / "r.json", found, evidence, HEAD)
    receipt, again = read_selftest(tmp_path / "r.json")
    assert receipt.device == "host"
    assert diagnose(again) == found


def test_a_receipt_whose_evidence_was_changed_is_refused(
    sound: tuple[Evidence, Diagnosis], tmp_path: Path
) -> None:
    evidence, found = sound
    path = tmp_path / "r.json"
    write_selftest(path, found, evidence, HEAD)
    document = json.loads(path.read_text())
    document["evidence"]["gauge_mm"] = [3.0, 1.3]
    path.write_text(json.dumps(document))
    with pytest.raises(InputError, match="position sensor: wrong scale"):
        read_selftest(path)
    del document["evidence"]["gauge_mm"], document["evidence"]["empty"]
    path.write_text(json.dumps(document))
    with pytest.raises(InputError, match="is not whole"):
        read_selftest(path)


def test_a_failed_test_leaves_no_receipt(sound: tuple[Evidence, Diagnosis], tmp_path: Path) -> None:
    evidence, found = trial("position-off")
    assert found.wrong is not None
    assert found.wrong.part == "position sensor"
    for passed in (found, sound[1]):  # not even beside another's verdict
        with pytest.raises(DeviceError, match="no receipt is written"):
            write_selftest(tmp_path / "r.json", passed, evidence, HEAD)
    assert list(tmp_path.iterdir()) == []


def test_calibration_takes_out_what_gauges_and_weight_have_shown(sound: tuple[Evidence, Diagnosis]) -> None:
    import dataclasses

    evidence, _ = sound
    settings = SimulatedOperator(with_sensor(Rig())).settings
    off = dataclasses.replace(
        evidence, gauge_mm=(4.5 * 1.05 + 0.1, 2.0 * 1.05 + 0.1), sensor_zero_cN=2.0, sensor_weight_cN=47.0
    )
    better = calibrated(settings, off)

    def place_mm(found: Settings, sum_: float) -> float:
        gain, zero = found.position_gain_q14, found.position_offset_um16
        return float(sum_ * gain / 2**14 + zero) / 16000

    for seen_mm, true_mm in ((4.5 * 1.05 + 0.1, 4.5), (2.0 * 1.05 + 0.1, 2.0)):
        counts = (seen_mm * 16000 - settings.position_offset_um16) * 2**14 / settings.position_gain_q14
        assert place_mm(better, counts) == pytest.approx(true_mm, abs=2e-3)
    for seen_cN, true_cN in ((2.0, 0.0), (47.0, off.weight_cN)):
        counts = settings.force_offset_counts + seen_cN * 64 * 2**14 / settings.force_gain_q14
        found = (counts - better.force_offset_counts) * better.force_gain_q14 / 2**14 / 64
        assert found == pytest.approx(true_cN, abs=0.3)
    assert set(changed(settings, better)) >= {"position_gain_q14", "position_offset_um16", "duty_gain_q16"}


def test_a_line_of_known_height_is_found() -> None:
    t_s = np.arange(800) * 1e-3
    for frequency in (310.0, SLOW_PWM_Hz):  # the second lies above half the rate of ticks
        place = 2.0 + 0.3 * t_s + 0.004 * np.sin(2 * np.pi * frequency * t_s + 0.7)
        none = np.zeros(800)
        telemetry = TickColumns(np.arange(800), place, none, none, none, none.astype(int), none.astype(int))
        assert line_um(telemetry, 1e-3, frequency) == pytest.approx(4.0, rel=0.02)
        assert line_um(telemetry, 1e-3, frequency + 40) < 0.1


def test_a_real_rig_is_neither_drawn_nor_broken_on_purpose(tmp_path: Path) -> None:
    for options in ({"fault": "coil-open"}, {"rig": tmp_path / "rig.toml"}):
        with pytest.raises(InputError, match="a real rig is as it is"):
            open_rig("serial:none", print, **options)
    for spec, words in (("nothing", "names no device"), ("emulated:no.elf", "no such file")):
        with pytest.raises(InputError, match=words):
            open_rig(spec, print)
    with pytest.raises(InputError, match="is unknown; use one of coil-reversed"):
        open_rig("twin", print, fault="nothing")


def test_a_person_is_asked_for_every_gauge_and_weight() -> None:
    said: list[str] = []
    hands = PromptedOperator(said.append)
    hands.gauge(2.0)
    hands.let_go()
    hands.gauge(None)
    hands.weight(50.0)
    hands.weight(None)
    assert [text.split()[0] for text in said] == ["Lay", "Take", "Lay", "Take"]
    assert "2 mm" in said[0]
    assert "50 g" in said[2]


@pytest.mark.slow
@pytest.mark.parametrize("fault", RIG_FAULTS)
def test_the_part_that_is_wrong_is_named(fault: str) -> None:
    _, found = trial(fault, seed=7)
    assert found.wrong is not None
    assert found.wrong.part == RIG_FAULTS[fault].part


@pytest.mark.slow
@pytest.mark.parametrize("spec", ["twin", "host"])
def test_every_board_with_the_firmware_in_it_is_tested_alike(spec: str) -> None:
    ran: list[tuple[str, int, int]] = []
    say: Callable[[str, int, int], None] = lambda *one: ran.append(one)  # noqa: E731
    device, hands = open_rig(spec, print)
    try:
        assert diagnose(measure_rig(device, hands, say)).passed
    finally:
        device.close()
    assert ran[-1] == ("exciter", 7, 7)
