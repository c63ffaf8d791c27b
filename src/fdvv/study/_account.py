"""What a plan comes to: minutes, trials, breaks, balance of orders, and what its makers may want to know."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

from fdvv.study._orders import williams_orders
from fdvv.study._plan import StudyPlan
from fdvv.study._schedule import item_orders

TRIAL_s = {
    # the paper's: 60 minutes, less two breaks and about 8 minutes around, over 36 trials
    "realism": 75.0,
    "abx": 45.0,
    "2afc": 25.0,
    "2ac": 25.0,
    "preference": 30.0,
    "staircase": 15.0,
}
"""What a trial takes; all but the paper's assumed."""
RATED_s = 30.0
"""What each stimulus of a MUSHRA trial takes (assumed)."""
PAGE_s, QUESTION_s = 60.0, 10.0
"""What a page and each question on it takes (assumed)."""


@dataclass(frozen=True)
class PlanAccount:
    """What one person goes through, and how well the whole is balanced.

    Attributes
    ----------
    trials : of a person without practice, at most. trial_s : that one takes (assumed). breaks : that fall
        due. minutes : of a person, pages and breaks included.
    places, follows : fewest and most times that a button stands in a place of a round, and that it follows
        another one, over all people and rounds; None where orders are random or there is one button.
    notes : what is allowed but may not be meant.
    """

    trials: int
    practice: int
    trial_s: float
    breaks: int
    minutes: float
    places: tuple[int, int] | None
    follows: tuple[int, int] | None
    notes: tuple[str, ...]


def plan_account(plan: StudyPlan) -> PlanAccount:
    """Work out what a checked plan comes to."""
    trial_s, trials = trial_time_s(plan), trial_count(plan)
    breaks = _breaks(plan, trials, trial_s)
    page_s = sum(PAGE_s + QUESTION_s * len(page.questions) for page in plan.pages)
    whole_s = page_s + (trials + plan.practice) * trial_s + 60.0 * breaks * plan.break_min
    places, follows = _balance(plan)
    return PlanAccount(
        trials, plan.practice, trial_s, breaks, whole_s / 60.0, places, follows, tuple(_notes(plan, places))
    )


def trial_count(plan: StudyPlan) -> int:
    """Give how many trials a person has at most, practice left out."""
    block = plan.staircase.trials if plan.kind == "staircase" and plan.staircase else 1
    return len(plan.items) * plan.rounds * block


def trial_time_s(plan: StudyPlan) -> float:
    """Give what a trial of that kind takes (assumed)."""
    return RATED_s * len(plan.items[0].stimuli) if plan.kind == "mushra" else TRIAL_s[plan.kind]


def _breaks(plan: StudyPlan, trials: int, trial_s: float) -> int:
    """Count the breaks that fall due between trials; none stands behind the last one."""
    if plan.break_every_min == 0:
        return 0
    # the first trial that ends after so long
    between = max(1, -int(-60.0 * plan.break_every_min // trial_s))
    return max(0, (trials + plan.practice - 1) // between)


def _balance(plan: StudyPlan) -> tuple[tuple[int, int] | None, tuple[int, int] | None]:
    """Count how often each button stands in each place, and follows each other one."""
    count = len(plan.items)
    if plan.order == "random" or count == 1:
        return None, None
    orders = [order for person in range(plan.people) for order in item_orders(plan, person)]
    places = Counter((place, one) for order in orders for place, one in enumerate(order))
    follows = Counter(pair for order in orders for pair in pairwise(order))
    stood = [places[place, one] for place in range(count) for one in range(count)]
    followed = [follows[one, other] for one in range(count) for other in range(count) if one != other]
    return (min(stood), max(stood)), (min(followed), max(followed))


def _notes(plan: StudyPlan, places: tuple[int, int] | None) -> Iterator[str]:
    """Tell what a careful reader would ask about."""
    if places and places[0] != places[1]:
        rows = len(williams_orders(len(plan.items)))
        yield (
            f"orders are not balanced exactly: people times rounds would have to be a multiple of {rows}, "
            f"{plan.people} times {plan.rounds} is {plan.people * plan.rounds}"
        )
    if not any(page.when == "consent" for page in plan.pages):
        yield "there is no consent page"
    if plan.claim is None and plan.kind != "staircase":
        yield "there is no claim: what is tested is then chosen after the answers are seen"
    if plan.rounds == 2 and plan.kind not in ("mushra", "staircase"):
        yield "with two rounds, who sees through a label of the first knows that of the second"
    if plan.practice == 0:
        yield "there is no practice: first trials differ from later ones"
    if plan.switch_s == 0:
        yield "switch_s = 0: how long a change of what is rendered takes may tell which it is"
    if not plan.ties and plan.kind == "realism":
        yield 'without "equal" this is a 2-AFC, not the paper\'s task'
