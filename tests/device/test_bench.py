"""Capture benches: what every one promises, on the simulated one."""

from __future__ import annotations

import numpy as np
import pytest

from fdvv.device import Cue, Pacing, TwinBench, open_bench
from fdvv.errors import DeviceError, InputError, ModelError
from fdvv.recording import Quantity, Stage, Take
from fdvv.twin import load_button
from fdvv.units import FloatArray

CUE = Cue(2.0, (("cue contact", 1.5), ("cue bottom", 1.54)))


def same(a: Take, b: Take) -> bool:
    pairs = zip(a.streams, b.streams, strict=True)
    return a.marks == b.marks and all(
        np.array_equal(x.t_s, y.t_s) and np.array_equal(x.raw, y.raw, equal_nan=True) for x, y in pairs
    )


def test_a_simulated_bench_says_so_and_states_what_repeats_it() -> None:
    info = open_bench("twin", "mx-brown", "clumsy", 5).facts()
    assert (info.name, info.simulated, info.person) == ("twin", True, "simulated, clumsy, seed 5")
    assert info.bench.clocks_go_on


def test_the_same_seed_gives_the_same_takes_and_another_seed_others() -> None:
    def made(seed: int) -> Take:
        return open_bench("twin", "mx-clear", seed=seed).take(4, Stage.PRESS, 100.0, CUE)

    assert same(made(1), made(1))
    assert not same(made(1), made(2))


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


def test_what_cannot_be_opened_or_pressed_is_told_in_one_line() -> None:
    with pytest.raises(InputError, match="names no capture bench"):
        open_bench("rig", "mx-clear")
    with pytest.raises(InputError, match="no-such"):
        open_bench("twin", "no-such")
    with pytest.raises(ModelError, match="participant"):
        open_bench("twin", "mx-clear", "sleepy")
    with pytest.raises(DeviceError, match=r"twin: a press of .* too slow"):
        open_bench("twin", "mx-clear").take(1, Stage.PRESS, 4.0, CUE)
