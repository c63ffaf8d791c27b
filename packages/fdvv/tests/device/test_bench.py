"""Capture benches: the simulated one, and one on a serial port."""

from __future__ import annotations

import os
import re
import threading
import time
import tty

import numpy as np
import pytest

from fdvv.device.bench import Cue, Pacing, SerialBench, TwinBench, open_bench
from fdvv.errors import DeviceError
from fdvv.recording.types import Quantity, Stage
from fdvv.twin.files import load_button
from fdvv.units import FloatArray
from tests.support.scripted_bench import HEAD, Board, spoken

CUE = Cue(2.0, (("cue contact", 1.5), ("cue bottom", 1.54)))


def test_a_simulated_bench_says_so_and_states_what_repeats_it() -> None:
    info = open_bench("twin", "mx-brown", "clumsy", 5).facts()
    assert (info.name, info.simulated, info.person) == ("twin", True, "simulated, clumsy, seed 5")
    assert info.bench.clocks_go_on


def test_the_cue_is_marked_on_the_clock_of_the_force_and_the_finger_follows_it() -> None:
    take = open_bench("twin", "mx-clear", "steady").take(1, Stage.PRESS, 100.0, CUE)
    contact_s, bottom_s = take.times_s("cue contact")[0], take.times_s("cue bottom")[0]
    assert bottom_s - contact_s == pytest.approx(0.04, abs=1e-6)
    (force,) = take.of(Quantity.FORCE)
    pushed_s = force.t_s[np.argmax(force.values > 30)]
    assert contact_s < pushed_s < bottom_s + 0.05


def test_a_paced_bench_shows_the_whole_cue_in_its_own_time() -> None:
    clock: FloatArray = np.array([50.0])
    shown: list[float] = []

    def sleep(duration_s: float) -> None:
        clock[0] += duration_s

    bench = TwinBench(load_button("mx-clear"), pacing=Pacing(lambda: float(clock[0]), sleep))
    bench.take(1, Stage.PRESS, 100.0, Cue(2.0, CUE.events, shown.append))
    assert shown[0] == 0.0
    assert shown[-1] == 2.0
    assert np.all(np.diff(shown) > 0)
    assert np.diff(shown).max() < 0.01
    assert clock[0] == pytest.approx(52.0, abs=0.01)


# -- a bench on a serial port --


def test_a_serial_bench_tells_what_its_head_says_and_is_no_simulation() -> None:
    board = spoken()
    info = SerialBench(board).facts()
    assert (info.simulated, info.name, info.person) == (False, "/dev/bench", "")
    assert (info.bench.force_filter_ms, info.bench.tip_mass_g) == (0.33, 2.0)
    assert board.sent == [b"?\n"]


def test_a_take_holds_what_came_while_the_cue_was_shown_in_the_units_of_the_head() -> None:
    board, shown = spoken(), list[float]()
    bench = SerialBench(board)
    begun_s = board.t_s
    take = bench.take(1, Stage.PRESS, 100.0, Cue(2.0, CUE.events, shown.append))
    (force,), (way,) = take.of(Quantity.FORCE), take.of(Quantity.DISPLACEMENT)
    assert force.t_s[-1] - force.t_s[0] == pytest.approx(2.8, abs=0.02)
    assert np.allclose(np.diff(force.t_s), 1e-3)
    assert set(np.round(force.values / 0.958)) == set(range(7))
    assert way.values.max() == pytest.approx(0.01)
    assert take.times_s("cue contact")[0] - force.t_s[0] == pytest.approx(1.5)
    assert take.times_s("cue bottom")[0] - force.t_s[0] == pytest.approx(1.54)
    assert force.t_s[0] == pytest.approx(begun_s, abs=0.02), "0 is the first line that was heard"
    assert (take.velocity_mm_s, take.stage, take.remark) == (100.0, Stage.PRESS, "")
    assert take.made
    assert max(shown) == 2.0
    assert np.diff(shown).max() < 0.01
    assert board.sent == [b"?\n", b"L\n"]


@pytest.mark.parametrize("first_us", [5_000_000, 2**32 - 1_500_000])
@pytest.mark.parametrize("pause_s", [3.0, 50 * 60.0, 3 * 3600.0])
def test_the_clock_goes_on_through_all_takes_however_often_the_board_s_counter_turns(
    first_us: int, pause_s: float
) -> None:
    board = spoken(first_us=first_us)
    bench = SerialBench(board)
    first = bench.take(1, Stage.PRESS, 100.0, CUE)
    board.t_s += pause_s
    second = bench.take(2, Stage.PRESS, 100.0, CUE)
    begins = [take.of(Quantity.FORCE)[0].t_s[0] for take in (first, second)]
    assert begins[1] - begins[0] == pytest.approx(2.8 + pause_s, abs=0.05)
    assert {s.clock for take in (first, second) for s in take.streams} == {"board"}


def test_takes_after_another_start_are_on_a_clock_of_their_own() -> None:
    take = SerialBench(spoken()).take(17, Stage.PRESS, 100.0, CUE)
    assert {s.clock for s in take.streams} == {m.clock for m in take.marks} == {"board from take 17"}


def test_events_of_the_board_are_marks_and_garbled_lines_are_reported_and_left_out() -> None:
    said = {
        1.0: b"! 6000000 light on\n",
        1.2: b"FD 62\xff\xfe00 garb\nF D\n",
        1.3: b"! 6300000 light off\r\n",
    }
    take = SerialBench(spoken(said=said)).take(1, Stage.PRESS, 100.0, CUE)
    assert take.times_s("light on").size == take.times_s("light off").size == 1
    assert take.times_s("light off")[0] - take.times_s("light on")[0] == pytest.approx(0.3)
    assert "garbled and left out" in take.remark
    assert "session" not in {mark.name for mark in take.marks}


@pytest.mark.parametrize(
    ("board", "words"),
    [
        (Board(silent_s=0.0), "/dev/bench: no answer; check the port's name"),
        (Board(), "/dev/bench: something else than a capture bench writes there"),
        (Board({0.0: b"x\n# fdvv-capture 9\n"}), "version 9 of fdvv-capture, this fdvv reads version 1"),
        (Board({0.0: b"\xff\x00 hello\n"}, silent_s=0.0), "something else than a capture bench"),
    ],
)
def test_what_does_not_answer_as_a_bench_is_refused_in_one_line_and_let_go(board: Board, words: str) -> None:
    with pytest.raises(DeviceError, match=re.escape(words)) as error:
        SerialBench(board)
    assert "\n" not in str(error.value)
    assert not board.open


def test_a_bench_that_falls_silent_or_is_unplugged_is_reported_at_once() -> None:
    silent = SerialBench(spoken(silent_s=1.0))
    with pytest.raises(DeviceError, match="/dev/bench: the bench fell silent; check its power"):
        silent.take(1, Stage.PRESS, 100.0, CUE)
    board = spoken()
    gone = SerialBench(board)
    board.gone_s = 1.0
    with pytest.raises(DeviceError, match="the device is gone"):
        gone.take(1, Stage.PRESS, 100.0, CUE)
    assert board.t_s < 1.1


def test_a_bench_on_a_real_line_is_heard_at_the_speed_of_its_samples() -> None:
    """A pseudo terminal as the system gives it, with a thread for the board."""
    pytest.importorskip("serialx")
    ours, theirs = os.openpty()
    tty.setraw(ours)
    stop = threading.Event()

    def write() -> None:
        os.read(ours, 2)  # it is asked for its head
        os.write(ours, "".join(f"{line}\r\n" for line in ["cut", *HEAD]).encode())
        begun_s, ms = time.monotonic(), 0
        while not stop.is_set():
            until = int(1e3 * (time.monotonic() - begun_s))
            os.write(ours, b"".join(b"FD %d 110 %d\r\n" % (1000 * i, i % 5) for i in range(ms, until)))
            ms = until
            time.sleep(0.002)

    board = threading.Thread(target=write)
    board.start()
    try:
        bench = open_bench(f"serial:{os.ttyname(theirs)}", "any")
        take = bench.take(1, Stage.REST, None, Cue(0.2))
        bench.close()
    finally:
        stop.set()
        board.join()
        os.close(theirs)
        os.close(ours)
    (force,) = take.of(Quantity.FORCE)
    assert force.t_s.size > 700
    assert np.allclose(np.diff(force.t_s), 1e-3)
    assert take.remark == ""
