"""The guard of a session: the balance of sound presses, and what holds a press against it."""

from __future__ import annotations

import pytest

from fdvv.compensation.parts.guard import Diagnosis, PartGuard, PressBalance, weak_coil
from tests.compensation.parts.scripted_press import Scripted, TRAVEL_mm, WEIGHT_cN


def taught(presses: int = 4) -> PartGuard:
    guard = PartGuard(TRAVEL_mm, has_force=True)
    for seed in range(presses):
        guard.learn(Scripted(seed=seed).press())
    return guard


def look(guard: PartGuard, *presses: Scripted) -> list[Diagnosis | None]:
    return [guard.look(one.press(), used=True) for one in presses]


def test_the_balance_finds_the_numbers_that_the_presses_were_made_with() -> None:
    gain, error = taught().balance.gain
    assert gain == pytest.approx(1.0, abs=0.05)
    assert error < 0.1
    level, _, mass, drag, friction = taught().balance.numbers
    assert level == pytest.approx(-WEIGHT_cN, abs=4)
    assert 10 * mass == pytest.approx(15, abs=5)
    assert drag == pytest.approx(0.05, abs=0.03)
    assert friction == pytest.approx(4, abs=2)


def test_sound_presses_name_nothing() -> None:
    assert look(taught(2), *(Scripted(seed=seed) for seed in range(10, 20))) == [None] * 10


def test_a_coil_that_is_weak_from_the_start_shows_in_the_first_press() -> None:
    weak = PressBalance().with_press(Scripted(gain=0.5).facts())
    found = weak_coil(weak)
    assert found is not None
    assert found.seen.startswith("the coil pushes 0.5")
    assert weak_coil(PressBalance().with_press(Scripted().facts())) is None


def test_a_reversed_coil_shows_in_the_sign() -> None:
    found = weak_coil(PressBalance().with_press(Scripted(gain=-1.0).facts()))
    assert found is not None
    assert "the other way" in found.seen


@pytest.mark.parametrize(("gain", "remedy"), [(0.75, "let it cool"), (0.5, "shorted winding")])
def test_a_coil_that_loses_force_is_named_at_the_second_press(gain: float, remedy: str) -> None:
    first, second = look(taught(), Scripted(gain=gain, seed=8), Scripted(gain=gain, seed=9))
    assert first is None
    assert second is not None
    assert (second.fault.part, second.presses) == ("coil", 2)
    assert remedy in second.fault.remedy


def test_one_press_that_differs_is_chance_unless_the_board_says_that_something_is_wrong() -> None:
    weak = Scripted(gain=0.75, seed=8)
    assert look(taught(), weak, Scripted(seed=9), weak, Scripted(seed=10)) == [None] * 4
    found = taught().look(weak.press(), used=False, sure=True)
    assert found is not None
    assert found.presses == 1


def test_the_lowest_reading_distinguishes_a_zero_that_wanders_from_a_weak_coil() -> None:
    first, second = look(taught(), Scripted(zero_cN=20, seed=8), Scripted(zero_cN=40, seed=9))
    assert first is None
    assert second is not None
    assert (second.fault.part, second.presses) == ("force sensor", 2)


def test_presses_that_cannot_be_used_teach_nothing() -> None:
    guard = PartGuard(TRAVEL_mm, has_force=True)
    assert guard.look(Scripted().press(), used=False) is None
    assert guard.balance.presses == 0
