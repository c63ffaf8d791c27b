"""The tuned settings of the paper's law keep their budgets and say what they add."""

from typing import Literal

import pytest

from fdvv.compensation.paper import RIG_DELAYS, PaperLaw, tuned_paper_law

SPEEDS = 4


@pytest.mark.parametrize("presses", [20, 240])
@pytest.mark.parametrize("additions", [True, False])
@pytest.mark.parametrize("tick_s", [0.001, 0.00025])
def test_four_speeds_take_the_presses_of_the_budget(
    presses: Literal[20, 240], additions: bool, tick_s: float
) -> None:
    law = tuned_paper_law(presses, tick_s, additions)
    assert SPEEDS * law.rounds * law.presses_per_round == presses


@pytest.mark.parametrize("presses", [20, 240])
def test_without_additions_it_is_the_law_as_printed(presses: Literal[20, 240]) -> None:
    assert tuned_paper_law(presses, additions=False).additions == PaperLaw.literal().additions == ()


def test_a_faster_loop_has_shorter_delays() -> None:
    slow, fast = tuned_paper_law(20).delays, tuned_paper_law(20, 0.00025).delays
    assert slow == RIG_DELAYS
    assert fast.position_s < slow.position_s
    assert fast.command_s < slow.command_s
