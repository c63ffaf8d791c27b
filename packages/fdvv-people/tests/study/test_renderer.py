"""What a stimulus is meant to feel like, and how long a change of labels takes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.errors import DeviceError, InputError
from fdvv.model.curve import Stroke
from fdvv.model.file import load_builtin, save_model
from fdvv.rendering.probe import fd_only
from fdvv_people.study.plan.plan import Stimulus
from fdvv_people.study.stimulus.renderer import ConstantTimeSwitch, stimulus_model


def test_a_stimulus_is_its_button_and_fd_is_one_curve_per_stroke_without_vibration(tmp_path: Path) -> None:
    whole = stimulus_model(Stimulus(name="FDVV", button="mx-clear"), tmp_path)
    assert whole == load_builtin("mx-clear")
    plain = stimulus_model(Stimulus(name="FD", button="mx-clear", rendered="FD"), tmp_path)
    assert plain == fd_only(whole)
    assert [len(plain.of(stroke)) for stroke in Stroke] == [1, 1]
    assert not plain.vibrations


@settings(deadline=None, max_examples=10)
@given(st.floats(0.5, 2.0))
def test_a_force_ratio_multiplies_every_force(ratio: float) -> None:
    given_, scaled = (
        stimulus_model(Stimulus(name="S", button="rubber-dome", force_ratio=one), Path())
        for one in (1.0, ratio)
    )
    x, v = np.linspace(0.0, given_.travel_mm, 40), np.array([[1.0], [80.0], [300.0]])
    for stroke in Stroke:
        assert scaled.force_cN(x, v, stroke) == pytest.approx(ratio * given_.force_cN(x, v, stroke))


@pytest.mark.parametrize("place", ["mine.fdvv.json", "buttons/mine.fdvv.json"])
def test_a_button_s_file_lies_in_the_study_s_folder_or_in_its_buttons(tmp_path: Path, place: str) -> None:
    (tmp_path / place).parent.mkdir(exist_ok=True)
    model = load_builtin("mx-red").renamed("mine")
    save_model(model, tmp_path / place)
    assert stimulus_model(Stimulus(name="S", button="mine.fdvv.json"), tmp_path) == model


@pytest.mark.parametrize(
    ("name", "why"),
    [("gone.fdvv.json", "no such file"), ("../x.fdvv.json", "outside"), ("/etc/x", "outside")],
)
def test_a_file_that_is_not_in_the_folder_is_refused_in_one_line(tmp_path: Path, name: str, why: str) -> None:
    with pytest.raises(InputError, match=why) as caught:
        stimulus_model(Stimulus(name="S", button=name), tmp_path)
    assert "\n" not in str(caught.value)


class Clock:
    """A clock that only sleeping and working move on."""

    def __init__(self) -> None:
        self.now_s = 0.0
        self.slept: list[float] = []

    def __call__(self) -> float:
        return self.now_s

    def sleep(self, time_s: float) -> None:
        self.slept.append(time_s)
        self.now_s += time_s


@settings(deadline=None)
@given(st.floats(0.0, 0.59))
def test_a_change_takes_the_same_time_however_long_its_work(work_s: float) -> None:
    clock = Clock()
    switch = ConstantTimeSwitch(0.6, clock, clock.sleep)

    def work() -> None:
        clock.now_s += work_s

    switch.make(work)
    assert clock.now_s == pytest.approx(0.6)


def test_work_that_takes_longer_takes_the_next_whole_multiple() -> None:
    clock = Clock()
    switch = ConstantTimeSwitch(0.6, clock, clock.sleep)

    def work() -> None:
        clock.now_s += 0.7

    switch.make(work)
    assert clock.now_s == pytest.approx(1.2)


def test_an_error_takes_as_long_as_a_change() -> None:
    clock = Clock()

    def work() -> None:
        raise DeviceError("gone")

    with pytest.raises(DeviceError):
        ConstantTimeSwitch(0.6, clock, clock.sleep).make(work)
    assert clock.now_s == pytest.approx(0.6)
