"""Tuning with a person: what is pressed, asked, kept, gone on with and written."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from fdvv.errors import DeviceError, InputError
from fdvv.model.curve import Stroke
from fdvv.model.file import load_model, save_model
from fdvv.model.model import FDVVModel
from fdvv.model.press import Press
from fdvv.model.vibration import Mode, Vibration
from fdvv.rendering.actuation_file import open_run_summary
from fdvv.rendering.session import Session
from fdvv.rendering.session_log import ANSWERS
from fdvv.rendering.session_run import Guide
from fdvv.rendering.tune_candidates import candidates_for, replace_vibrations, simulated_observer
from fdvv.rendering.tune_vibration import AnswerEvent, TuneResult, TuneSetup, tune_vibration
from fdvv.testing.conformance import plain_surface
from fdvv.testing.scripted import ScriptedDevice
from fdvv.vibration.exciter import KnownExciter
from fdvv.vibration.templates import TemplateGrid
from fdvv.vibration.tune import Preferred, Question, Rating
from fdvv.vibration.tune_compare import Comparing
from tests.support.sessions import MODEL, SPEEDS, Hand

GRID = TemplateGrid(gain_ratios=(1.0, 2.0), end_ratios=(0.1,))
SETUP = TuneSetup(plain_surface(), grid=GRID)
METHOD = Comparing(comparisons=3, fewest=3)


class ProgramHand(Hand):
    """A device that runs programs, and a person who presses it as a script says."""

    programs = 0

    def upload_program(self, image: bytes) -> None:
        self.programs += 1
        self.upload(plain_surface(), 4.0)


def slow(press: Press) -> Press:
    return replace(press, t_s=3.0 * press.t_s)


def prefers(*better: int) -> Callable[[Question], Preferred]:
    """Answer by a fixed order of templates."""

    def answer(asked: Question) -> Preferred:
        first, second = (better.index(i) if i in better else 99 for i in asked.templates)
        return Preferred.FIRST if first < second else Preferred.SECOND

    return answer


def tune(device: Any, answer: Any, folder: Path | None = None, **changed: Any) -> TuneResult:
    about: dict[str, Any] = {"model": MODEL, "speeds": SPEEDS, "method": METHOD, "setup": SETUP, **changed}
    return tune_vibration(
        device, about["model"], about["speeds"], about["method"], answer, about["setup"], Session(folder, 0),
        changed.get("guide"), changed.get("answered", lambda _event: None),
    )  # fmt: skip


def test_the_best_of_each_velocity_is_in_the_model_which_tells_how_it_came_about(tmp_path: Path) -> None:
    result = tune(ProgramHand(), prefers(2, 1, 0), method=Comparing(comparisons=12))
    assert [t.standing.best for t in result.tuned] == [2, 2]
    for speed in SPEEDS:
        found = result.model.vibration(Stroke.PRESS, speed)
        assert found is not None
        assert found.velocity_mm_s == speed
        assert found.modes[0].amplitude_m_s2 == pytest.approx(9.2)
    assert [v for v in result.model.vibrations if v.stroke is Stroke.RELEASE] == [
        v for v in MODEL.vibrations if v.stroke is Stroke.RELEASE
    ]
    method = result.model.provenance.method
    assert "tuned by a person with comparing in pairs in" in method
    assert "At 50 mm/s template 2 of 3 was best" in method
    save_model(result.model, tmp_path / "tuned.fdvv.json")
    assert load_model(tmp_path / "tuned.fdvv.json") == result.model


def test_every_answer_is_reported_with_the_estimate_so_far_once_it_is_on_file(tmp_path: Path) -> None:
    counts: list[tuple[int, int, int]] = []

    def look(now: AnswerEvent) -> None:
        on_file = len((tmp_path / ANSWERS).read_text().splitlines()) - 1
        counts.append((now.given.number, on_file, sum(t.standing.answers for t in now.tuned)))

    result = tune(ProgramHand(), prefers(2, 1, 0), tmp_path, answered=look)
    assert counts == [(n, n, n) for n in range(1, result.answers + 1)]


def test_where_nothing_can_be_distinguished_the_measured_vibration_is_kept_and_that_is_said() -> None:
    result = tune(ProgramHand(), lambda _: Preferred.NEITHER)
    assert [t.standing.best for t in result.tuned] == [0, 0]
    assert (
        "no difference found between 3 vibrations; the measured one is kept" in result.model.provenance.method
    )


def test_every_press_follows_an_upload_so_that_no_pause_gives_a_template_away() -> None:
    device = ProgramHand()
    result = tune(device, prefers(0, 1, 2))
    assert device.programs == device.presses == 2 * result.answers


def test_a_press_off_the_pace_is_made_again() -> None:
    notices: list[str] = []
    device = ProgramHand({1: slow})
    result = tune(device, prefers(0, 1), guide=Guide(notice=notices.append))
    assert device.presses == 2 * result.answers + 1
    assert any("not used" in text for text in notices)


def test_ten_presses_off_the_pace_end_the_session_and_say_how_to_go_on(tmp_path: Path) -> None:
    device = ProgramHand(dict.fromkeys(range(3, 30), slow))
    with pytest.raises(DeviceError, match=r"10 presses in a row could not be used.*1 answer is kept"):
        tune(device, prefers(0), tmp_path / "s")
    assert device.stops == 1


@pytest.mark.parametrize("method", [METHOD, Rating(2)])
@pytest.mark.parametrize("after", [1, 4])
def test_an_interrupted_session_goes_on_exactly(method: Any, after: int, tmp_path: Path) -> None:
    observer = simulated_observer(candidates_for(MODEL, SPEEDS, GRID), 3)
    whole = tune(ProgramHand(), observer.answer, tmp_path / "whole", method=method)
    asked: list[Question] = []

    def stops(question: Question) -> Any:
        asked.append(question)
        if len(asked) > after:
            raise KeyboardInterrupt
        return observer.answer(question)

    with pytest.raises(KeyboardInterrupt, match=f"{after} answer.* kept in .*; run the same command again"):
        tune(ProgramHand(), stops, tmp_path / "torn", method=method)
    torn = tune(ProgramHand(), observer.answer, tmp_path / "torn", method=method)
    assert torn.to_dict() == whole.to_dict()
    assert torn.model == whole.model
    assert len(torn.receipt.runs) == 2


@pytest.mark.parametrize("cut", [1, 10, 40])
def test_a_last_answer_cut_short_is_left_out_and_asked_again(cut: int, tmp_path: Path) -> None:
    whole = tune(ProgramHand(), prefers(1, 0), tmp_path / "s")
    path = tmp_path / "s" / ANSWERS
    path.write_bytes(path.read_bytes()[:-cut])
    notices: list[str] = []
    device = ProgramHand()
    again = tune(device, prefers(1, 0), tmp_path / "s", guide=Guide(notice=notices.append))
    assert again.to_dict() == whole.to_dict()
    assert device.presses == 2
    assert "the last record is not whole" in notices[0]


def test_a_finished_session_gives_its_result_again_without_a_press(tmp_path: Path) -> None:
    whole = tune(ProgramHand(), prefers(1, 0), tmp_path / "s")
    device = ProgramHand()
    again = tune(device, prefers(0, 1), tmp_path / "s")
    assert device.presses == 0
    assert again.to_dict() == whole.to_dict()
    receipt = open_run_summary(tmp_path / "s")
    assert receipt is not None
    assert (receipt.task, receipt.used) == ("tune", whole.answers)


def test_an_unfinished_session_has_a_receipt_too(tmp_path: Path) -> None:
    with pytest.raises(KeyboardInterrupt):
        tune(ProgramHand({3: KeyboardInterrupt()}), prefers(0), tmp_path / "s")
    receipt = open_run_summary(tmp_path / "s")
    assert receipt is not None
    assert receipt.used == 1


CHANGES: list[dict[str, Any]] = [
    {"method": Comparing(comparisons=4, fewest=3)},
    {"method": Rating(2)},
    {"speeds": [50.0, 150.0]},
    {"setup": TuneSetup(plain_surface(30.0), grid=GRID)},
    {"setup": replace(SETUP, exciter=KnownExciter(20.0, 600.0, 2.0))},
    {"setup": replace(SETUP, observer="simulated observer")},
    {"setup": replace(SETUP, grid=TemplateGrid(gain_ratios=(3.0,)))},
]


@pytest.mark.parametrize("changed", CHANGES)
def test_a_session_about_something_else_is_refused(changed: dict[str, Any], tmp_path: Path) -> None:
    tune(ProgramHand(), prefers(0), tmp_path / "s")
    with pytest.raises(InputError, match="is another session"):
        tune(ProgramHand(), prefers(0), tmp_path / "s", **changed)


def test_a_damaged_answer_is_refused_with_its_place(tmp_path: Path) -> None:
    tune(ProgramHand(), prefers(0), tmp_path / "s")
    path = tmp_path / "s" / ANSWERS
    lines = path.read_bytes().splitlines(keepends=True)
    path.write_bytes(b"".join([lines[0], lines[1].replace(b"50.0", b"51.0"), *lines[2:]]))
    with pytest.raises(InputError, match="line 2: the record is damaged"):
        tune(ProgramHand(), prefers(0), tmp_path / "s")


def test_a_device_that_runs_tables_only_is_refused() -> None:
    with pytest.raises(InputError, match="it runs tables of force only"):
        tune(ScriptedDevice(), prefers(0))


def test_a_known_exciter_makes_the_board_begin_earlier() -> None:
    device = ProgramHand()
    tune(device, prefers(0), setup=replace(SETUP, exciter=KnownExciter(20.0, 600.0, 2.0, latency_s=0.007)))
    assert device.settings().vibration_latency_us == 8000


def test_candidates_begin_with_the_measured_vibration_and_do_not_repeat_it() -> None:
    own = Vibration(Stroke.PRESS, 100.0, 2.0, 0.016, (Mode(239.0, 4.0, 100.0),))
    model = replace(MODEL, vibrations=(own,))
    ratio = float(2.718281828459045 ** (-100.0 * 0.016))
    (found,) = candidates_for(model, [100.0], TemplateGrid(gain_ratios=(1.0, 2.0), end_ratios=(ratio,)))
    assert found.vibrations[0] == own
    assert len(found.vibrations) == 2
    assert found.scores()[0] == {key: pytest.approx(1.0) for key in found.scores()[0]}


def test_vibrations_of_other_velocities_stay_and_one_for_all_is_replaced() -> None:
    def at(velocity: float | None) -> Vibration:
        return Vibration(Stroke.PRESS, velocity, 2.0, 0.016, (Mode(239.0, velocity or 1.0, 100.0),))

    model: FDVVModel = replace(MODEL, vibrations=(at(50.0), at(100.0)))
    fresh = replace(at(100.0), duration_s=0.02)
    assert replace_vibrations(model, [fresh]).vibrations == (at(50.0), fresh)
    assert replace_vibrations(replace(MODEL, vibrations=(at(None),)), [fresh]).vibrations == (fresh,)
