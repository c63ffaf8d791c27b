"""A session on a rig with a part at fault, planted behind the real firmware core: named, and kept apart."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from fdvv.compensation.rig_aware import RigAware
from fdvv.device.linked import LinkedDevice
from fdvv.device.twin import TwinDevice
from fdvv.errors import DeviceError, PartFaultError
from fdvv.model.file import load_builtin
from fdvv.protocol.tables import Settings
from fdvv.rendering.compensate import CompensationResult, compensate
from fdvv.rendering.part_check import CHECK_cN
from fdvv.rendering.part_watch import watch_of
from fdvv.rendering.session import Session
from fdvv.rendering.session_log import PRESSES, PressLog
from fdvv.rendering.session_run import Guide
from fdvv.twin.finger import Finger
from fdvv.twin.rig import Rig
from tests.support.rig_faults import PLANTED, PlantedPerson, WatchedBoard

MODEL = load_builtin("mx-clear")
SPEEDS = (50.0, 100.0)
LIGHT = Rig()
RIG = replace(
    LIGHT, mover=replace(LIGHT.mover, mass_kg=0.015), keycap_sensor=replace(LIGHT.keycap_sensor, kind="force")
)
FINGER = replace(Finger(), habit=replace(Finger().habit, push_N=1.5))


class Bench:
    """A board and a person at a rig, with what was asked and said."""

    def __init__(self, name: str = "", begins: int = 0, seed: int = 3, folder: Path | None = None) -> None:
        self.board = WatchedBoard()
        self.person = PlantedPerson(RIG, FINGER, seed, PLANTED.get(name), begins)
        self.folder = folder
        self.asked: list[float] = []
        self.notices: list[str] = []

    def ask(self, _ask: object) -> None:
        self.asked.append(self.board.largest_cN)

    def learn(self) -> CompensationResult:
        """Run a session of four presses after the check's one."""
        guide = Guide(self.ask, self.notices.append)
        with LinkedDevice(self.board, self.person) as device:
            return compensate(device, MODEL, SPEEDS, RigAware(0), session=Session(self.folder), guide=guide)

    def named(self) -> PartFaultError:
        with pytest.raises(PartFaultError) as caught:
            self.learn()
        return caught.value


def test_a_sound_rig_is_learned_after_one_press_more_and_no_large_command_before_it() -> None:
    bench = Bench()
    assert bench.learn().skipped == ()
    check, first, *_ = bench.asked
    assert max(check, first) <= CHECK_cN
    assert bench.board.largest_cN > CHECK_cN
    assert bench.person.presses == 1 + 4
    assert bench.notices[0].startswith("first the rig's parts are checked, at 30 cN at most")


@pytest.mark.parametrize(
    ("name", "presses"),
    [
        ("coil reversed", 0),
        ("position reversed", 0),
        ("vibration cable off", 0),
        ("limiter stuck", 0),
        ("force sensor reversed", 1),
        ("force sensor dead", 1),
        ("mover stuck", 1),
        ("position frozen", 1),
    ],
)
def test_what_is_wired_wrongly_is_named_by_the_check_at_small_forces(name: str, presses: int) -> None:
    bench = Bench(name)
    assert bench.named().fault.part in PLANTED[name].parts
    assert bench.person.presses <= presses
    assert bench.board.largest_cN <= CHECK_cN


def test_a_sentence_says_what_was_seen_and_what_to_do() -> None:
    text = str(Bench("force sensor dead").named())
    assert text.startswith(
        "the force sensor reads 0.0 cN and nothing else while the motor pushes up to 29 cN"
    )
    assert " cN: look at its cable and amplifier" in text


def test_a_person_who_does_not_press_is_asked_again_and_no_part_is_blamed() -> None:
    class Absent(PlantedPerson):
        def press(self, image: bytes, velocity_mm_s: float, settings: Settings) -> PlantedPerson:
            super().press(image, velocity_mm_s, settings)
            self.lift()
            return self

    bench = Bench()
    bench.person = Absent(RIG, FINGER, 3)
    with pytest.raises(DeviceError, match="no press was felt in 2 tries") as caught:
        bench.learn()
    assert not isinstance(caught.value, PartFaultError)
    assert len(bench.asked) == 2


def test_presses_since_a_part_broke_are_set_apart_and_a_mended_rig_goes_on(tmp_path: Path) -> None:
    bench = Bench("force sensor dead", begins=4, folder=tmp_path / "s")
    assert bench.named().fault.part == "force sensor"
    _, entries, _ = PressLog.read(tmp_path / "s" / PRESSES)
    assert [entry.used for entry in entries] == [True, True, False]
    mended = Bench(seed=5, folder=tmp_path / "s")
    assert mended.learn().outcome.complete
    assert mended.person.presses == 1 + 2, "the rig is checked again, then the two that were missing"
    log = PressLog(tmp_path / "s")
    log.close()
    assert [(part.from_press, part.part) for part in log.parts] == [(3, "force sensor")]
    assert [entry.used for entry in log.entries] == [True, True, False, True, True]


def test_a_press_that_was_used_is_set_apart_once_the_next_one_shows_the_change(tmp_path: Path) -> None:
    bench = Bench("coil warming", begins=4, folder=tmp_path / "s")
    assert bench.named().fault.part == "coil"
    log = PressLog(tmp_path / "s")
    log.close()
    assert [entry.used for entry in log.entries] == [True, True, False, False]
    assert log.entries[2].reason.startswith("the rig was another from here on: the coil lost")
    assert [record.entry.used for record in log.records()] == [True, True, False, False]


def test_a_session_resumed_on_the_same_day_is_not_checked_again(tmp_path: Path) -> None:
    class Stops(Bench):
        def ask(self, _ask: object) -> None:
            if self.person.presses == 3:
                raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt, match="2 presses are kept"):
        Stops(folder=tmp_path / "s").learn()
    bench = Bench(seed=5, folder=tmp_path / "s")
    bench.learn()
    assert bench.person.presses == 2
    assert not [line for line in bench.notices if "parts are checked" in line]


def test_a_check_of_today_in_another_session_on_the_rig_counts(tmp_path: Path) -> None:
    Bench(folder=tmp_path / "first").learn()
    second = Bench(seed=5)
    with LinkedDevice(second.board, second.person) as device:
        beside = Session(tmp_path / "second", checked_in=(tmp_path / "first", tmp_path / "none"))
        compensate(device, MODEL, SPEEDS, RigAware(0), session=beside)
    assert second.person.presses == 4


def test_the_twin_has_nothing_that_could_be_wired_wrongly() -> None:
    assert watch_of(TwinDevice(), 4.0) is None


@pytest.mark.slow
@pytest.mark.parametrize("name", PLANTED)
def test_each_planted_fault_is_named_within_two_presses_of_a_session(name: str) -> None:
    for begins in (0, 4)[PLANTED[name].begins_late :]:
        bench = Bench(name, begins, seed=11)
        assert bench.named().fault.part in PLANTED[name].parts, begins
        assert bench.person.presses - max(begins, 1) + 1 <= 2
