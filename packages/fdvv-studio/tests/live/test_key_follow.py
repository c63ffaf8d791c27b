"""A button pressed by a key of a keyboard that is read while it moves."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from fdvv.model.file import load_builtin
from fdvv.twin.interactive import InteractiveTicks
from fdvv.units import FloatArray
from fdvv_studio.live.press import LiveEvent, LiveEventKind, LivePress
from fdvv_studio.live.press_replay import KeyFollower
from fdvv_studio.live.press_subject import model_subject, trace_by_name
from fdvv_studio.live.press_trace import PressTrace, read_press_trace

STEP_s, FITTED_s = 0.004, 0.012
FULL_mm = 4.0
BUTTONS = ("mx-red", "mx-clear", "mx-blue", "rubber-dome")


def read_every_ms(trace: PressTrace) -> PressTrace:
    """Read a key as a sensor of eight bits does, every millisecond."""
    t = np.arange(int(1000 * trace.duration_s) + 1) / 1000
    x = np.interp(t, trace.t_s, trace.displacement_mm) / FULL_mm
    return PressTrace(trace.name, "", t, np.round(255 * x) / 255 * FULL_mm)


def followed(
    press: LivePress, key: PressTrace, duration_s: float
) -> tuple[FloatArray, FloatArray, list[LiveEvent]]:
    """Have a button follow what was read so far; return times and places of the cap, and events."""
    columns: list[InteractiveTicks] = []
    events: list[LiveEvent] = []
    while press.time_s < duration_s:
        past = key.t_s <= press.time_s + 1e-9
        recent = past & (key.t_s > press.time_s - FITTED_s)
        slope = np.polyfit(key.t_s[recent], key.displacement_mm[recent], 1)[0] if recent.sum() > 1 else 0.0
        press.follow(float(key.displacement_mm[past][-1]), float(slope))
        piece, happened = press.advance(STEP_s)
        columns.append(piece)
        events += happened
    t, x = (np.concatenate([getattr(c, name) for c in columns]) for name in ("t_s", "displacement_mm"))
    return t, x, events


def crossings_s(key: PressTrace, place_mm: float, until_s: float) -> list[float]:
    """Return when the key passed a place on its way down."""
    t, x = key.t_s, key.displacement_mm
    at = np.flatnonzero((x[:-1] < place_mm) & (x[1:] >= place_mm))
    return [float(np.interp(place_mm, x[i : i + 2], t[i : i + 2])) for i in at.tolist() if t[i] < until_s]


@pytest.mark.parametrize("button", BUTTONS)
@pytest.mark.parametrize("name", ["firm press", "drumming", "slow press"])
def test_the_cap_goes_where_the_key_is_and_actuates_as_often(button: str, name: str) -> None:
    press = LivePress(model_subject(load_builtin(button)), seed=None)
    key = read_every_ms(trace_by_name(name))
    t, x, events = followed(press, key, key.duration_s)
    wanted = np.minimum(np.interp(t, key.t_s, key.displacement_mm), press.subject.travel_mm)
    assert np.abs(x - wanted).mean() < 0.25, "as a trace is replayed"
    assert press.subject.actuation_mm is not None
    crossed = crossings_s(key, press.subject.actuation_mm, key.duration_s)
    actuated = [event.t_s for event in events if event.kind is LiveEventKind.ACTUATION]
    assert len(actuated) == len(crossed)
    if name != "slow press":  # then a snap takes the cap past places that the key reaches later
        assert actuated == pytest.approx(crossed, abs=0.012)


def test_a_key_that_is_held_with_noise_neither_swings_nor_chatters() -> None:
    subject = model_subject(load_builtin("mx-clear"))
    assert subject.actuation_mm is not None
    press, random = LivePress(subject, seed=None), np.random.default_rng(1)
    for i in range(100):
        press.follow(subject.actuation_mm * min(1.0, i / 25), 0.0)
        press.advance(STEP_s)
    places, changes = [], 0
    for _ in range(250):
        press.follow(subject.actuation_mm + float(random.normal(0, 0.006)), float(random.normal(0, 2)))
        piece, events = press.advance(STEP_s)
        places.append(piece.displacement_mm)
        changes += sum(event.kind is LiveEventKind.ACTUATION for event in events)
    assert np.ptp(np.concatenate(places)[1000:]) < 0.3
    assert changes <= 1


def test_a_turn_of_the_key_moves_the_finger_evenly() -> None:
    """Where the strokes differ by 30 cN, a switch between them would be a step of 0.7 mm."""
    follower = KeyFollower(model_subject(load_builtin("mx-clear")))
    x = np.concatenate([np.arange(0, 2.5, 0.01), np.arange(2.5, 0, -0.01)])
    referent = np.array([follower.step(float(place), 0.0).referent_mm for place in x])
    assert np.abs(np.diff(referent)).max() < 0.2
    assert (referent >= x - 1e-9).all()


def test_the_mouse_takes_over_and_the_key_again() -> None:
    press = LivePress(model_subject(load_builtin("mx-red")), seed=None)
    press.replay(trace_by_name("long hold"))
    press.follow(2.0, 0.0)
    assert not press.replaying
    press.advance(0.3)
    assert press.rig.time_s == pytest.approx(0.3)
    press.lift()
    lifted, _ = press.advance(0.3)
    assert lifted.displacement_mm[-1] < 0.1


def test_a_key_of_which_nothing_more_is_said_stops_where_it_was() -> None:
    """A page that is busy must not push the finger on into the stop."""
    press = LivePress(model_subject(load_builtin("mx-red")), seed=None)
    for i in range(-50, 20):
        press.follow(0.1 * max(0, i), 25.0 if i >= 0 else 0.0)
        press.advance(STEP_s)
    stopped = np.concatenate([press.advance(0.1)[0].displacement_mm for _ in range(3)])
    # half a millimetre further, and as deep as pulp that is squeezed fast lets it; else to the stop
    assert stopped.max() < 2.8
    assert stopped[-1] == pytest.approx(1.9, abs=0.1)


@pytest.mark.shared
@pytest.mark.parametrize("button", BUTTONS)
def test_a_persons_typing_moves_a_button(shared_data: Path, button: str) -> None:
    """Of an analogue keyboard: a shift key that is pressed in 25 ms, read every 1.7 ms."""
    path = shared_data / "wooting-analog" / "001_KMJ_20240531.csv"
    key = read_press_trace(path.read_bytes(), path.name)
    press = LivePress(model_subject(load_builtin(button)))
    assert press.subject.actuation_mm is not None
    t, x, events = followed(press, key, 10.0)
    wanted = np.minimum(np.interp(t, key.t_s, key.displacement_mm), press.subject.travel_mm)
    assert np.abs(x - wanted).mean() < 0.1
    actuated = [event.t_s for event in events if event.kind is LiveEventKind.ACTUATION]
    assert actuated == pytest.approx(crossings_s(key, press.subject.actuation_mm, 10.0), abs=0.01)
