"""The whole pointing task: a simulated person, the emulated controller of the rig, the emulated strip."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fdvv.device.linked import LinkedDevice
from fdvv.device.twin import SimulatedPerson
from fdvv.model.file import load_builtin
from fdvv.program.button import compile_button
from fdvv_m0.board import EmulatedBoard
from fdvv_people.optimize.people.simulate import simulate_task
from fdvv_people.optimize.people.user import SimulatedUser
from fdvv_people.task.pointing import TemporalPointing
from fdvv_strip.board import LedPointingTask, StripStart
from fdvv_strip.task import play_on_strip, played_presser
from tests.firmware._m0 import CONTROLLER
from tests.firmware._m0 import build as build_controller
from tests.firmware._simavr import build_board, require_tools, say
from tests.firmware._uno_strip import UnoStrip, build_strip_emulator

pytestmark = pytest.mark.firmware

HARD = TemporalPointing("hard", rounds=4, quantised=False)
BROWN = load_builtin("mx-brown")


@pytest.fixture
def uno(tmp_path: Path) -> Iterator[UnoStrip]:
    require_tools()
    board = UnoStrip(build_strip_emulator(tmp_path), build_board(tmp_path, "uno_strip"))
    yield board
    board.free()


def test_what_a_simulated_person_does_comes_back_from_the_strip_and_is_scored(uno: UnoStrip) -> None:
    presses = simulate_task(HARD, BROWN, SimulatedUser(), 5)
    reported = play_on_strip(LedPointingTask(uno), HARD, 5, presser=played_presser(uno, presses))
    there, here = ([HARD.asynchrony_ms(press) for press in found] for found in (reported, presses))
    assert None not in there
    apart_us = 1e3 * np.abs(np.array(there, float) - np.array(here, float))
    score, wanted = (HARD.scores(found)["asynchrony_ms"] for found in (reported, presses))
    say(f"{HARD.rounds} rounds: {score.value:.3f} ms, of {wanted.value:.3f}; {apart_us.max():.2f} us apart")
    assert apart_us.max() < 2.0
    assert score.value == pytest.approx(wanted.value, abs=2e-3)


def test_the_controllers_own_key_line_ends_as_an_asynchrony(uno: UnoStrip) -> None:
    board, person = EmulatedBoard(build_controller(CONTROLLER)), SimulatedPerson(seed=2)
    emulator, device = board.emulator, LinkedDevice(board, person)
    device.upload_program(compile_button(BROWN).image)
    wanted_ms: list[float] = []

    def press(number: int, start: StripStart) -> None:
        """Begin a press 150 ms before the target; both boards' clocks run side by side."""
        settle_us = 1e6 * person.settle_s  # in which the cap comes up, and the key with it
        onset_us = emulator.time_us + settle_us
        device.press(100.0)
        for change in emulator.key_log:
            at_s = start.target_s - 0.15 + 1e-6 * (change.time_us - onset_us)
            if change.is_down and change.time_us > onset_us:
                wanted_ms.append(1e3 * (at_s - start.target_s))
                uno.press_at(at_s)

    reported = play_on_strip(LedPointingTask(uno), replace(HARD, rounds=2), 1, presser=press)
    late_ms = [late for late in map(HARD.asynchrony_ms, reported) if late is not None]
    say(f"the controller's key line {wanted_ms[0]:.4f}, {wanted_ms[1]:.4f} ms after the target")
    say(f"reported by the strip's board {late_ms[0]:.4f}, {late_ms[1]:.4f} ms")
    assert late_ms == pytest.approx(wanted_ms, abs=2e-3)
    assert all(-150 < at_ms < 300 for at_ms in wanted_ms)
