"""Sessions: kept, judged, gone on with, refused."""

import json
import signal
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pytest

from fdvv.compensation.per_curve import PerCurve
from fdvv.compensation.presses import AcceptanceLimits
from fdvv.compensation.tables import GainSchedule
from fdvv.device.boards import LibraryBoard
from fdvv.device.contract import DeviceInfo, FaultReport
from fdvv.device.linked import LinkedDevice
from fdvv.device.plant import Inputs
from fdvv.device.recording import Recorder
from fdvv.device.twin import SimulatedPerson, TwinDevice
from fdvv.errors import DeviceError, InputError, ModelError
from fdvv.model.file import load_builtin
from fdvv.model.press import Press
from fdvv.model.surface import ForceSurface
from fdvv.protocol.tables import Fault
from fdvv.rendering.actuation_file import load_actuation, open_run_summary, save_actuation
from fdvv.rendering.compensate import compensate
from fdvv.rendering.probe import ProbeResult, probe
from fdvv.rendering.run_summary import RECEIPT
from fdvv.rendering.session import MANIFEST, Session, plain
from fdvv.rendering.session_log import PRESSES, PressLog
from fdvv.rendering.session_run import Guide, PressDone, PressRequest
from fdvv.testing.scripted import ScriptedDevice
from tests.support.scripted_person import ScriptedPerson
from tests.support.sessions import LAW, MODEL, SPEEDS, Hand, learn

SURFACE = ForceSurface.of_model(MODEL, SPEEDS)


def short(press: Press) -> Press:
    assert press.sensed_mm is not None
    return replace(press, displacement_mm=press.displacement_mm / 2, sensed_mm=press.sensed_mm / 2)


def hasty(press: Press) -> Press:
    return replace(press, t_s=press.t_s / 1.5)


def judged(device: ScriptedDevice, folder: Path | None = None, **more: Any) -> ProbeResult:
    return probe(device, MODEL, SURFACE, SPEEDS, 4, session=Session(folder), **more)


RUNS: dict[str, Callable[..., Any]] = {"compensate": learn, "probe": judged}


@pytest.mark.parametrize("name", RUNS)
@pytest.mark.parametrize("at", [1, 4, 8])
@pytest.mark.parametrize("stop", [KeyboardInterrupt(), DeviceError("unplugged")], ids=["Ctrl-C", "unplugged"])
def test_wherever_a_session_stops_it_goes_on_to_the_result_of_one_that_did_not(
    tmp_path: Path, name: str, at: int, stop: BaseException
) -> None:
    run = RUNS[name]
    whole = run(Hand())
    device = Hand({at: stop})
    with pytest.raises(type(stop), match=rf"{at - 1} press(es are| is) kept in .*run the same command again"):
        run(device, tmp_path / "s")
    assert device.stops == 1
    again = Hand()
    gone_on = run(again, tmp_path / "s")
    assert again.presses == 8 - (at - 1)
    assert gone_on.to_dict() == whole.to_dict()
    if name == "compensate":
        np.testing.assert_array_equal(gone_on.surface.press_cN, whole.surface.press_cN)
    assert len(gone_on.receipt.runs) == 2
    assert gone_on.receipt.used == 8


@pytest.mark.parametrize("name", RUNS)
def test_a_finished_session_gives_its_result_again_without_a_press(tmp_path: Path, name: str) -> None:
    first = RUNS[name](Hand(), tmp_path / "s")
    device, notices = Hand(), list[str]()
    again = RUNS[name](device, tmp_path / "s", guide=Guide(notice=notices.append))
    assert device.presses == 0
    assert again.to_dict() == first.to_dict()
    assert notices == [
        f"the session in {tmp_path / 's'}, with 8 of 8 presses, is finished; "
        "this is its result again, name another folder for a new one"
    ]


@pytest.mark.parametrize("name", RUNS)
def test_an_unusable_press_is_logged_reported_and_requested_again(tmp_path: Path, name: str) -> None:
    progress, asked = list[PressDone](), list[PressRequest]()
    device = Hand({2: short, 3: hasty})
    result = RUNS[name](device, tmp_path / "s", progress=progress.append, guide=Guide(ask=asked.append))
    assert device.presses == 10
    reasons = [event.skipped for event in progress if event.skipped]
    assert "the press stopped at 2.0" in reasons[0]
    assert "press slower" in reasons[1]
    assert [a.number for a in asked] == [1, 2, 2, 2, 3, 4, 5, 6, 7, 8]
    assert len({a.velocity_mm_s for a in asked[1:4]}) == 1
    assert [n.number for n in result.receipt.not_used] == [2, 3]
    assert result.to_dict()["presses"] == 10
    assert len(result.to_dict()["skipped"]) == 2
    # what cannot be used changes nothing
    assert result.to_dict()["curves"] == RUNS[name](Hand()).to_dict()["curves"]
    _, entries, _ = PressLog.read(tmp_path / "s" / PRESSES)
    assert [e.used for e in entries] == [True, False, False, *[True] * 7]


@pytest.mark.parametrize("name", RUNS)
def test_too_many_in_a_row_stop_the_session_in_one_line_and_it_can_go_on(tmp_path: Path, name: str) -> None:
    device = Hand(dict.fromkeys(range(3, 100), short))
    with pytest.raises(
        DeviceError, match="10 presses in a row could not be used; the last press 12 at"
    ) as stop:
        RUNS[name](device, tmp_path / "s")
    assert "\n" not in str(stop.value)
    assert "2 presses are kept" in str(stop.value)
    assert RUNS[name](Hand(), tmp_path / "s").receipt.used == 8


def test_a_method_that_takes_nothing_from_a_press_has_it_made_again() -> None:
    class Choosy(PerCurve):
        """Refuses the first press it is given."""

        refused: ClassVar[list[float]] = []

        def step(self, press: Press, state: Any) -> Any:
            if not self.refused:
                self.refused.append(press.velocity_mm_s)
                raise ModelError("not this one")
            return super().step(press, state)

    result = compensate(Hand(), MODEL, SPEEDS, Choosy(LAW))
    assert result.skipped == ("press 1 at 50 mm/s: not this one",)
    assert result.presses == 9


class Faulty(Hand):
    """A device that faults at some presses, and tells of it until that is cleared."""

    latched = False

    def press(self, velocity_mm_s: float) -> Press:
        try:
            return super().press(velocity_mm_s)
        except DeviceError:
            self.latched = True
            raise

    def fault(self) -> FaultReport:
        return FaultReport(Fault.OVER_FORCE if self.latched else Fault.NONE, 0, 0, 0.0, 0.0, 0.0, 1)

    def clear_fault(self) -> None:
        assert self.latched
        self.latched = False


def test_a_fault_is_a_press_that_cannot_be_used_and_the_device_is_given_its_table_again(
    tmp_path: Path,
) -> None:
    device = Faulty({3: DeviceError("fell to zero force, over force")})
    result = judged(device, tmp_path / "s")
    assert [(n.number, n.reason) for n in result.receipt.not_used] == [(3, "fell to zero force, over force")]
    assert device.uploads == 2
    assert not device.latched


def test_a_device_that_faults_again_and_again_stops_the_session() -> None:
    device = Faulty({n: DeviceError("over force") for n in range(1, 50)})
    with pytest.raises(DeviceError, match="10 presses in a row"):
        judged(device)


def test_a_device_that_is_gone_is_no_fault_of_a_press(tmp_path: Path) -> None:
    class Gone(Faulty):
        def fault(self) -> FaultReport:
            raise DeviceError("the device is gone")

    with pytest.raises(DeviceError, match="unplugged; 2 presses are kept"):
        learn(Gone({3: DeviceError("unplugged")}), tmp_path / "s")


def test_a_probe_uploads_its_surface_once_and_judges_a_rig_at_its_limit() -> None:
    device = Hand(
        {n: lambda p: replace(p, saturated=np.ones(p.t_s.size, dtype=np.bool_)) for n in range(1, 9)}
    )
    assert judged(device).receipt.used == 8
    assert device.uploads == 1


def changed(folder: Path, **change: Any) -> Callable[[], Any]:
    """Ask for another job in the folder of a session."""
    job = {"device": Hand(), "model": MODEL, "speeds": SPEEDS, "law": LAW, "seed": None, **change}
    return lambda: compensate(
        job["device"], job["model"], job["speeds"], job["law"], session=Session(folder, job["seed"])
    )


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"model": load_builtin("mx-red")}, 'model.name is "mx-clear" there and "mx-red" now'),
        ({"model": replace(MODEL, travel_mm=3.5)}, "model.sha256 is"),
        ({"device": Hand(force_limit_cN=300.0)}, "device.force_limit_cN is 440.0 there and 300.0 now"),
        ({"speeds": [50.0, 120.0]}, "velocities_mm_s is [50.0, 100.0] there and [50.0, 120.0] now"),
        ({"law": replace(LAW, rounds=2)}, "settings.law.rounds is 1 there and 2 now"),
        ({"seed": 4}, "seed is null there and 4 now"),
    ],
    ids=lambda v: "" if isinstance(v, str) else next(iter(v)),
)
def test_a_session_about_something_else_is_refused_and_says_what_differs(
    tmp_path: Path, change: dict[str, Any], message: str
) -> None:
    learn(Hand(), tmp_path / "s")
    before = (tmp_path / "s" / PRESSES).read_bytes()
    with pytest.raises(InputError) as caught:
        changed(tmp_path / "s", **change)()
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)
    assert (tmp_path / "s" / PRESSES).read_bytes() == before


def test_a_probe_does_not_go_on_with_a_session_of_learning(tmp_path: Path) -> None:
    learn(Hand(), tmp_path / "s")
    with pytest.raises(InputError, match='task is "compensate" there and "probe" now'):
        judged(Hand(), tmp_path / "s")


def test_other_bounds_may_go_on_with_a_session_and_each_run_says_its_own(tmp_path: Path) -> None:
    with pytest.raises(KeyboardInterrupt):
        learn(Hand({3: KeyboardInterrupt()}), tmp_path / "s")
    wide = Session(tmp_path / "s", acceptance=AcceptanceLimits(pace_ratio=0.6))
    result = compensate(Hand({1: hasty}), MODEL, SPEEDS, LAW, session=wide)
    assert result.skipped == ()
    assert result.receipt is not None
    assert [run.acceptance["pace_ratio"] for run in result.receipt.runs] == [0.35, 0.6]


@pytest.mark.parametrize("name", ["notes.txt", "model.fdvv.json"])
def test_a_folder_of_something_else_is_refused_and_left_alone(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_text("mine")
    with pytest.raises(InputError, match=r"holds files but no session\.json; name the folder of a session"):
        learn(Hand(), tmp_path)
    assert [p.name for p in tmp_path.iterdir()] == [name]


def test_a_file_is_no_folder(tmp_path: Path) -> None:
    (tmp_path / "s").write_text("mine")
    with pytest.raises(InputError, match="is a file, a folder is needed"):
        learn(Hand(), tmp_path / "s")


def test_a_process_killed_as_it_began_leaves_a_folder_that_can_be_begun(tmp_path: Path) -> None:
    (tmp_path / PRESSES).touch()
    assert learn(Hand(), tmp_path).receipt is not None


@pytest.mark.parametrize(
    "content", ["", "{", '{"format": "fdvv-model", "version": 1}', '{"format": "fdvv-session"}']
)
def test_a_damaged_manifest_is_refused_in_one_line(tmp_path: Path, content: str) -> None:
    learn(Hand(), tmp_path)
    (tmp_path / MANIFEST).write_text(content)
    with pytest.raises(InputError, match=MANIFEST) as caught:
        learn(Hand(), tmp_path)
    assert "\n" not in str(caught.value)


def test_presses_made_on_other_tables_are_not_learned_from(tmp_path: Path) -> None:
    learn(Hand(), tmp_path)
    other = replace(LAW, gain=GainSchedule.constant(0.3))
    # as if another version had given these settings another meaning
    manifest = json.loads((tmp_path / MANIFEST).read_text())
    manifest["settings"]["law"]["gain"] = {"most": 0.3, "least": 0.3, "floor_cN": 0.0}
    (tmp_path / MANIFEST).write_text(json.dumps(manifest))
    with pytest.raises(InputError, match=r"press 3: was made on another table.*another version of fdvv"):
        compensate(Hand(), MODEL, SPEEDS, other, session=Session(tmp_path))


def test_ctrl_c_between_a_press_and_its_record_waits_for_the_record(tmp_path: Path) -> None:
    class Impatient(PerCurve):
        """Presses Ctrl-C while it learns."""

        def step(self, press: Press, state: Any) -> Any:
            signal.raise_signal(signal.SIGINT)
            return super().step(press, state)

    before = signal.getsignal(signal.SIGINT)
    with pytest.raises(KeyboardInterrupt, match="interrupted; 1 press is kept"):
        compensate(Hand(), MODEL, SPEEDS, Impatient(LAW), session=Session(tmp_path / "s"))
    assert signal.getsignal(signal.SIGINT) is before
    assert [e.used for e in PressLog.read(tmp_path / "s" / PRESSES)[1]] == [True]


def test_the_first_run_has_the_seed_of_the_session_and_no_later_one_has_it_again(tmp_path: Path) -> None:
    session = Session(tmp_path / "s", seed=5)
    seeds = []
    for at in (3, 4, 99):
        seeds.append(session.run_seed())
        try:
            compensate(Hand({at: DeviceError("gone")}), MODEL, SPEEDS, LAW, session=session)
        except DeviceError:
            continue
    assert seeds[0] == 5
    assert len(set(seeds)) == 3
    receipt = open_run_summary(tmp_path / "s")
    assert receipt is not None
    assert [run.seed for run in receipt.runs] == seeds


def test_a_twin_that_goes_on_does_not_repeat_the_chance_it_had(tmp_path: Path) -> None:
    session = Session(tmp_path / "s", seed=5)

    def first_pace(device: Any) -> float:
        device.upload(SURFACE, MODEL.travel_mm)
        press = device.press(50.0)
        return float(press.t_s[-1])

    fresh = first_pace(session.open_device("twin"))
    assert fresh == first_pace(TwinDevice(seed=5))
    with pytest.raises(KeyboardInterrupt):
        compensate(Hand({2: KeyboardInterrupt()}), MODEL, SPEEDS, LAW, session=session)
    assert first_pace(session.open_device("twin")) != fresh


def test_the_standing_counts_presses_and_errors_per_velocity() -> None:
    events: list[PressDone] = []
    result = learn(Hand(drag_cN_s_mm=0.1), progress=events.append)
    rows = events[-1].progress()
    assert [(r.velocity_mm_s, r.made, r.wanted) for r in rows] == [(50.0, 4, 4), (100.0, 4, 4)]
    assert {c for row in rows for c in row.curves} == set(result.outcome.curves)
    assert events[0].message.startswith("moved the press by up to")
    assert events[0].achieved_mm_s == pytest.approx(50.0, rel=0.05)


def test_the_receipt_is_in_the_file_and_in_the_folder(tmp_path: Path) -> None:
    result = learn(Hand({2: short}), tmp_path / "s")
    save_actuation(result, tmp_path / "a.actuation.json")
    assert load_actuation(tmp_path / "a.actuation.json").receipt == result.receipt
    assert (
        open_run_summary(tmp_path / "a.actuation.json") == result.receipt == open_run_summary(tmp_path / "s")
    )
    found = json.loads((tmp_path / "s" / RECEIPT).read_text())
    assert found["simulated"] is True
    assert found["used"] == 8
    assert [n["number"] for n in found["not_used"]] == [2]
    for curve, learned in zip(found["curves"], result.outcome.curves, strict=True):
        errors = learned.error_cN
        assert (curve["first_cN"], curve["last_cN"], curve["best_cN"]) == (errors[0], errors[-1], min(errors))


def test_a_file_of_version_1_is_read_and_has_no_receipt(tmp_path: Path) -> None:
    path = tmp_path / "a.actuation.json"
    result = learn(Hand())
    save_actuation(result, path)
    old = {**json.loads(path.read_text()), "version": 1}
    del old["receipt"]
    path.write_text(json.dumps(old))
    again = load_actuation(path)
    assert again.to_dict() == result.to_dict()
    assert again.receipt is None
    with pytest.raises(InputError, match="version 1"):
        open_run_summary(path)


def test_a_folder_or_file_of_something_else_has_no_receipt(tmp_path: Path) -> None:
    (tmp_path / "x.csv").write_text("a,b\n")
    assert open_run_summary(tmp_path) is None
    assert open_run_summary(tmp_path / "x.csv") is None


def test_a_real_board_without_a_force_sensor_is_neither_learned_from_nor_judged() -> None:
    class Real(LinkedDevice):
        def info(self) -> DeviceInfo:
            return replace(super().info(), simulated=False)

    for kind, simulated in ((LinkedDevice, True), (Real, False)):
        with kind(LibraryBoard(), SimulatedPerson()) as board:
            with pytest.raises(DeviceError, match="no force sensor in its settings"):
                compensate(board, MODEL, SPEEDS, LAW)
            if simulated:
                assert probe(board, MODEL, SURFACE, [50.0], 1).receipt.used == 1
            else:
                with pytest.raises(DeviceError, match="fit one"):
                    probe(board, MODEL, SURFACE, [50.0], 1)


def test_a_board_is_distinguished_from_another_by_its_number_and_settings(tmp_path: Path) -> None:
    with LinkedDevice(LibraryBoard(), SimulatedPerson()) as board:
        receipt = probe(board, MODEL, SURFACE, [50.0], 1, session=Session(tmp_path / "s")).receipt
        assert receipt.device["settings"].items() <= vars(board.settings()).items()
        board.configure(replace(board.settings(), sliding_ticks=2))
        with pytest.raises(InputError, match=r"device\.settings\.sliding_ticks is 1 there and 2 now"):
            probe(board, MODEL, SURFACE, [50.0], 1, session=Session(tmp_path / "s"))


def test_a_real_fault_of_the_firmware_is_cleared_and_its_press_made_again() -> None:
    presses = list[int]()

    def broken_wire(tick: int, inputs: Inputs) -> Inputs:
        presses.extend([1] * (tick == 0))
        third = len(presses) == 3  # the first of all checks the rig
        return inputs._replace(lowest=0) if third and 60 < tick < 80 else inputs

    with LinkedDevice(LibraryBoard(), ScriptedPerson(meddle=broken_wire)) as board:
        result = probe(board, MODEL, SURFACE, [50.0], 3)
        assert board.fault().fault is Fault.NONE
    assert result.receipt.used == 3
    assert [n.number for n in result.receipt.not_used] == [2]
    assert result.receipt.not_used[0].reason.startswith("the position sensor failed (position_low: 0")


def test_a_recording_gives_what_the_device_gave_but_does_not_go_on(tmp_path: Path) -> None:
    path = tmp_path / "hand.jsonl"
    with Recorder(TwinDevice(seed=2), path) as device:
        first = compensate(device, MODEL, SPEEDS, LAW)
    session = Session(tmp_path / "s")
    again = compensate(session.open_device(f"replay:{path}"), MODEL, SPEEDS, LAW, session=session)
    np.testing.assert_array_equal(again.surface.press_cN, first.surface.press_cN)
    with pytest.raises(InputError, match="would repeat presses that are stored"):
        session.open_device(f"replay:{path}")


def test_settings_that_hold_arrays_are_distinguished_by_their_numbers() -> None:
    table = np.zeros(2000)
    other = table.copy()
    other[1000] = 1.0
    assert plain({"a": table, "b": np.float64(2)}) == {"a": table.tolist(), "b": 2.0}
    assert plain({"a": table}) != plain({"a": other})


def test_a_damaged_receipt_is_refused_in_one_line(tmp_path: Path) -> None:
    learn(Hand(), tmp_path)
    (tmp_path / RECEIPT).write_text('{"format": "fdvv-receipt", "version": 1}')
    with pytest.raises(InputError, match=RECEIPT) as caught:
        open_run_summary(tmp_path)
    assert "run the session's command again" in str(caught.value)


def test_a_fault_that_was_there_before_is_cleared_with_a_word() -> None:
    presses, notices = list[int](), list[str]()

    def broken_wire(tick: int, inputs: Inputs) -> Inputs:
        presses.extend([1] * (tick == 0))
        return inputs._replace(lowest=0) if len(presses) == 1 and 60 < tick < 80 else inputs

    with LinkedDevice(LibraryBoard(), ScriptedPerson(meddle=broken_wire)) as board:
        board.upload(SURFACE, MODEL.travel_mm)
        with pytest.raises(DeviceError, match="fell to zero force"):
            board.press(50.0)
        result = probe(board, MODEL, SURFACE, [50.0], 1, guide=Guide(notice=notices.append))
    assert result.skipped == ()
    cleared, begun, unseen = notices
    assert cleared.startswith("warning: library host had fallen to zero force, position_low")
    assert begun.startswith("first the rig's parts are checked, at 30 cN at most")
    assert "mover, force sensor (the settings have no force sensor)" in unseen
