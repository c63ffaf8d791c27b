"""A task: what is a kind of trial's own. The built-in ones are in `tasks`; a package can add its own."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from fdvv.units import FloatArray
from fdvv_people.study.plan.plan import Item, Stimulus, StudyPlan

if TYPE_CHECKING:
    from fdvv_people.stats.share import Share
    from fdvv_people.stats.thurstone import DPrime
    from fdvv_people.study.simulation.people import ProxySettings, SimulatedPeople

LABELS = "ABCDEFGHIJKLMNOPQRSTUVW"
"""Of hidden renderings; X is always the reference."""

Assignment = tuple[dict[str, str], str]
"""What each label hides, and the answer that is right."""


class StudyTask:
    """What people do in a trial, of two stimuli behind A and B that have no right answer unless it says so.

    Attributes
    ----------
    sentence : what a trial is, for who plans it; {x}, {names}, {first}, {last} and {labels} are filled in.
    question : what people are asked, by language, where a plan has no words; {}: words.toml has them.
    trial_s, stimulus_s : what a trial takes, and each stimulus in it.
    stimuli : fewest and most that an item has. choices : the answers beside "equal", a label or a word each;
        none where only ratings are asked.
    right_or_wrong : an answer is one of the two, so that the claim may be about right answers.
    names_stimulus : an answer names what it prefers; else a claim about choices is about right answers.
    adaptive : the comparison follows the answers, and nothing is claimed.
    asks_second : what is asked for is the second stimulus.
    no_power : why `fdvv study power` cannot simulate it; empty where it can.
    has_reference : what is felt is held against a reference, X. hides_x : which is one of the two, hidden.
    hides_reference : the first stimulus is X and hidden among the others too.
    real_reference : what X is where it is not rendered.
    no_reference : why an item declares none; empty where it may.
    """

    sentence: ClassVar[str] = ""
    question: ClassVar[Mapping[str, str]] = {}
    trial_s: ClassVar[float] = 30.0
    stimulus_s: ClassVar[float] = 0.0
    stimuli: ClassVar[tuple[int, int]] = (2, 2)
    choices: ClassVar[tuple[str, ...]] = ("A", "B")
    right_or_wrong: ClassVar[bool] = False
    names_stimulus: ClassVar[bool] = True
    adaptive: ClassVar[bool] = False
    asks_second: ClassVar[bool] = False
    no_power: ClassVar[str] = "the power of its task is not simulated"
    has_reference: ClassVar[bool] = False
    hides_x: ClassVar[bool] = False
    hides_reference: ClassVar[bool] = False
    real_reference: ClassVar[str] = ""
    no_reference: ClassVar[str] = "nothing is compared with a third"

    def draw(self, names: Sequence[str], count: int, random: np.random.Generator) -> list[Assignment]:
        """Draw what labels hide in so many trials of an item. **Secret.** names : of its stimuli."""
        first, second = names
        hides = [{"A": second, "B": first}, {"A": first, "B": second}]
        sides = draw_sides(count, random)  # where the second stimulus hides
        return [(hides[side], "AB"[side] if self.asks_second else "") for side in sides]

    def problems(self, plan: StudyPlan) -> Iterator[str]:
        """Yield why a plan does not fit the task, each as "place: reason"."""
        del plan
        yield from ()

    def doubts(self, plan: StudyPlan) -> Iterator[str]:
        """Yield what is allowed in a plan but may not be meant."""
        del plan
        yield from ()

    def offers_equal(self, ties: bool) -> bool:
        """Whether "equal" may be answered. ties : of the plan."""
        del ties
        return False

    def shown_reference(self, item: Item) -> Stimulus | None:
        """Return what is rendered as X, named and not hidden; None where nothing is."""
        return item.reference

    def taste_ratio(self, settings: ProxySettings) -> float:
        """Return how strongly simulated people's taste leans their answers."""
        del settings
        return 0.0

    def simulate(self, people: SimulatedPeople, between_JND: float, random: np.random.Generator) -> str:
        """Return one of `choices` as a simulated person answers; empty: which label seems more, or closer.

        people : with the one person. between_JND : how far the two stimuli that were felt are apart.
        """
        del people, between_JND, random
        return ""

    def distances(self, right: bool, counts: FloatArray, people: Share | None) -> tuple[DPrime, ...]:
        """Return d' by every rule that fits the task.

        right : the counts are of right answers. counts : of answers against the claim, equal and for it, by
        person, (people, 3). people : the share for it, with people counted as people.
        """
        from fdvv_people.stats.thurstone import d_prime_2afc, d_prime_of_people
        from fdvv_people.stats.two_ac import two_ac, two_ac_people

        less, equal, more = (int(one) for one in counts.sum(axis=0))
        n = less + equal + more
        if equal:
            each = (two_ac_people(counts).all,) if people and n > equal else ()
            return (*each, two_ac(less, equal, more))
        return (*((d_prime_of_people(people, "2afc"),) if people else ()), d_prime_2afc(more, n))


def draw_sides(count: int, random: np.random.Generator) -> list[int]:
    """Draw zeros and ones, equally many but for one by lot if count is odd; all such sequences as likely."""
    odd = [int(random.integers(2))] if count % 2 else []
    return [int(side) for side in random.permutation([0, 1] * (count // 2) + odd)]
