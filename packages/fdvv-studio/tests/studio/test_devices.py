"""A device held open: ticks and presses that it tells, zero force when nobody looks, who may use it."""

from __future__ import annotations

import re
import threading
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from fdvv.compensation.rig_aware import RigAware
from fdvv.device.twin import TwinDevice
from fdvv.errors import DeviceError, InputError
from fdvv.model.file import load_builtin
from fdvv.model.jnd_file import FILE_NAME as JNDS_FILE
from fdvv.model.jnd_file import save_jnds
from fdvv.rendering.compensate import CompensationResult, compensate
from fdvv.twin.files import load_rig
from fdvv_studio.studio.api import device as part
from fdvv_studio.studio.api.device import DevicePress, ScopeFrame, WatchScope
from fdvv_studio.studio.contract import Empty
from fdvv_studio.studio.device_findings import PressSeen
from fdvv_studio.studio.device_session import DeviceConnect, DeviceSession, DeviceStatus, DeviceUpload
from fdvv_studio.studio.jobs.jobs import Jobs
from fdvv_studio.studio.studio import Studio
from tests.studio.jobs import DEVICES, PATIENCE_s, learning
from tests.support.jnds import as_literature, record_of

CLEAR = DeviceUpload("builtin:mx-clear")


class Page:
    """A page that subscribes to telemetry, and waits for messages."""

    def __init__(self, studio: Studio) -> None:
        self.received: list[Any] = []
        self._news = threading.Condition()
        self.channel = part.ScopeChannel(studio, self._tell)
        self.channel.receive(WatchScope(0.01))

    def _tell(self, message: Any) -> None:
        with self._news:
            self.received.append(message)
            self._news.notify_all()

    def of(self, kind: type[Any]) -> list[Any]:
        return [message for message in self.received if isinstance(message, kind)]

    def wait(self, kind: type[Any], wanted: Any = lambda _message: True) -> Any:
        with self._news:
            assert self._news.wait_for(lambda: any(map(wanted, self.of(kind))), PATIENCE_s)
            return next(message for message in self.of(kind) if wanted(message))


@pytest.fixture
def studio(tmp_path: Path) -> Iterator[Studio]:
    studio = Studio(tmp_path / "project")
    yield studio
    studio.close()


@pytest.fixture
def page(studio: Studio) -> Iterator[Page]:
    page = Page(studio)
    yield page
    page.channel.close()


def test_the_scope_shows_a_press_on_the_firmware(studio: Studio, page: Page) -> None:
    found = part.connect.function(studio, DeviceConnect("host", "voltage"))
    assert (found.device, found.simulated, found.streams, found.fault) == ("host", True, True, "")
    page.wait(ScopeFrame)
    assert part.upload.function(studio, CLEAR).programmed == "mx-clear"
    part.press.function(studio, DevicePress(100.0))
    deep = page.wait(ScopeFrame, lambda frame: max(frame.displacement_high_mm) > 3.5)
    assert deep.bin_s == 0.01
    assert max(max(frame.commanded_high_cN) for frame in page.of(ScopeFrame)) > 20
    # this rig has no force sensor
    assert {force for frame in page.of(ScopeFrame) for force in frame.force_high_cN} == {None}
    seen = page.wait(PressSeen)
    assert seen.simulated
    assert max(force for force in seen.felt_press_cN if force is not None) > 20
    assert len(seen.intended_press_cN) == len(seen.displacement_mm) == len(seen.felt_release_cN)


def test_a_learned_table_closes_the_loop_of_its_rig_and_a_buttons_own_force_opens_it(
    studio: Studio, learned: CompensationResult
) -> None:
    session, model = studio.part(DeviceSession), load_builtin("mx-clear")
    part.connect.function(studio, DeviceConnect("host"))
    session.upload(CLEAR, model, learned)
    assert session.thread().device.loop == learned.outcome.tuning.loop  # type: ignore[attr-defined]
    assert part.press.function(studio, DevicePress(100.0)).fault == ""
    session.upload(CLEAR, model, None)
    assert session.thread().device.loop is None  # type: ignore[attr-defined]


@pytest.fixture
def learned() -> CompensationResult:
    model = load_builtin("mx-clear")
    return compensate(TwinDevice(load_rig("recommended")), model, [100.0], RigAware(rounds=0))


def test_a_loop_that_its_cell_opened_stays_open_until_the_cell_is_sound(
    studio: Studio, learned: CompensationResult, monkeypatch: pytest.MonkeyPatch
) -> None:
    rig = load_rig("recommended")
    off = replace(rig, load_cell=replace(rig.load_cell, offset_N=-0.5))
    monkeypatch.setattr("fdvv_studio.studio.device_session.load_rig", lambda _name: off)
    session = studio.part(DeviceSession)
    part.connect.function(studio, DeviceConnect("host"))
    session.upload(CLEAR, load_builtin("mx-clear"), learned)
    with pytest.raises(DeviceError, match="the force loop opened, cell_wrong"):
        part.press.function(studio, DevicePress(100.0))
    assert part.status.function(studio, Empty()).loop == "failed, cell_wrong"
    found = part.check_cell.function(studio, Empty())
    assert not found.sound
    assert found.reads_cN == pytest.approx(-50.0, abs=3.0)
    assert "Keep your hands off" in found.sentence
    assert part.status.function(studio, Empty()).loop == "failed, cell_wrong"


def test_a_sound_cell_closes_the_loop_that_was_open_and_the_next_press_is_held(
    studio: Studio, page: Page, learned: CompensationResult
) -> None:
    session = studio.part(DeviceSession)
    part.connect.function(studio, DeviceConnect("host"))
    session.upload(CLEAR, load_builtin("mx-clear"), learned)
    session.do(lambda remote: remote.client.open_force_loop())
    assert part.status.function(studio, Empty()).loop == "open"
    found = part.check_cell.function(studio, Empty())
    assert (found.sound, found.sentence.endswith("the force loop is closed again.")) == (True, True)
    assert part.status.function(studio, Empty()).loop == "closed"
    part.press.function(studio, DevicePress(100.0))
    seen = page.wait(PressSeen)
    assert not seen.noticed
    assert re.fullmatch(
        r"Mean error [01]\.\d cN in one press at 100 mm/s, simulated; .* not notice it, by JNDs from .*",
        seen.sentence,
    )


def test_a_press_is_judged_by_what_the_projects_people_notice_while_its_file_is_there(
    studio: Studio, page: Page
) -> None:
    part.connect.function(studio, DeviceConnect("twin"))
    part.upload.function(studio, CLEAR)
    file = studio.project / JNDS_FILE
    origin = "JNDs of force of 12 people of study weights (simulated)"
    for times, noticed in ((50.0, False), (0.01, True)):
        save_jnds(record_of(as_literature("force", times), simulated=True), file)
        part.press.function(studio, DevicePress(100.0))
        seen = page.wait(PressSeen, lambda seen, wanted=noticed: seen.noticed == wanted)
        assert seen.sentence.endswith(f"a finger would {'' if noticed else 'not '}notice it, by {origin}")
    file.write_text("{")
    count = len(page.of(PressSeen))
    with pytest.raises(InputError, match=JNDS_FILE):
        part.press.function(studio, DevicePress(100.0))
    file.unlink()
    part.press.function(studio, DevicePress(100.0))
    assert len(page.of(PressSeen)) == count + 1
    assert page.of(PressSeen)[-1].sentence.endswith(", by JNDs from the literature")


def test_a_rig_without_a_cell_has_none_to_check(studio: Studio) -> None:
    found = part.connect.function(studio, DeviceConnect("host", "voltage"))
    assert found.loop == ""
    with pytest.raises(DeviceError, match="no load cell to check"):
        part.check_cell.function(studio, Empty())


def test_a_device_falls_to_zero_force_when_nobody_looks_on(studio: Studio, page: Page) -> None:
    part.connect.function(studio, DeviceConnect("host"))
    part.upload.function(studio, CLEAR)
    assert part.arm.function(studio, Empty()).fault == ""
    page.wait(DeviceStatus, lambda status: status.mode == "armed")
    other = Page(studio)
    other.channel.close()
    assert part.status.function(studio, Empty()).mode == "armed"
    page.channel.close()
    again = Page(studio)
    again.wait(DeviceStatus, lambda status: status.mode == "idle")
    again.channel.close()


def test_the_twin_shows_presses_without_firmware(studio: Studio, page: Page) -> None:
    assert not part.connect.function(studio, DeviceConnect("twin")).streams
    part.upload.function(studio, CLEAR)
    part.press.function(studio, DevicePress(100.0))
    frame = page.wait(ScopeFrame)
    assert max(frame.displacement_high_mm) > 3.5
    assert None not in frame.force_high_cN
    assert part.selftest.function(studio, Empty()).note
    with pytest.raises(DeviceError, match="no firmware"):
        part.arm.function(studio, Empty())


def test_facts_and_self_test_are_those_of_the_firmware(studio: Studio) -> None:
    part.connect.function(studio, DeviceConnect("host", "voltage"))
    facts = {fact.name: fact.value for fact in part.facts.function(studio, Empty()).facts}
    assert (facts["name"], facts["simulated"]) == ("host", "True")
    verdicts = {found.part: found.verdict for found in part.selftest.function(studio, Empty()).parts}
    assert (verdicts["position_sensor"], verdicts["force_sensor"]) == ("passed", "absent")


def test_a_device_in_view_is_not_used_by_a_job_nor_the_other_way_round(studio: Studio) -> None:
    part.connect.function(studio, DeviceConnect("twin"))
    with pytest.raises(InputError, match="twin is used by the device view"):
        studio.part(Jobs).start(learning(), DEVICES)
    with pytest.raises(InputError, match="disconnect it first"):
        part.connect.function(studio, DeviceConnect("host"))
    assert part.disconnect.function(studio, Empty()).device == ""
    assert part.connect.function(studio, DeviceConnect("host")).device == "host"


@pytest.mark.parametrize(
    ("ask", "message"),
    [(DeviceConnect("serial:/dev/none"), "there is no"), (DeviceConnect("twin", "../paper"), "rig")],
)
def test_only_what_is_listed_is_connected(studio: Studio, ask: DeviceConnect, message: str) -> None:
    with pytest.raises(InputError, match=message):
        part.connect.function(studio, ask)


def test_without_a_device_one_line_says_so(studio: Studio) -> None:
    for work in (part.stop, part.arm, part.facts, part.selftest):
        with pytest.raises(DeviceError, match="connect one first"):
            work.function(studio, Empty())
    assert part.status.function(studio, Empty()) == DeviceStatus()
