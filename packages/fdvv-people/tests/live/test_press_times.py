"""Times of activations on the hand's clock."""

from __future__ import annotations

import numpy as np
import pytest

from fdvv.model.file import load_builtin
from fdvv_people.optimize.paper_space import paper_model, paper_space
from fdvv_studio.live.binary_finger import BinaryFinger
from fdvv_studio.live.press import LiveEventKind, LivePress, PressTimes
from fdvv_studio.live.press_subject import model_subject


def test_an_activation_is_as_long_after_the_hand_as_after_its_lead() -> None:
    times = PressTimes()
    times.note_activation(0.5)
    times.note_lead(1.0, 501.25)
    times.note_activation(1.04)
    times.note_lead(2.0, 502.5)
    times.note_activation(2.06)
    times.note_activation(2.09)
    assert times.between(0.0, 1e9) == pytest.approx((501.29, 502.56, 502.59))
    assert times.between(502.0, 502.57) == pytest.approx((502.56,))
    assert times.between(503.0, 504.0) == ()


def test_what_lies_between_hand_and_simulation_changes_no_time() -> None:
    found = []
    for delays_s in ((0.0, 0.0), (0.003, 0.040), (0.120, 0.007)):
        times = PressTimes()
        for number, delay_s in enumerate(delays_s):
            hand_s = 10.0 + number
            times.note_lead(hand_s + delay_s, hand_s)
            times.note_activation(hand_s + delay_s + 0.05)
        found.append(times.between(0.0, 99.0))
    assert found[0] == pytest.approx((10.05, 11.05))
    assert found[1] == pytest.approx(found[0])
    assert found[2] == pytest.approx(found[0])


@pytest.mark.parametrize("name", ["mx-red", "mx-clear", "rubber-dome"])
def test_a_key_hand_presses_and_lets_go_of_any_button_alike_each_time(name: str) -> None:
    press = LivePress(model_subject(load_builtin(name)), seed=None)
    hand = BinaryFinger.of(press.subject)
    taken_s = []
    for _ in range(3):
        start_s = press.time_s
        hand.down(press)
        events = press.advance(0.3)[1]
        taken_s.append(next(e.t_s for e in events if e.kind is LiveEventKind.ACTUATION) - start_s)
        hand.up(press)
        assert LiveEventKind.RESET in [e.kind for e in press.advance(0.3)[1]]
    assert taken_s[1:] == pytest.approx([taken_s[1]] * 2, abs=2e-3)
    assert 0.01 < taken_s[0] < 0.15


@pytest.mark.parametrize("seed", range(6))
def test_every_design_of_the_papers_space_is_pressed_to_its_activation(seed: int) -> None:
    space = paper_space()
    low, high = (np.array([getattr(one, end) for one in space.parameters]) for end in ("low", "high"))
    places = np.random.default_rng(seed).uniform(low, high)
    places[5], places[6] = high[5], high[6]  # the stiffest last point, the deepest activation
    press = LivePress(model_subject(paper_model(dict(zip(space.names, places, strict=True)))))
    BinaryFinger.of(press.subject).down(press)
    assert LiveEventKind.ACTUATION in [event.kind for event in press.advance(0.5)[1]]
