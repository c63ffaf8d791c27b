"""A button pressed live: rendered as intended, reported as it happens, safe."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fdvv.errors import DeviceError, InputError
from fdvv.model.curve import Stroke
from fdvv.model.file import load_builtin
from fdvv.program.library import load_shipped, programs
from fdvv.protocol.tables import Fault, LoopFault, Mode
from fdvv.twin.interactive import InteractiveTicks
from fdvv_studio.live.press import LiveEvent, LiveEventKind, LivePress
from fdvv_studio.live.press_subject import (
    PressMode,
    PressSubject,
    model_subject,
    program_subject,
    trace_by_name,
)


def slow(press: LivePress, speed_mm_s: float, travel_mm: float) -> tuple[InteractiveTicks, InteractiveTicks]:
    """Lead the finger down past the stop and up again, evenly."""
    way_s, strokes = (travel_mm + 4.0) / speed_mm_s, []
    for start, speed in ((-1.9, speed_mm_s), (travel_mm + 2.1, -speed_mm_s)):
        press.lead(start, speed)
        strokes.append(press.advance(way_s)[0])
    return strokes[0], strokes[1]


def error_cN(
    subject: PressSubject, ticks: InteractiveTicks, stroke: Stroke
) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    x = ticks.displacement_mm
    inside = (x > 0.2) & (x < subject.travel_mm - 0.1)
    meant = subject.target_cN(0.0)[list(Stroke).index(stroke)]
    return np.abs(ticks.force_cN[inside] - np.interp(x[inside], subject.displacement_mm, meant))


def kinds(events: tuple[LiveEvent, ...]) -> list[LiveEventKind]:
    return [event.kind for event in events]


def test_a_button_that_nobody_touches_stays_up_and_says_nothing() -> None:
    """For longer than readings may stay equal: 6.5 s on this rig."""
    press = LivePress(model_subject(load_builtin("mx-clear")))
    ticks, events = press.advance(8.0)
    assert events == ()
    assert ticks.force_cN.max() == 0.0
    assert np.abs(ticks.displacement_mm).max() < 0.03
    assert press.fault().fault is Fault.NONE


@pytest.mark.parametrize("name", ["mx-red", "mx-blue"])
def test_as_intended_a_slow_finger_feels_the_models_force(name: str) -> None:
    """Models of one speed, whose force does not depend on what speed the firmware takes the press for."""
    subject = model_subject(load_builtin(name))
    for ticks, stroke in zip(slow(LivePress(subject, None), 10.0, subject.travel_mm), Stroke, strict=True):
        off = error_cN(subject, ticks, stroke)
        assert off.mean() < 0.3, stroke
        assert np.percentile(off, 95) < 1.0, stroke


def test_a_rig_with_a_cell_holds_the_force_with_its_loop_closed() -> None:
    """Far nearer to the model than its tables alone, with the loop open, on the same rig."""
    subject = model_subject(load_builtin("mx-red"), PressMode.COMPENSATED)
    assert (subject.rig_name, subject.loop is None) == ("recommended", False)
    means = []
    for one in (subject, replace(subject, loop=None)):
        strokes = slow(LivePress(one, 0), 20.0, subject.travel_mm)
        means.append(np.mean([error_cN(one, t, s).mean() for t, s in zip(strokes, Stroke, strict=True)]))
    assert means[0] < 0.5
    assert means[1] > 3 * means[0]


@pytest.mark.parametrize("name", sorted(recipe.name for recipe in programs()))
def test_a_program_on_a_rig_with_a_cell_is_pressed_with_its_loop_sound(name: str) -> None:
    subject = program_subject(load_shipped(name), PressMode.COMPENSATED)
    press = LivePress(subject)
    press.replay(trace_by_name("drumming"))
    ticks, events = press.advance(1.5)
    assert ticks.displacement_mm.max() > 2.0
    assert not [event.message for event in events if event.message]


def press_with_cell(*, offset_N: float = 0.0, full_scale_N: float = 4.45) -> LivePress:
    subject = model_subject(load_builtin("mx-red"), PressMode.COMPENSATED)
    cell = replace(subject.rig.load_cell, offset_N=offset_N, full_scale_N=full_scale_N)
    return LivePress(replace(subject, rig=replace(subject.rig, load_cell=cell)))


def press_once(press: LivePress) -> list[str]:
    """Press, lift, let the cap rest; return what was said of the loop."""
    press.push(80.0)
    events = press.advance(0.6)[1]
    press.lift()
    events += press.advance(0.5)[1]
    return [event.message for event in events if event.kind is LiveEventKind.LOOP]


def test_a_loop_that_its_cell_opened_stays_open_which_is_said_then_and_after_each_press() -> None:
    press = press_with_cell(offset_N=-0.5)
    for times in (2, 1, 1):
        assert press_once(press) == times * [
            "the force loop opened, cell wrong: tables render until the load cell is checked"
        ]
        assert press.rig.loop_fault is LoopFault.CELL_WRONG


@pytest.mark.parametrize("offset_N", [-0.5, 0.5])
def test_a_cap_with_a_broken_cell_lies_still_after_a_press(offset_N: float) -> None:
    press = press_with_cell(offset_N=offset_N)
    press_once(press)
    free, _ = press.advance(1.0)
    assert np.std(free.velocity_mm_s) < 5.0


def test_a_cell_that_reads_a_force_under_a_free_cap_does_not_close_the_loop_again() -> None:
    press = press_with_cell(offset_N=-0.5)
    press_once(press)
    with pytest.raises(DeviceError, match=r"the load cell reads -\d\d\.\d cN; lift the finger"):
        press.check_cell()
    assert press.rig.loop_fault is LoopFault.CELL_WRONG


def test_a_cell_of_too_small_a_range_passes_the_check_and_opens_the_loop_again_when_pressed() -> None:
    press = press_with_cell(full_scale_N=0.4)
    for _ in range(2):
        assert press_once(press)
        press.check_cell()
        assert press.rig.loop_fault is LoopFault.SOUND


def test_the_loop_is_closed_again_when_a_fault_is_cleared() -> None:
    press = LivePress(model_subject(load_builtin("mx-red"), PressMode.COMPENSATED))
    press.fail(Fault.POSITION_STUCK)
    press.advance(0.1)
    press.clear_fault()
    press.push(600.0)  # beyond the cell's 4.45 N, on the bottom stop: an overload is no fault
    assert LiveEventKind.LOOP not in kinds(press.advance(0.6)[1])
    assert press.rig.loop_fault is LoopFault.SOUND


@pytest.mark.slow
def test_a_rig_known_before_feels_nearer_to_the_model_than_one_left_alone() -> None:
    means = {}
    for mode in PressMode:
        subject = model_subject(load_builtin("mx-red"), mode, "light")
        strokes = slow(LivePress(subject, 0), 20.0, subject.travel_mm)
        means[mode] = np.mean([error_cN(subject, t, s).mean() for t, s in zip(strokes, Stroke, strict=True)])
    assert means[PressMode.INTENDED] < means[PressMode.COMPENSATED] < means[PressMode.RENDERED]


def test_the_key_goes_down_and_up_where_the_model_says() -> None:
    subject = model_subject(load_builtin("mx-clear"))
    press = LivePress(subject)
    press.lead(7.0, near_1_s=20.0)
    down = press.advance(0.5)[1]
    press.lift()
    up = press.advance(0.5)[1]
    assert kinds(down)[0] is LiveEventKind.ACTUATION
    assert down[0].displacement_mm == pytest.approx(subject.actuation_mm, abs=0.05)
    reset = next(event for event in up if event.kind is LiveEventKind.RESET)
    # it is found a tick after the cap was there
    assert reset.displacement_mm == pytest.approx(subject.reset_mm, abs=0.1)
    assert kinds(up)[-1] is LiveEventKind.PRESSED


def test_a_vibration_starts_at_its_place_whatever_the_boards_latency() -> None:
    model = load_builtin("mx-clear")
    for mode in (PressMode.INTENDED, PressMode.COMPENSATED):
        press = LivePress(model_subject(model, mode), None)
        press.lead(8.0, near_1_s=30.0)
        ticks, events = press.advance(0.4)
        shaken = next(event for event in events if event.kind is LiveEventKind.VIBRATION)
        felt_mm = float(np.interp(shaken.t_s, ticks.t_s, ticks.displacement_mm))
        assert felt_mm == pytest.approx(model.vibrations[0].onset_mm, abs=0.3), mode


def test_the_same_seed_and_hand_give_the_same_press() -> None:
    subject = model_subject(load_builtin("mx-brown"), PressMode.COMPENSATED)
    found = []
    for cuts in (1, 50):
        press = LivePress(subject, seed=3)
        press.replay(trace_by_name("fast double tap"))
        parts = [press.advance(1.0 / cuts) for _ in range(cuts)]
        found.append((np.concatenate([p[0].force_cN for p in parts]), [e for p in parts for e in p[1]]))
    assert np.array_equal(found[0][0], found[1][0])
    assert found[0][1] == found[1][1]


def test_a_press_is_reported_with_its_depth_and_speed() -> None:
    press = LivePress(model_subject(load_builtin("mx-red")))
    press.replay(trace_by_name("slow press"))
    ticks, events = press.advance(5.5)
    presses = [event for event in events if event.kind is LiveEventKind.PRESSED]
    assert len(presses) == 1
    assert presses[0].displacement_mm == pytest.approx(ticks.displacement_mm.max(), abs=0.03)
    x, t = ticks.displacement_mm, ticks.t_s
    first, last = (int(np.argmax(x > limit)) for limit in (0.1, 0.9 * x.max()))
    assert presses[0].velocity_mm_s == pytest.approx((x[last] - x[first]) / (t[last] - t[first]), rel=0.1)


@pytest.mark.parametrize("name", ["slow press", "firm press", "hesitant press", "drumming"])
def test_a_replayed_trace_moves_the_cap_along_it(name: str) -> None:
    trace = trace_by_name(name)
    press = LivePress(model_subject(load_builtin("mx-red")), None)
    press.replay(trace)
    ticks = press.advance(trace.duration_s)[0]
    wanted = np.clip(np.interp(ticks.t_s, trace.t_s, trace.displacement_mm), 0.0, None)
    off = np.abs(ticks.displacement_mm - np.minimum(wanted, press.subject.travel_mm))
    assert off.mean() < 0.25
    press.advance(0.3)
    assert press.advance(0.3)[0].force_cN[-1] == 0.0


@pytest.mark.parametrize("recipe", [recipe.name for recipe in programs()])
def test_every_shipped_program_can_be_pressed_and_comes_back(recipe: str) -> None:
    subject = program_subject(load_shipped(recipe))
    press = LivePress(subject)
    press.replay(trace_by_name("firm press"))
    ticks, events = press.advance(4.0)
    assert ticks.displacement_mm.max() > 3.5
    assert LiveEventKind.ACTUATION in kinds(events)
    assert LiveEventKind.RESET in kinds(events)
    assert set(ticks.mode) <= {Mode.ARMED, Mode.DERATED}
    assert abs(ticks.displacement_mm[-1]) < 0.1
    assert ticks.state.max() < len(subject.states)


def test_levels_are_reported_in_their_order() -> None:
    press = LivePress(program_subject(load_shipped("multi-level")))
    press.replay(trace_by_name("slow press"))
    events = press.advance(5.5)[1]
    keys = [event.number for event in events if event.kind.value in ("actuation", "level", "reset")]
    assert keys == [1, 2, 3, 2, 1, 0]
    clicks = [event.number for event in events if event.kind is LiveEventKind.VIBRATION]
    assert clicks == [0, 1, 2]


def test_a_host_event_lets_a_spent_button_come_back_at_once() -> None:
    backs = []
    for sends_event in (False, True):
        press = LivePress(program_subject(load_shipped("returning-later")))
        press.replay(trace_by_name("firm press"))
        press.advance(0.6)
        if sends_event:
            press.event(0)
        backs.append(press.advance(0.5)[0].displacement_mm[-1])
    assert backs[0] > 3.0
    assert abs(backs[1]) < 0.1


def test_a_fault_ends_the_force_with_a_reason_and_can_be_cleared() -> None:
    press = LivePress(model_subject(load_builtin("mx-clear")))
    press.lead(5.0)
    press.advance(0.3)
    press.fail(Fault.POSITION_STUCK)
    ticks, events = press.advance(0.2)
    assert kinds(events).count(LiveEventKind.FAULT) == 1
    fell = next(event for event in events if event.kind is LiveEventKind.FAULT)
    assert "position_stuck" in fell.message
    assert ticks.commanded_cN[1:].max() == 0.0
    assert ticks.mode[-1] == Mode.FAULT
    assert press.advance(0.2)[1] == () or LiveEventKind.FAULT not in kinds(press.advance(0.2)[1])
    press.clear_fault()
    ticks = press.advance(0.6)[0]
    assert ticks.mode[-1] == Mode.ARMED
    assert abs(ticks.displacement_mm[-1]) < 0.05
    assert press.fault().fault is Fault.NONE


def test_a_sensor_that_dies_is_found_by_the_firmware_itself() -> None:
    """No event causes it: readings that never change."""
    subject = model_subject(load_builtin("mx-red"))
    press = LivePress(replace(subject, settings=replace(subject.settings, stuck_ticks=500)), seed=None)
    ticks, events = press.advance(0.2)
    assert LiveEventKind.FAULT in kinds(events)
    assert ticks.commanded_cN[-1] == 0.0


def test_an_unknown_rig_and_a_program_that_is_refused_say_what_to_do() -> None:
    with pytest.raises(InputError, match="recommended, light, paper"):
        model_subject(load_builtin("mx-red"), PressMode.RENDERED, "no-such-rig")
    program = load_shipped("fast-tapping")
    sinking = replace(program, states=(replace(program.states[0], transitions=()), *program.states[1:]))
    stuck = replace(
        sinking, start="dropping", states=tuple(replace(s, transitions=()) for s in program.states)
    )
    with pytest.raises(InputError):
        program_subject(stuck)
