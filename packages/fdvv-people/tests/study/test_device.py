"""Labels on a device: one program, two short messages for every change, judged from what the device tells."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from msgspec import structs

from fdvv.compensation.method import UNTUNED, Outcome, Tuning
from fdvv.compensation.rig_aware import RigAware
from fdvv.device.boards import HostBoard, LibraryBoard
from fdvv.device.linked import LinkedDevice, LockstepPort
from fdvv.device.plant import Inputs
from fdvv.device.remote import PressedDevice
from fdvv.device.serial import SerialPort
from fdvv.device.twin import SimulatedPerson, TwinDevice
from fdvv.errors import DeviceError, InputError
from fdvv.model.file import load_builtin
from fdvv.model.model import FDVVModel
from fdvv.model.surface import ForceSurface
from fdvv.program.surface import Limits
from fdvv.protocol.frame import FrameDecoder
from fdvv.protocol.tables import Message
from fdvv.rendering.actuation_file import save_actuation
from fdvv.rendering.compensate import CompensationResult, compensate
from fdvv.rendering.probe import fd_only
from fdvv.twin.files import load_finger, load_rig
from fdvv_people.study.plan.plan import Exclusion, Stimulus
from fdvv_people.study.stimulus.device import DeviceRenderer
from fdvv_people.study.stimulus.open import open_screen_renderer
from fdvv_people.study.stimulus.program import trial_program
from fdvv_studio.live.press_subject import identify_shipped_rig
from tests.support.buttons import line_model
from tests.support.pressed_rig import SETTINGS, Rig
from tests.support.scripted_person import ScriptedPerson

FD = Stimulus(name="FD", button="mx-clear", rendered="FD")
FDVV = Stimulus(name="FDVV", button="mx-clear")
WEIGHTLESS = Limits(weight_cN=0.0)


def scripted(meddle: Callable[[int, Inputs], Inputs] | None = None, **options: object) -> DeviceRenderer:
    """Return a stage on a cap that follows a path and feels the command."""
    person = ScriptedPerson(meddle=meddle)
    return DeviceRenderer(LinkedDevice(LibraryBoard(), person), Path(), limits=WEIGHTLESS, **options)  # type: ignore[arg-type]


def messages(stage: DeviceRenderer) -> list[tuple[float, Message, int]]:
    """Log what goes to the device from now on: when on its clock, what, how long."""
    port, decoder = stage.device.client.port, FrameDecoder()
    log: list[tuple[float, Message, int]] = []
    write = port.write

    def logged(data: bytes) -> None:
        log.extend((port.now_s(), Message(frame.message), len(data)) for frame in decoder.feed(data))
        write(data)

    port.write = logged  # type: ignore[method-assign]
    return log


def test_what_is_pressed_on_the_firmware_s_own_core_is_the_label_that_was_shown() -> None:
    stage = scripted()
    stage.prepare({"A": FD, "B": FDVV})
    for label in ("A", "B", "A"):
        stage.show(label)
    a, b = stage.rendered()
    assert [(one.label, one.stimulus, one.presses) for one in (a, b)] == [("A", "FD", 2), ("B", "FDVV", 1)]
    assert all(error is not None and error < 3 for error in (*a.error_cN, *b.error_cN))
    assert (a.vibrations, b.vibrations) == (0, 2)
    assert not a.faults + b.faults
    stage.close()


def test_labels_exchanged_under_the_hand_are_found_in_the_telemetry() -> None:
    """A device that renders another label than the one asked for is not judged as if it did."""
    stage = scripted()
    stage.prepare({"A": FD, "B": FDVV})
    event = stage.device.client.event
    stage.device.client.event = lambda number: event(2 if number else 0)  # type: ignore[method-assign]
    stage.show("A")
    assert stage.rendered()[0].faults == ("another label",)


def test_time_and_number_of_messages_of_a_change_do_not_depend_on_what_labels_hide() -> None:
    logs = []
    for labels in ({"A": FD, "B": FDVV}, {"A": FDVV, "B": FD}):
        stage = scripted(presses=0, switch_s=0.2)
        stage.prepare(labels)
        log = messages(stage)
        for label in ("A", "B", "B", "A"):
            stage.show(label)
        logs.append(log)
    assert logs[0] == logs[1]
    assert [kind for _, kind, _ in logs[0]].count(Message.EVENT) == 8
    assert {length for _, kind, length in logs[0] if kind is Message.EVENT} == {
        next(length for _, kind, length in logs[0] if kind is Message.EVENT)
    }
    at_s = np.array([at for at, kind, _ in logs[0] if kind is Message.EVENT])
    assert np.diff(at_s[::2]) == pytest.approx(0.2, abs=0.002)


def test_what_is_uploaded_is_as_long_whichever_label_hides_what(tmp_path: Path) -> None:
    one, other = (
        trial_program(labels, tmp_path, Limits()) for labels in ({"A": FD, "B": FDVV}, {"A": FDVV, "B": FD})
    )
    assert len(one.image) == len(other.image)
    assert one.image[28:] != other.image[28:]
    assert b"FD" not in one.image[8:]


def with_actuation(stimulus: Stimulus, file: str) -> Stimulus:
    return structs.replace(stimulus, actuation=f"{file}.actuation.json")


def kept(folder: Path, name: str, model: FDVVModel, tuning: Tuning = UNTUNED) -> None:
    """Keep an actuation for a rig that adds nothing of its own: what is commanded is what is felt."""
    surface = ForceSurface.of_model(model, (50.0, 100.0, 150.0))
    outcome = Outcome(surface, (), 0, True, "", tuning)
    result = CompensationResult("none", model.name, "scripted", model.travel_mm, outcome, (), True)
    save_actuation(result, folder / f"{name}.actuation.json")


def test_a_wrong_actuation_is_seen_and_right_ones_are_not_suspected(tmp_path: Path) -> None:
    model = load_builtin("mx-clear")
    kept(tmp_path, "FD", fd_only(model))
    kept(tmp_path, "FDVV", model)
    kept(tmp_path, "wrong", line_model("wrong", 120.0, travel_mm=model.travel_mm))
    stage = DeviceRenderer(LinkedDevice(LibraryBoard(), ScriptedPerson()), tmp_path)
    stage.prepare(
        {"A": with_actuation(FD, "FD"), "B": with_actuation(FDVV, "FDVV"), "C": with_actuation(FDVV, "wrong")}
    )
    for label in ("A", "B", "C"):
        stage.show(label)
    errors = [one.error_cN[0] for one in stage.rendered()]
    bound = Exclusion().error_cN
    assert [error is not None and error < bound for error in errors] == [True, True, False], errors


def test_a_force_ratio_multiplies_what_is_meant_and_leaves_what_compensation_added(tmp_path: Path) -> None:
    model = load_builtin("mx-clear")
    kept(tmp_path, "FDVV", model)
    plain = with_actuation(FDVV, "FDVV")
    stage = DeviceRenderer(LinkedDevice(LibraryBoard(), ScriptedPerson()), tmp_path)
    stage.prepare({"A": plain, "B": structs.replace(plain, force_ratio=1.2)})
    for label in ("A", "B"):
        stage.show(label)
    own, louder = (one.error_cN[0] for one in stage.rendered())
    assert own is not None
    assert louder == pytest.approx(1.2 * own, rel=0.15), "as far off, in proportion, as the button itself"


def test_actuations_under_different_tunings_are_refused_together(tmp_path: Path) -> None:
    model = load_builtin("mx-clear")
    kept(tmp_path, "FDVV", model, Tuning(bandwidth_Hz=60.0, lead_s=0.002))
    stage = DeviceRenderer(LinkedDevice(LibraryBoard(), ScriptedPerson()), tmp_path)
    with pytest.raises(InputError, match="different tunings"):
        stage.prepare({"A": FD, "B": with_actuation(FDVV, "FDVV")})


@pytest.mark.slow
def test_labels_that_the_paper_s_rig_was_compensated_with_are_felt_as_intended(tmp_path: Path) -> None:
    model, law = load_builtin("mx-clear"), RigAware(rounds=0, learned_rig=identify_shipped_rig("paper"))
    for name, one in (("FD", fd_only(model)), ("FDVV", model)):
        result = compensate(TwinDevice(load_rig("paper")), one, (50.0, 100.0, 150.0), law)
        save_actuation(result, tmp_path / f"{name}.actuation.json")
    person = SimulatedPerson(load_rig("paper"), load_finger("paper"), seed=3)
    stage = DeviceRenderer(LinkedDevice(LibraryBoard(), person), tmp_path, presses=3)
    stage.prepare({"A": with_actuation(FD, "FD"), "B": with_actuation(FDVV, "FDVV")})
    for label in ("A", "B"):
        stage.show(label)
    for found in stage.rendered():
        assert all(error is not None and error < Exclusion().error_cN for error in found.error_cN), found


def silent(tick: int, inputs: Inputs) -> Inputs:
    """Have the vibration board not answer."""
    return inputs._replace(board=1 << 3) if tick > 50 else inputs


def broken(tick: int, inputs: Inputs) -> Inputs:
    """Break the position sensor's wire."""
    return inputs._replace(lowest=0) if tick > 200 else inputs


@pytest.mark.parametrize(("meddle", "fault"), [(silent, "vibration_board"), (broken, "position_low")])
def test_a_fault_ends_force_and_stage_in_one_line_and_is_kept(
    meddle: Callable[[int, Inputs], Inputs], fault: str
) -> None:
    lines: list[str] = []
    stage = scripted(meddle, failed=lines.append)
    stage.prepare({"A": FD, "B": FDVV})
    with pytest.raises(DeviceError, match=fault) as caught:
        stage.show("B")
    assert "\n" not in str(caught.value)
    assert not any(letter.isdigit() for letter in str(caught.value)), "a force could tell what was rendered"
    assert lines == [stage.problem] == [str(caught.value)]
    a, b = stage.rendered()
    assert (a.faults, b.faults, b.vibrations) == ((), (fault,), 0)
    port = stage.device.client.port
    assert isinstance(port, LockstepPort)
    assert port.step().duty_q15 == 0
    with pytest.raises(DeviceError):
        stage.show("A")
    stage.close()


def test_a_stage_goes_on_with_a_device_that_had_fallen_into_a_fault() -> None:
    stage = scripted(broken)
    stage.prepare({"A": FD})
    with pytest.raises(DeviceError):
        stage.show("A")
    device = stage.device
    again = DeviceRenderer(device, Path(), limits=WEIGHTLESS, presses=0)
    again.prepare({"A": FD})
    again.show("A")
    assert again.rendered()[0].faults == ()


def test_the_twin_that_presses_at_once_is_no_device_for_this() -> None:
    with pytest.raises(InputError, match="side by side"):
        DeviceRenderer(TwinDevice(), Path())


def test_the_program_of_a_board_that_is_killed_ends_the_stage_in_one_line() -> None:
    board = HostBoard()
    stage = DeviceRenderer(LinkedDevice(board, ScriptedPerson()), Path(), limits=WEIGHTLESS)
    stage.prepare({"A": FD, "B": FDVV})
    stage.show("A")
    os.kill(board.pid, signal.SIGKILL)
    with pytest.raises(DeviceError) as caught:
        stage.show("B")
    assert "\n" not in str(caught.value)
    assert stage.rendered()[0].presses == 1
    stage.close()


def test_a_screen_is_given_the_twin_or_a_device_and_leads_only_the_twin() -> None:
    lines: list[str] = []
    for spec, person in (("twin", True), ("host", False)):
        stage = open_screen_renderer(spec, Path(), lambda _frame: None, lines.append, 0.0)
        stage.prepare({"A": FD})
        stage.show("A")
        stage.lead(1.0)
        stage.lift()
        assert stage.simulated
        assert bool(stage.travel_mm) == person
        stage.close()
    with pytest.raises(InputError, match="names no device"):
        open_screen_renderer("nothing", Path(), lambda _frame: None, lines.append, 0.0)
    assert not lines


class StudyRig(Rig):
    """A board behind a pseudo-terminal; someone presses once whenever it is asked for."""

    def unplug(self) -> None:
        """Pull the cable."""
        self.over.set()
        self.join()
        os.close(self.line)

    def end(self) -> None:
        if not self.over.is_set():
            self.unplug()
        os.close(self.slave)


@pytest.fixture
def line() -> Iterator[StudyRig]:
    rig = StudyRig(ScriptedPerson(), 0)
    rig.start()
    yield rig
    rig.end()


def until(found: Callable[[], object]) -> None:
    end_s = time.monotonic() + 30.0
    while not found():
        assert time.monotonic() < end_s
        time.sleep(0.01)


def on_line(rig: Rig, **options: object) -> DeviceRenderer:
    device = PressedDevice(SerialPort(rig.path))
    device.configure(SETTINGS)
    return DeviceRenderer(device, Path(), switch_s=0.1, limits=WEIGHTLESS, **options)  # type: ignore[arg-type]


def test_a_person_s_presses_on_a_line_count_for_the_label_the_device_renders(line: StudyRig) -> None:
    stage = on_line(line)
    stage.prepare({"A": FD, "B": FDVV})
    for label, place in (("B", 1), ("A", 0)):
        stage.show(label)
        line.presses = 1
        until(lambda: stage.rendered()[place].presses == 1)  # noqa: B023
    a, b = stage.rendered()
    assert (a.presses, b.presses, a.vibrations, b.vibrations) == (1, 1, 0, 2)
    assert a.error_cN == b.error_cN == (None,), "nothing tells the force felt without a force sensor"
    assert all(speed == pytest.approx(100, rel=0.1) for speed in a.velocity_mm_s + b.velocity_mm_s)
    stage.close()


def test_a_line_that_breaks_is_reported_once_and_ends_the_stage(line: StudyRig) -> None:
    lines: list[str] = []
    stage = on_line(line, failed=lines.append)
    stage.prepare({"A": FD})
    stage.show("A")
    line.unplug()
    until(lambda: lines)
    with pytest.raises(DeviceError) as caught:
        stage.show("A")
    assert "\n" not in str(caught.value)
    assert lines == [stage.problem]
    assert stage.rendered()[0].faults == ("lost",)
    stage.close()


def test_a_fault_on_a_line_is_reported_at_once_and_recorded_for_its_label(line: StudyRig) -> None:
    lines: list[str] = []
    line.scripted.meddle = broken
    stage = on_line(line, failed=lines.append)
    stage.prepare({"A": FD, "B": FDVV})
    stage.show("B")
    line.presses = 1
    until(lambda: lines)
    assert "position_low" in lines[0]
    with pytest.raises(DeviceError, match="position_low"):
        stage.show("A")
    assert [one.faults for one in stage.rendered()] == [(), ("position_low",)]
    stage.close()
