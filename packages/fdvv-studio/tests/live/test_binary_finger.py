"""A finger that is driven by a key which is down or up: what it presses, and how soon."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from fdvv.model.file import load_builtin
from fdvv.program.library import load_shipped
from fdvv.units import FloatArray
from fdvv_studio.live.binary_finger import BinaryFinger, LIFTED_mm, TAPPED_mm_s
from fdvv_studio.live.press import LiveEvent, LiveEventKind, LivePress
from fdvv_studio.live.press_subject import PressSubject, model_subject, program_subject

TAPS = 40


def subject_of(name: str) -> PressSubject:
    return (
        model_subject(load_builtin(name)) if name.startswith("mx-") else program_subject(load_shipped(name))
    )


def tapped(hand: BinaryFinger, subject: PressSubject, rate_Hz: float, hold_s: float) -> list[FloatArray]:
    """Return the delays of the key after each tap of the hand, s; the hand taps evenly."""
    press, events = LivePress(subject, seed=0), list[LiveEvent]()
    downs_s = []
    for _ in range(TAPS):
        downs_s.append(press.time_s)
        hand.down(press)
        events += press.advance(hold_s)[1]
        hand.up(press)
        events += press.advance(1 / rate_Hz - hold_s)[1]
    assert not [event for event in events if event.kind is LiveEventKind.FAULT]
    keys = np.array([event.t_s for event in events if event.kind is LiveEventKind.ACTUATION])
    return [keys[(keys >= a) & (keys < b)] - a for a, b in pairwise([*downs_s, np.inf])]


@pytest.mark.parametrize("name", ["mx-red", "mx-clear", "fast-tapping", "rapid-trigger"])
@pytest.mark.parametrize(("rate_Hz", "hold_s"), [(6, 0.08), (10, 0.04), (12, 0.025)])
def test_every_tap_of_a_quick_hand_is_one_press_after_a_steady_delay(
    name: str, rate_Hz: float, hold_s: float
) -> None:
    subject = subject_of(name)
    delays = tapped(BinaryFinger.tapping(subject), subject, rate_Hz, hold_s)
    assert [keys.size for keys in delays] == [1] * TAPS
    # the first tap begins with a lifted finger
    assert np.concatenate(delays).max() < 0.03
    assert np.ptp(np.concatenate(delays[1:])) < 0.003


def test_the_finger_of_whole_presses_loses_short_taps() -> None:
    subject = subject_of("mx-red")
    assert sum(keys.size for keys in tapped(BinaryFinger.of(subject), subject, 12, 0.025)) < TAPS / 2


def test_a_referent_moves_no_faster_than_its_pace() -> None:
    subject = subject_of("mx-clear")
    for hand, top_mm, pace_mm_s in (
        (BinaryFinger.of(subject), LIFTED_mm, 120.0),
        (BinaryFinger.tapping(subject), 0.0, TAPPED_mm_s),
    ):
        assert (hand.top_mm, hand.pace_mm_s) == (top_mm, pace_mm_s)
        press = LivePress(subject, seed=None)
        press.lead(hand.top_mm)
        press.advance(0.5)
        hand.down(press)
        finger_mm = press.advance(0.2)[0].finger_mm
        # until it touches, the finger follows its referent
        free = np.diff(finger_mm) / press.subject.rig.controller.tick_s
        assert free.max() < 1.15 * pace_mm_s
