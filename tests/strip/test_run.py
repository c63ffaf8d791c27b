"""The pointing task on an LED strip: the firmware's core shows and times it, simulated people press."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from fdvv.device.boards import LibraryBoard
from fdvv.device.linked import LinkedDevice
from fdvv.errors import DeviceError, InputError
from fdvv.model.file import load_builtin
from fdvv.optimize.people.simulate import simulate_task
from fdvv.optimize.people.user import SimulatedUser
from fdvv.optimize.problem import Objective, TrialState
from fdvv.optimize.run.session import Optimization
from fdvv.optimize.run.setup import OptimizeSetup
from fdvv.optimize.tasks import TaskPress, TemporalPointing
from fdvv_strip.board import LedPointingTask, StripResult, StripStart
from fdvv_strip.library import LibraryStrip
from fdvv_strip.run import (
    play_on_strip,
    played_presser,
    press_of,
    run_on_strip,
    strip_round,
    try_on_strip,
)
from tests.support.scripted_person import ScriptedPerson

TASKS = [TemporalPointing(level, quantised=False) for level in ("easy", "hard")]
SHORT = replace(TASKS[1], rounds=3)
USER = SimulatedUser()
BROWN = load_builtin("mx-brown")
LATE_80_ms = [TaskPress(0.0, (0.08,))] * 3


@pytest.fixture
def line() -> LibraryStrip:
    return LibraryStrip()


@pytest.fixture
def strip(line: LibraryStrip) -> LedPointingTask:
    return LedPointingTask(line)


@pytest.mark.parametrize("task", TASKS)
def test_what_a_person_does_to_the_key_is_what_the_strip_tells(
    strip: LedPointingTask, line: LibraryStrip, task: TemporalPointing
) -> None:
    presses = simulate_task(task, BROWN, USER, 3)
    told = play_on_strip(strip, task, 3, presser=played_presser(line, presses))
    for there, here in zip(told, presses, strict=True):
        assert there.target_s is not None
        assert here.target_s is not None
        relative = [at_s - there.target_s for at_s in there.activations_s]
        assert relative == pytest.approx([at_s - here.target_s for at_s in here.activations_s], abs=2e-6)
    score, wanted = (task.scores(found)["asynchrony_ms"] for found in (told, presses))
    assert score.value == pytest.approx(wanted.value, abs=2e-3)


def test_a_round_shows_the_tasks_speed_length_and_zone() -> None:
    order = strip_round(TASKS[1])
    assert (order.speed_px_s, order.pixels, order.zone_px, order.zone_half_px) == (150, 144, 100, 5)


def test_the_same_seed_draws_the_same_delays_and_every_round_its_own(line: LibraryStrip) -> None:
    strip, delays = LedPointingTask(line), []
    for _ in range(2):
        heard: list[float] = []
        begun = line.now_s()
        for press in play_on_strip(strip, SHORT, 5):
            assert press.target_s is not None
            heard.append(press.target_s - begun)
            begun = press.target_s + 0.6
        delays.append([round(at_s, 1) for at_s in heard])
    assert delays[0] == delays[1]
    assert len(set(delays[0])) > 1


def test_a_round_without_a_press_is_a_miss(strip: LedPointingTask) -> None:
    assert all(press.activations_s == () for press in play_on_strip(strip, SHORT, 0))


def test_each_round_is_told_as_it_ends_and_somebody_else_is_fed_meanwhile(
    strip: LedPointingTask, line: LibraryStrip
) -> None:
    order: list[str] = []
    play_on_strip(
        strip,
        SHORT,
        0,
        presser=played_presser(line, LATE_80_ms),
        meanwhile=lambda: order.append("fed"),
        heard=lambda number, press: order.append(f"{number}: {len(press.activations_s)}"),
    )
    assert [entry for entry in order if entry != "fed"] == ["0: 1", "1: 1", "2: 1"]
    assert order.count("fed") > 3 * 1.0 / 0.07


@pytest.mark.parametrize(
    ("changed", "reason"), [({"is_whole": False}, "went dark"), ({"late_s": 0.0034}, "3.4 ms late")]
)
def test_a_round_that_was_not_shown_as_it_should_does_not_count(
    strip: LedPointingTask, changed: dict[str, float], reason: str
) -> None:
    result = StripResult(1.0, 2.0, (2.1,), 1, 145, 0.0, True)
    assert press_of(strip, result) == TaskPress(2.0, (2.1,))
    with pytest.raises(DeviceError, match=reason):
        press_of(strip, replace(result, **changed))  # type: ignore[arg-type]


def session_in(folder: Path) -> Optimization:
    setup = OptimizeSetup(engine="sobol", budget=3, objectives=(Objective("asynchrony_ms"),))
    return Optimization.create(folder / "run", setup)


def test_a_trial_is_rendered_played_and_scored(
    tmp_path: Path, strip: LedPointingTask, line: LibraryStrip
) -> None:
    device = LinkedDevice(LibraryBoard(), ScriptedPerson(3))
    with session_in(tmp_path) as session, device:
        (trial,) = session.ask()
        done = try_on_strip(session, trial, device, strip, SHORT, presser=played_presser(line, LATE_80_ms))
        assert done.state is TrialState.DONE
        assert done.scores is not None
        assert done.scores["asynchrony_ms"].value == pytest.approx(80.0, abs=2e-3)
        assert device.image
        assert not device.port.outputs.enable


def test_a_trial_on_a_strip_that_dies_is_abandoned_and_the_button_falls_to_zero_force(
    tmp_path: Path, strip: LedPointingTask
) -> None:
    device = LinkedDevice(LibraryBoard(), ScriptedPerson(3))

    def pulled(number: int, start: object) -> None:
        raise DeviceError("strip: the device is gone; plug it in again")

    with session_in(tmp_path) as session, device:
        (trial,) = session.ask()
        with pytest.raises(DeviceError, match="plug it in again"):
            try_on_strip(session, trial, device, strip, SHORT, presser=pulled)
        assert session.trials[0].state is TrialState.ABANDONED
        assert not device.port.outputs.enable


def test_a_trial_on_a_device_in_fault_is_failed_or_abandoned_never_scored(
    tmp_path: Path, strip: LedPointingTask
) -> None:
    device = LinkedDevice(LibraryBoard(), ScriptedPerson(3))
    plant = ScriptedPerson(3, meddle=lambda tick, inputs: inputs._replace(supply_mV=1000))

    def starved(number: int, start: object) -> None:
        device.port.connect(plant.press(device.image, 100.0, device.settings()))

    with session_in(tmp_path) as session, device:
        (trial,) = session.ask()
        with pytest.raises(DeviceError, match="fell to zero force, supply_low"):
            try_on_strip(session, trial, device, strip, SHORT, presser=starved)
        assert session.trials[0].state is TrialState.ABANDONED


def test_a_run_goes_on_where_it_was_stopped_until_its_budget_is_spent(
    tmp_path: Path, strip: LedPointingTask, line: LibraryStrip
) -> None:
    setup = OptimizeSetup(engine="sobol", budget=3, level="hard")
    presser = played_presser(line, LATE_80_ms)
    with LinkedDevice(LibraryBoard(), ScriptedPerson(3)) as device:
        with Optimization.create(tmp_path / "run", setup) as session:
            first = next(run_on_strip(session, device, strip, rounds=2, presser=presser))
        with Optimization.open(tmp_path / "run") as session:
            rest = list(run_on_strip(session, device, strip, rounds=2, presser=presser))
            assert session.finished
            assert session.trials == (first, *rest)
    assert [trial.state for trial in (first, *rest)] == [TrialState.DONE] * 3
    assert len({trial.design["x1_mm"] for trial in (first, *rest)}) == 3


def test_a_run_that_is_killed_in_a_round_asks_the_same_trial_again(
    tmp_path: Path, strip: LedPointingTask, line: LibraryStrip
) -> None:
    def killed(number: int, start: StripStart) -> None:
        raise KeyboardInterrupt

    with LinkedDevice(LibraryBoard(), ScriptedPerson(3)) as device:
        with (
            Optimization.create(tmp_path / "run", OptimizeSetup(level="easy", budget=2)) as session,
            pytest.raises(KeyboardInterrupt),
        ):
            next(run_on_strip(session, device, strip, rounds=2, presser=killed))
        assert not device.port.outputs.enable
        strip.stop()
        with Optimization.open(tmp_path / "run") as session:
            open_trial = session.trials[0]
            presser = played_presser(line, LATE_80_ms)
            done = next(run_on_strip(session, device, strip, rounds=2, presser=presser))
    assert (done.number, done.design) == (open_trial.number, open_trial.design)
    assert done.state is TrialState.DONE


def test_a_run_of_another_task_is_not_for_a_strip(tmp_path: Path, strip: LedPointingTask) -> None:
    with (
        Optimization.create(tmp_path / "run", OptimizeSetup(task="rapid-tapping")) as session,
        LinkedDevice(LibraryBoard(), ScriptedPerson(3)) as device,
        pytest.raises(InputError, match="rapid-tapping, level None is not for a strip"),
    ):
        next(run_on_strip(session, device, strip))
