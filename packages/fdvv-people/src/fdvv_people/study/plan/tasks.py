"""The built-in tasks, and those that packages add by the entry point ``fdvv.tasks``."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, ClassVar

import msgspec
import numpy as np

from fdvv import extras
from fdvv.errors import InputError, did_you_mean
from fdvv.units import FloatArray
from fdvv_people.study.plan.plan import Item, Stimulus, StudyPlan
from fdvv_people.study.plan.task import LABELS, Assignment, StudyTask, draw_sides
from fdvv_people.study.plan.text_check import twice_problems

if TYPE_CHECKING:
    from fdvv_people.stats.share import Share
    from fdvv_people.stats.thurstone import DPrime
    from fdvv_people.study.simulation.people import ProxySettings

PREFERENCE_TASTE_ratio = 1.0
"""Of liking: people's tastes differ as much as they agree. Assumed."""


class Realism(StudyTask):
    """The paper's task: a reference X is named; which of A and B is closer to it, or neither?"""

    sentence: ClassVar[str] = "X is {x}. A and B hide {names}; which is closer to X?"
    # the paper's: 60 minutes, less two breaks and about 8 minutes around, over 36 trials
    trial_s: ClassVar[float] = 75.0
    no_power: ClassVar[str] = ""
    has_reference: ClassVar[bool] = True
    real_reference: ClassVar[str] = "the real button"
    no_reference: ClassVar[str] = ""

    def offers_equal(self, ties: bool) -> bool:
        return ties

    def doubts(self, plan: StudyPlan) -> Iterator[str]:
        if not plan.ties:
            yield 'without "equal" this is a 2-AFC, not the paper\'s task'

    def taste_ratio(self, settings: ProxySettings) -> float:
        return settings.taste_ratio


class Abx(StudyTask):
    """X *is* A or B: which?"""

    sentence: ClassVar[str] = "X, A and B hide {names}; X is the same as A or as B, and must be named."
    trial_s: ClassVar[float] = 45.0
    right_or_wrong: ClassVar[bool] = True
    names_stimulus: ClassVar[bool] = False
    no_power: ClassVar[str] = ""
    has_reference: ClassVar[bool] = True
    hides_x: ClassVar[bool] = True
    real_reference: ClassVar[str] = "one of the two"
    no_reference: ClassVar[str] = "X is one of the two stimuli"

    def draw(self, names: Sequence[str], count: int, random: np.random.Generator) -> list[Assignment]:
        drawn: list[Assignment] = []
        sides = draw_sides(count, random)  # where what X is hides
        for x, side in zip(draw_sides(count, random), sides, strict=True):
            same, other = names[x], names[1 - x]
            hidden = {"A": other, "B": same} if side else {"A": same, "B": other}
            drawn.append(({**hidden, "X": same}, "AB"[side]))
        return drawn

    def distances(self, right: bool, counts: FloatArray, people: Share | None) -> tuple[DPrime, ...]:
        from fdvv_people.stats.thurstone import d_prime_abx, d_prime_of_people

        if not right:
            return super().distances(right, counts, people)
        more, n = int(counts[:, 2].sum()), int(counts.sum())
        rules = tuple(d_prime_abx(more, n, rule) for rule in ("differencing", "independent"))
        return (*((d_prime_of_people(people, "abx"),) if people else ()), *rules)


class Forced(StudyTask):
    """2afc: which of two holds what is asked for?"""

    sentence: ClassVar[str] = "A and B hide {names}; one must be named, and {last} is right."
    trial_s: ClassVar[float] = 25.0
    right_or_wrong: ClassVar[bool] = True
    asks_second: ClassVar[bool] = True
    no_power: ClassVar[str] = ""


class ForcedOrNone(StudyTask):
    """2ac: which of two holds what is asked for, or is there no difference?"""

    sentence: ClassVar[str] = "A and B hide {names}; {last} is right, and no difference may be answered."
    trial_s: ClassVar[float] = 25.0
    asks_second: ClassVar[bool] = True
    no_power: ClassVar[str] = ""

    def offers_equal(self, ties: bool) -> bool:
        return True

    def problems(self, plan: StudyPlan) -> Iterator[str]:
        if not plan.ties:
            yield 'ties: 2ac asks "or no difference"; without ties it is kind = "2afc"'


class Preference(StudyTask):
    """Which of two is liked better?"""

    sentence: ClassVar[str] = "A and B hide {names}; neither is right."
    no_power: ClassVar[str] = ""

    def offers_equal(self, ties: bool) -> bool:
        return ties

    def taste_ratio(self, settings: ProxySettings) -> float:
        return PREFERENCE_TASTE_ratio


class Mushra(StudyTask):
    """Every rendering is rated beside a named reference, itself and the anchors hidden among them."""

    sentence: ClassVar[str] = "X is {first}, openly. {labels} hide {names}, and each is rated."
    trial_s: ClassVar[float] = 0.0
    stimulus_s: ClassVar[float] = 30.0
    stimuli: ClassVar[tuple[int, int]] = (3, len(LABELS))
    choices: ClassVar[tuple[str, ...]] = ()
    no_power: ClassVar[str] = ""
    has_reference: ClassVar[bool] = True
    hides_reference: ClassVar[bool] = True
    no_reference: ClassVar[str] = "the first stimulus is the reference, named and hidden"

    def draw(self, names: Sequence[str], count: int, random: np.random.Generator) -> list[Assignment]:
        orders = [random.permutation(len(names)) for _ in range(count)]
        return [({label: names[i] for label, i in zip(LABELS, order, strict=False)}, "") for order in orders]

    def problems(self, plan: StudyPlan) -> Iterator[str]:
        if not plan.ratings:
            yield "ratings: mushra only rates; write [[ratings]], with points = 101 for a slider"

    def shown_reference(self, item: Item) -> Stimulus | None:
        return item.reference or item.stimuli[0]


class _Adaptive(Forced):
    """A 2afc that finds a threshold. article : what such a study is called."""

    trial_s: ClassVar[float] = 15.0
    adaptive: ClassVar[bool] = True
    article: ClassVar[str]

    def problems(self, plan: StudyPlan) -> Iterator[str]:
        if plan.ratings:
            yield f"ratings: {self.article} asks which one is stronger and nothing else"
        if plan.claim:
            yield f"claim: {self.article} finds a threshold and decides nothing; leave it out"
        for item in plan.items:
            same = {msgspec.structs.replace(s.unchanged, name="same") for s in item.stimuli}
            if len(same) > 1 or any(s != s.unchanged for s in item.stimuli):
                reason = (
                    f"both stimuli must be the same rendering; {self.article} makes the second one stronger"
                )
                yield f"items ({item.name!r}): {reason}"


class Staircases(_Adaptive):
    """A 2afc whose comparison approaches the standard down to the discrimination threshold."""

    sentence: ClassVar[str] = "A and B hide {names}; {last} has more force, and must be named."
    article: ClassVar[str] = "a staircase"
    no_power: ClassVar[str] = f"{article} finds a threshold and claims nothing"

    def problems(self, plan: StudyPlan) -> Iterator[str]:
        if plan.staircase is None:
            yield "staircase: there is none; write [staircase]"
        elif plan.staircase.dropped > plan.staircase.reversals - 2:
            yield "staircase: dropped must leave at least 2 of the reversals"
        yield from super().problems(plan)


class ThresholdTrials(_Adaptive):
    """A 2afc whose comparison has more force, snap or vibration, by what is expected to say most."""

    sentence: ClassVar[str] = "A and B hide {names}; {last} has more of something, and must be named."
    article: ClassVar[str] = "a study of thresholds"
    no_power: ClassVar[str] = f"{article} finds a threshold and claims nothing"

    def problems(self, plan: StudyPlan) -> Iterator[str]:
        yield from self._rule_problems(plan)
        yield from super().problems(plan)

    def _rule_problems(self, plan: StudyPlan) -> Iterator[str]:
        rule = plan.thresholds
        if rule is None:
            yield "thresholds: there is none; write [thresholds]"
            return
        if not rule.dimensions:
            yield "thresholds, dimensions: there is none; name force, snap or vibration"
        yield from twice_problems("thresholds, dimensions", rule.dimensions)
        for name in rule.dimensions:
            expected, largest = getattr(rule.expected_ratio, name), getattr(rule.largest_ratio, name)
            if largest < expected:
                text = f"{name} {largest:g} is below the expected JND of {expected:g}"
                yield f"thresholds, largest_ratio: {text}"
        if plan.rounds != 1:
            yield "rounds: thresholds have one; ask for more trials instead"


BUILT_IN = MappingProxyType(
    {
        "realism": Realism(),
        "abx": Abx(),
        "2afc": Forced(),
        "2ac": ForcedOrNone(),
        "preference": Preference(),
        "mushra": Mushra(),
        "staircase": Staircases(),
        "thresholds": ThresholdTrials(),
    }
)


def task_names() -> tuple[str, ...]:
    """Return the names of all tasks that are installed."""
    return (*BUILT_IN, *extras.names("tasks"))


def task_of(kind: str, source: object = "study") -> StudyTask:
    """Return the task that a plan declares as its kind. InputError, in source, where it is not installed."""
    if task := BUILT_IN.get(kind):
        return task
    if kind not in task_names():
        remedy = did_you_mean(kind, task_names())
        raise InputError(source, "kind", f"{kind!r:.40} is no task that is installed", remedy)
    added: StudyTask = extras.load("tasks", kind)
    return added


def task_behind(kind: str) -> StudyTask:
    """Return the task of answers: of a kind that no plan declares, as timing, one that asks nothing."""
    return task_of(kind) if kind in task_names() else StudyTask()
