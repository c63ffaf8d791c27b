"""Trials of an optimisation on an LED strip and the firmware's core in place of rig and board."""

from __future__ import annotations

from pathlib import Path

import pytest

from fdvv.device.boards import LibraryBoard
from fdvv.device.linked import LinkedDevice
from fdvv.errors import DeviceError, InputError
from fdvv_people.optimize.problem import TrialState
from fdvv_people.optimize.run.session import Optimization
from fdvv_people.optimize.run.setup import OptimizeSetup
from fdvv_people.task.pointing import TemporalPointing
from fdvv_people.task.score import Objective
from fdvv_people.task.task import TaskPress
from fdvv_strip.board import LedPointingTask, StripStart
from fdvv_strip.library import LibraryStrip
from fdvv_strip.run import run_on_strip, try_on_strip
from fdvv_strip.task import played_presser
from tests.support.scripted_person import ScriptedPerson

SHORT = TemporalPointing("hard", 3, quantised=False)
LATE_80_ms = [TaskPress(0.0, (0.08,))] * 3


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
