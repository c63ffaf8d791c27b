"""What a study is: declared in a file that people write and read, and frozen before the first person."""

from __future__ import annotations

from typing import Annotated, Literal, Protocol

from msgspec import Meta, Struct, structs

from fdvv.model.noticeable import DIMENSIONS, Dimension
from fdvv_people.thresholds.prior import ThresholdPrior

Count = Annotated[int, Meta(ge=0, le=10_000)]
Name = Annotated[str, Meta(min_length=1, max_length=60)]


class Stimulus(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """Something that is rendered.

    Attributes
    ----------
    name : what analyses call it; the same in every item, as "FD" and "FDVV".
    button : a built-in button, or a model file beside the study.
    rendered : "FDVV": the whole model. "FD": one curve for all speeds and no vibration, the paper's rival.
    actuation : file beside the study that a rig was compensated with; "": the twin renders the model ideally,
        a device its own forces uncompensated.
    force_ratio, snap_ratio, vibration_ratio : by which all forces, the fall of force of the snap and all
        vibrations are multiplied (fdvv.model.magnify); staircases and thresholds set them.
    """

    name: Name
    button: Name
    rendered: Literal["FDVV", "FD"] = "FDVV"
    actuation: str = ""
    force_ratio: Annotated[float, Meta(gt=0, le=10)] = 1.0
    snap_ratio: Annotated[float, Meta(gt=0, le=10)] = 1.0
    vibration_ratio: Annotated[float, Meta(gt=0, le=10)] = 1.0

    @property
    def unchanged(self) -> Stimulus:
        """The same rendering with all its ratios at 1."""
        return structs.replace(self, force_ratio=1.0, snap_ratio=1.0, vibration_ratio=1.0)


class Item(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """A button that trials are about.

    Attributes
    ----------
    name : shown to participants.
    stimuli : what is compared; two, but for mushra, where the first is the reference that is hidden too.
    reference : what X is where it is rendered; None: a real button on the table, or X is one of the stimuli.
    """

    name: Name
    stimuli: tuple[Stimulus, ...]
    reference: Stimulus | None = None

    @property
    def rendered(self) -> tuple[Stimulus, ...]:
        """All that is rendered of it: what is compared, then the reference where that is rendered."""
        return self.stimuli if self.reference is None else (*self.stimuli, self.reference)


class Rating(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """A scale on which every hidden rendering of a trial is rated.

    Attributes
    ----------
    name : of the column. question, low, high : what is asked, and the words at its ends, by language.
    points : 7: 1 to 7; 101: a slider from 0 to 100.
    """

    name: Name
    question: dict[str, str]
    low: dict[str, str] = {}
    high: dict[str, str] = {}
    points: Annotated[int, Meta(ge=2, le=101)] = 7

    @property
    def ends(self) -> tuple[int, int]:
        """The lowest and the highest answer."""
        return (0, 100) if self.points == 101 else (1, self.points)


class Question(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """A question of a questionnaire. choices : by language; empty: free text, or a number in a range."""

    name: Name
    question: dict[str, str]
    choices: dict[str, tuple[str, ...]] = {}
    low: float | None = None
    high: float | None = None
    required: bool = True


class Page(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """A page outside the trials.

    Attributes
    ----------
    name : unique in the study. when : before, after or as consent. title, text : by language, in paragraphs.
    questions : asked on it; a consent page asks for agreement too, without which the person is out.
    """

    name: Name
    when: Literal["consent", "before", "after"]
    title: dict[str, str]
    text: dict[str, str] = {}
    questions: tuple[Question, ...] = ()


class Staircase(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """Levels of a transformed up-down rule (Levitt 1971).

    Attributes
    ----------
    start_ratio, steps_ratio : difference of force from the standard, and by what it is divided or multiplied
        after each reversal in turn, the last for all that follow. down : correct answers in a row before it
        gets harder (2: 70.7 %, 3: 79.4 %). reversals : that end it. trials : at most. dropped : first
        reversals that do not count.
    """

    start_ratio: Annotated[float, Meta(gt=0, le=1)] = 0.3
    steps_ratio: tuple[Annotated[float, Meta(gt=1, le=10)], ...] = (1.6, 1.25)
    down: Annotated[int, Meta(ge=1, le=4)] = 2
    reversals: Annotated[int, Meta(ge=2, le=40)] = 8
    trials: Annotated[int, Meta(ge=4, le=400)] = 60
    dropped: Annotated[int, Meta(ge=0, le=10)] = 2


class OfDimensions(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """A ratio for each dimension in which a button can grow.

    Attributes
    ----------
    force : of all forces. snap : of the fall of force from peak to valley. vibration : of its amplitude.
    """

    force: Annotated[float, Meta(gt=0, le=4)]
    snap: Annotated[float, Meta(gt=0, le=4)]
    vibration: Annotated[float, Meta(gt=0, le=4)]

    @property
    def all(self) -> tuple[float, float, float]:
        return self.force, self.snap, self.vibration


class Thresholds(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """How just noticeable differences are measured, trial by trial (fdvv_people.thresholds).

    Attributes
    ----------
    dimensions : in which the comparison grows. trials : of each item and person. combined : in every third
        trial several dimensions grow, so that it is measured how they add up.
    expected_ratio, spread : JND expected beforehand, and the standard deviation of its natural logarithm.
    largest_ratio : by which a comparison may grow.
    """

    dimensions: tuple[Dimension, ...] = DIMENSIONS
    trials: Annotated[int, Meta(ge=6, le=400)] = 54
    combined: bool = False
    expected_ratio: OfDimensions = OfDimensions(force=0.12, snap=0.5, vibration=0.4)
    spread: Annotated[float, Meta(gt=0, le=3)] = 0.7
    largest_ratio: OfDimensions = OfDimensions(force=1.0, snap=2.0, vibration=3.0)

    @property
    def prior(self) -> ThresholdPrior:
        """What is assumed of a person before the first trial."""
        return ThresholdPrior(jnd_ratio=self.expected_ratio.all, jnd_spread=self.spread)


class Exclusion(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """Rules, fixed before the first person, by which a trial or a person does not count.

    Attributes
    ----------
    error_cN : a trial in which half the presses of a rendering, or more, missed the intended force by more,
        rms. One press that was too fast for any rig costs nothing.
    presses : a trial in which a rendering was pressed less often. fault : a trial in which the device fell
        into a fault. share_missing : a person who lacks more than that part of the trials after all this.
    same_choice : a person who gave one label for more than that part of the trials.
    reference_points : mushra: a person who rated the hidden reference lower in more than 15 % of the trials.
    """

    error_cN: Annotated[float, Meta(gt=0)] = 20.0
    presses: Count = 1
    fault: bool = True
    share_missing: Annotated[float, Meta(ge=0, le=1)] = 0.25
    same_choice: Annotated[float, Meta(ge=0, le=1)] = 0.9
    reference_points: Annotated[float, Meta(ge=0, le=100)] = 90.0


class Claim(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """The main claim, stated before the first person.

    Attributes
    ----------
    more, less : stimuli: the first is chosen, or rated, above the second. measure : "choice" or a rating's
        name; in abx a choice counts as right or wrong, and the claim is that people discriminate the two.
    alpha : level of the test, two-sided.
    """

    more: Name
    less: Name
    measure: str = "choice"
    alpha: Annotated[float, Meta(gt=0, lt=1)] = 0.05


class DeclaredPlan(Protocol):
    """What plans of every kind of study have."""

    @property
    def name(self) -> str:
        """Of the study."""

    @property
    def people(self) -> int:
        """How many are planned."""

    @property
    def trials(self) -> int:
        """How many one of them has, at most."""

    @property
    def languages(self) -> tuple[str, ...]:
        """The first is the default."""

    @property
    def pages(self) -> tuple[Page, ...]:
        """Outside the trials, in order."""

    @property
    def named(self) -> frozenset[str]:
        """Built-in buttons, and the files beside the study, that the plan names."""


class StudyPlan(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """A study as it is declared; `plan_problems` lists what is wrong with it.

    Attributes
    ----------
    name, title : of the study; title by language. kind : the name of the task, see `tasks`.
    question : what is asked in a trial, by language; {}: the kind's own words.
    items : buttons, in an order that means nothing. rounds : trials of each item and person.
    practice : trials before, on the first items, never analysed. people : that are planned.
    ratings : asked in every trial. order : of items: "williams" squares over people and rounds, or "random".
    break_every_min, break_min : the first trial boundary after so long begins a break of so long.
    languages : the first is the default. pages : outside the trials, in order.
    switch_s : every change of what is rendered takes as long, whichever it is. ties : the answer "equal" is
        offered where the kind allows it. staircase, thresholds, exclusion, claim : see there.
    """

    format: Literal["fdvv-study"] = "fdvv-study"
    version: Literal[1] = 1
    name: Name
    title: dict[str, str]
    kind: str
    items: tuple[Item, ...]
    question: dict[str, str] = {}
    rounds: Annotated[int, Meta(ge=1, le=100)] = 6
    practice: Annotated[int, Meta(ge=0, le=20)] = 2
    people: Annotated[int, Meta(ge=1, le=1000)] = 12
    ratings: tuple[Rating, ...] = ()
    order: Literal["williams", "random"] = "williams"
    ties: bool = True
    break_every_min: Annotated[float, Meta(ge=0)] = 20.0
    break_min: Annotated[float, Meta(ge=0)] = 3.0
    languages: tuple[str, ...] = ("en",)
    pages: tuple[Page, ...] = ()
    switch_s: Annotated[float, Meta(ge=0, le=30)] = 0.6
    staircase: Staircase | None = None
    thresholds: Thresholds | None = None
    exclusion: Exclusion = Exclusion()
    claim: Claim | None = None

    @property
    def named(self) -> frozenset[str]:
        """Built-in buttons, and the files beside the study, that the plan names."""
        rendered = [one for item in self.items for one in item.rendered]
        return frozenset(name for one in rendered for name in (one.button, one.actuation) if name)

    @property
    def trials(self) -> int:
        """How many trials a person has at most, practice left out."""
        return len(self.items) * self.rounds * self.block

    @property
    def block(self) -> int:
        """How many trials an item has in each round, at most."""
        rule = self.thresholds or self.staircase
        return rule.trials if rule else 1
