"""What an analysis of answers found, as records."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from fdvv.model.noticeable import Dimension
from fdvv.units import FloatArray
from fdvv_people.stats.anova import Anova
from fdvv_people.stats.effect_size import Estimate
from fdvv_people.stats.ordinal import OrdinalModel
from fdvv_people.stats.post_hoc import PairedTest
from fdvv_people.stats.rank_tests import Friedman, RankPair, SignedRank
from fdvv_people.stats.share import Share, SignTest
from fdvv_people.stats.thurstone import DPrime
from fdvv_people.study.plan.answers import Screening
from fdvv_people.study.plan.plan import Claim
from fdvv_people.thresholds.estimate import JndEstimate

UNITS = ("s", "ms", "us")
ALL_BUTTONS = ""
"""Name of the row that counts all buttons together."""


@dataclass(frozen=True)
class ChoiceResult:
    """What was chosen: more, less or neither; or how often an answer was right and wrong.

    Attributes
    ----------
    button : ALL_BUTTONS for all. missing : trials without an answer. share : of more among all answers, every
        answer counted as independent. people_share : the same, people counted as people; None of one person.
    split : ties counted as halves. dropped : ties left out; None where nothing else is left.
    test : of people's share less one half, ties as halves; None of one person. sign : people on each side.
    p_holm : of test's exact p, for all buttons. d : distance felt, by each rule; the first is reported.
    """

    button: str
    more: str
    less: str
    more_count: int
    equal_count: int
    less_count: int
    missing: int
    share: Share
    people_share: Share | None
    split: float
    dropped: Share | None
    test: SignedRank | None
    sign: SignTest
    p_holm: float | None
    d: tuple[DPrime, ...]

    @property
    def interval(self) -> Share:
        """The share with the interval that is reported: that of people where there are some."""
        return self.people_share or self.share

    def to_dict(self) -> dict[str, Any]:
        """Return every figure, the reported share and interval first."""
        share = self.interval
        return {
            "button": self.button,
            "share": share.share,
            "low": share.low,
            "high": share.high,
            "method": share.method,
            "more": {"name": self.more, "count": self.more_count},
            "less": {"name": self.less, "count": self.less_count},
            "equal": self.equal_count,
            "missing": self.missing,
            "answers": self.share.n,
            "as_independent": asdict(self.share),
            "icc": share.icc,
            "ties_split": self.split,
            "ties_dropped": self.dropped and asdict(self.dropped),
            "test": self.test and asdict(self.test),
            "sign": asdict(self.sign),
            "p_holm": self.p_holm,
            "d_prime": [asdict(one) for one in self.d],
        }


@dataclass(frozen=True)
class ClaimResult:
    """The main claim.

    Attributes
    ----------
    registered : it was fixed in a plan; else it is the kind's usual one. measure : what it was tested on.
    test : of people's means. p_exact below claim.alpha and an effect above 0 support it.
    """

    claim: Claim
    registered: bool
    measure: str
    test: SignedRank

    @property
    def supported(self) -> bool:
        return self.test.p_exact < self.claim.alpha and self.test.effect > 0

    @property
    def opposed(self) -> bool:
        return self.test.p_exact < self.claim.alpha and self.test.effect < 0


@dataclass(frozen=True)
class Spread:
    """Means of people, one number a person: how many, their mean with its 95 % interval, SD and median."""

    people: int
    mean: float
    low: float
    high: float
    sd: float
    median: float


@dataclass(frozen=True)
class ButtonTest:
    """Ratings of one button: more against less, people's means over rounds.

    Attributes
    ----------
    test : of people's differences, more minus less, each the mean of the trials in which they rated both.
    p_holm : its exact p, for all buttons of the rating. unpaired : ratings that stand alone in their trial,
        and were left out.
    """

    button: str
    rating: str
    more: str
    less: str
    more_spread: Spread
    less_spread: Spread
    test: SignedRank
    p_holm: float
    unpaired: int = 0

    def to_dict(self) -> dict[str, Any]:
        """Return every figure, those of the test beside the button's name."""
        return {
            "button": self.button,
            "rating": self.rating,
            **asdict(self.test),
            "p_holm": self.p_holm,
            "unpaired_ratings": self.unpaired,
            "more": {"name": self.more, **asdict(self.more_spread)},
            "less": {"name": self.less, **asdict(self.less_spread)},
        }


@dataclass(frozen=True)
class ScaleResult:
    """Ratings of all buttons as ordered categories; model.problem says where it does not hold."""

    rating: str
    more: str
    less: str
    model: OrdinalModel


@dataclass(frozen=True)
class RatedResult:
    """Several renderings rated beside each other: MUSHRA.

    Attributes
    ----------
    button : ALL_BUTTONS for people's means over buttons. spreads : by stimulus. friedman : None where it
        cannot be computed; of people who rated all stimuli in a trial, and of those trials. pairs : of all
        stimuli, of trials in which both were rated, Holm's correction. unpaired : ratings of trials that lack
        one, which the test of all leaves out.
    """

    button: str
    rating: str
    spreads: Mapping[str, Spread]
    friedman: Friedman | None
    pairs: tuple[RankPair, ...]
    unpaired: int = 0


@dataclass(frozen=True, eq=False)
class ThresholdResult:
    """One staircase of a person: ratios and answers in order, and the threshold it found, as a ratio."""

    person: str
    button: str
    ratios: FloatArray
    correct: FloatArray
    threshold: Estimate


@dataclass(frozen=True, eq=False)
class JndSurface:
    """Just noticeable changes of two dimensions together. points : as of `ThresholdEstimate.surface`."""

    across: Dimension
    up: Dimension
    points: FloatArray


@dataclass(frozen=True, eq=False)
class JndResult:
    """What the trials of one person and button say.

    Attributes
    ----------
    jnds : of the dimensions that were measured. surfaces : of every pair of them. trials, correct : that
        count, and the part that was right.
    """

    person: str
    button: str
    jnds: Mapping[Dimension, JndEstimate]
    surfaces: tuple[JndSurface, ...]
    trials: int
    correct: float


@dataclass(frozen=True)
class PersonResult:
    """What one person did: trials planned, answered and left out, and what they say.

    Attributes
    ----------
    share : of more among the answers, ties as halves. differences : of mean ratings, more minus less.
    reason : why the person does not count; "" where they do. median_s : of a trial; nan where unknown.
    """

    person: str
    planned: int
    answered: int
    left_out: int
    share: float
    differences: Mapping[str, float]
    median_s: float
    reason: str


@dataclass(frozen=True, eq=False)
class TimingResult:
    """Scores by button and level: (people, buttons, levels), rounds averaged. anova : None without a test."""

    measure: str
    buttons: tuple[str, ...]
    levels: tuple[str, ...]
    scores: FloatArray
    anova: Anova | None
    pairs: Mapping[str, tuple[PairedTest, ...]]

    @property
    def measure_text(self) -> str:
        """The name of the scores with its unit in brackets: asynchrony_ms is asynchrony (ms)."""
        name, _, unit = self.measure.rpartition("_")
        return f"{name.replace('_', ' ')} ({unit})" if name and unit in UNITS else self.measure


@dataclass(frozen=True, eq=False)
class StudyAnalysis:
    """Everything that answers say.

    Attributes
    ----------
    title : of the study, or of the file. kind : of the study. buttons, stimuli : names, in order.
    simulated : no person took part: a proxy, no evidence.
    tests : ratings by button. scales : ratings as ordered categories. rated : MUSHRA. preference : all
        buttons. by_button : each. thresholds : of staircases; threshold : over people.
        timing : by ANOVA. jnds : of people and buttons; jnd : over people, by dimension. standards : by
        button and dimension what a JND is a part of, cN or m/s². notes : what could not be computed, and why.
    """

    title: str
    kind: str
    buttons: tuple[str, ...]
    stimuli: tuple[str, ...]
    simulated: bool
    screening: Screening
    people: tuple[PersonResult, ...]
    claim: ClaimResult | None = None
    tests: tuple[ButtonTest, ...] = ()
    scales: tuple[ScaleResult, ...] = ()
    rated: tuple[RatedResult, ...] = ()
    preference: ChoiceResult | None = None
    by_button: tuple[ChoiceResult, ...] = ()
    thresholds: tuple[ThresholdResult, ...] = ()
    threshold: Spread | None = None
    timing: TimingResult | None = None
    jnds: tuple[JndResult, ...] = ()
    jnd: Mapping[Dimension, Spread] = field(default_factory=dict)
    standards: Mapping[str, Mapping[Dimension, float]] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
