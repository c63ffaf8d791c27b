"""A simulated participant before the screens of a study: feels through the stage, answers, fills in pages."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path

import numpy as np

from fdvv.study import (
    EQUAL,
    FeltDifference,
    FeltFeatures,
    Item,
    Page,
    ProxySettings,
    Question,
    Rendered,
    Senses,
    Stimulus,
    StudyPlan,
    TrialAnswer,
    Value,
    draw_people,
    felt_difference,
    felt_features,
    proxy_trials,
)
from fdvv.workflow._study_effects import reference_of
from fdvv.workflow._study_stage import StudyStage, stimulus_model

SAID = "simulated participant"
"""What stands where a person would write free text."""
AGAIN_ratio = 0.5
"""Chance that a person goes back to a label after having felt all, each time."""


class FeltStage:
    """A stage under the hand of a simulated participant, who feels what is shown.

    Attributes
    ----------
    felt : stimuli of the labels that were shown since prepare().
    """

    simulated, person = True, False

    def __init__(self, stage: StudyStage) -> None:
        self._stage = stage
        self._prepared: dict[str, Stimulus] = {}
        self.felt: dict[str, Stimulus] = {}

    def prepare(self, labels: Mapping[str, Stimulus]) -> None:
        """Make ready what each label hides."""
        self._stage.prepare(labels)
        self._prepared, self.felt = dict(labels), {}

    def show(self, label: str) -> None:
        """Make a label felt."""
        self._stage.show(label)
        self.felt[label] = self._prepared[label]

    def rendered(self) -> tuple[Rendered, ...]:
        """Tell what was rendered."""
        return self._stage.rendered()

    def close(self) -> None:
        """Let go."""
        self._stage.close()


class UnpressedStage:
    """Renders and presses nothing, for speed: presses are counted, no error can be judged. Simulated."""

    simulated, person = True, False

    def __init__(self) -> None:
        self._names: dict[str, str] = {}
        self._presses: dict[str, int] = {}

    def prepare(self, labels: Mapping[str, Stimulus]) -> None:
        """Note what each label hides."""
        self._names = {label: stimulus.name for label, stimulus in labels.items()}
        self._presses = dict.fromkeys(self._names, 0)

    def show(self, label: str) -> None:
        """Count one press."""
        self._presses[label] += 1

    def rendered(self) -> tuple[Rendered, ...]:
        """Tell that it was pressed, and of no force."""
        return tuple(
            Rendered(label, name, self._presses[label], (None,) * self._presses[label])
            for label, name in sorted(self._names.items())
        )

    def close(self) -> None:
        """Nothing is held."""


class SimulatedParticipant:
    """One simulated person in one study. **A proxy**: nothing it says is evidence.

    Parameters
    ----------
    plan, folder : of the study. stage : through which it feels; its own stage for a participant's session.
    number, seed : who it is, among those of one seed. settings : of all of them.
    """

    def __init__(
        self,
        plan: StudyPlan,
        folder: Path,
        stage: StudyStage,
        number: int = 0,
        seed: int = 0,
        settings: ProxySettings | None = None,
    ) -> None:
        self._plan, self._folder, self.stage = plan, folder, FeltStage(stage)
        self._settings = settings or ProxySettings()
        self._random = np.random.default_rng([seed, number])
        self._whole = draw_people(self._random, (1,), self._settings)

    def order(self, labels: tuple[str, ...]) -> tuple[str, ...]:
        """Tell in which order it goes to a trial's labels: X first, each once, then some again."""
        found = list(labels)
        while self._random.uniform() < AGAIN_ratio:
            found.append(labels[int(self._random.integers(len(labels)))])
        return tuple(found)

    def takes_s(self) -> float:
        """Tell how long it takes for a trial."""
        spread = self._settings.trial_spread_ratio * float(self._random.standard_normal())
        return self._settings.trial_s * float(np.exp(spread))

    def answer(self, item_name: str) -> TrialAnswer:
        """Answer the trial whose labels were felt on the stage."""
        item = next(item for item in self._plan.items if item.name == item_name)
        places = self._places(item)
        first, second = places[0], places[1]
        reference = self.stage.felt.get("X") or reference_of(self._plan, item, self._stimulus(first))
        to_reference = [self._apart(self._stimulus(label), reference) for label in places]
        trials = proxy_trials(
            self._plan.kind,
            self._whole,
            self._apart(self._stimulus(first), self._stimulus(second))[..., None],
            np.stack(to_reference, axis=-1)[:, None, :],
            self._random,
            self._plan.ties,
            tuple(rating.points for rating in self._plan.ratings),
            np.asarray([[int(self._stimulus(first).name != reference.name)]]),
        )
        chosen = int(trials.chosen[0, 0])
        asked = self._plan.kind != "mushra"
        return TrialAnswer(
            choice=(EQUAL if chosen < 0 else places[chosen]) if asked else "",
            ratings={
                rating.name: dict(zip(places, points[0, 0].tolist(), strict=True))
                for rating, points in zip(self._plan.ratings, trials.ratings, strict=True)
            },
        )

    def fill_in(self, page: Page, language: str) -> dict[str, Value]:
        """Fill in a page: any choice, any whole number of a range, and that it is simulated."""
        return {one.name: self._filled(one, language) for one in page.questions}

    def _filled(self, question: Question, language: str) -> Value:
        choices = question.choices.get(language) or next(iter(question.choices.values()), ())
        if choices:
            return choices[int(self._random.integers(len(choices)))]
        if question.low is None and question.high is None:
            return SAID
        low = question.low if question.low is not None else question.high
        high = question.high if question.high is not None else question.low
        assert low is not None
        assert high is not None
        return float(np.clip(np.rint(self._random.uniform(low, high)), low, high))

    def _places(self, item: Item) -> list[str]:
        """Give the labels but X, those first that the claim is about: what counts, then its rival."""
        claim = self._plan.claim
        counted = item.stimuli[1].name if claim is None else claim.more
        rival = item.stimuli[0].name if claim is None else claim.less
        ranks = {counted: 0, rival: 1}
        labels = sorted(label for label in self.stage.felt if label != "X")
        return sorted(labels, key=lambda label: ranks.get(self._stimulus(label).name, 2))

    def _stimulus(self, label: str) -> Stimulus:
        return self.stage.felt[label]

    def _apart(self, first: Stimulus, second: Stimulus) -> np.ndarray:
        """Give how far two stimuli are apart for this person, (1,)."""
        return self._whole.felt_JND(difference_of(first, second, self._folder, self._settings.senses))


@lru_cache(maxsize=4096)
def difference_of(first: Stimulus, second: Stimulus, folder: Path, senses: Senses) -> FeltDifference:
    """Give how far two stimuli of a study are apart."""
    of_first, of_second = _features(first, folder, senses), _features(second, folder, senses)
    return felt_difference(of_first, of_second, senses)


@lru_cache(maxsize=1024)
def _features(stimulus: Stimulus, folder: Path, senses: Senses) -> FeltFeatures:
    return felt_features(stimulus_model(stimulus, folder), senses)
