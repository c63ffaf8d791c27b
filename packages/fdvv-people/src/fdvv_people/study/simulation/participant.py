"""A simulated participant at the screens of a study: feels the renderings, answers, fills in pages."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path

import numpy as np

from fdvv_people.study.admin.study import Study
from fdvv_people.study.plan.events import TrialFace, Value
from fdvv_people.study.plan.plan import Item, Page, Question, Stimulus, StudyPlan
from fdvv_people.study.plan.sitting import Step
from fdvv_people.study.plan.tasks import task_of
from fdvv_people.study.plan.trial import EQUAL, Rendered, TrialAnswer
from fdvv_people.study.session.participant import Participant
from fdvv_people.study.simulation.judgement import proxy_trials
from fdvv_people.study.simulation.people import ProxySettings, draw_people
from fdvv_people.study.simulation.perception import PerceivedDifference, Senses, perceived_difference
from fdvv_people.study.simulation.sessions import SimulatedClock
from fdvv_people.study.simulation.study_power import reference_of, stimulus_features
from fdvv_people.study.stimulus.renderer import StimulusRenderer

SAID = "simulated participant"
"""Answer to questions that ask for free text."""
AGAIN_ratio = 0.5
"""Chance that a person goes back to a label after having felt all, each time."""


class RecordingRenderer:
    """A renderer pressed by a simulated participant, who feels what is shown.

    Attributes
    ----------
    shown : stimuli of the labels that were shown since prepare().
    """

    simulated = True

    def __init__(self, renderer: StimulusRenderer) -> None:
        self._prepared: dict[str, Stimulus] = {}
        self.shown: dict[str, Stimulus] = {}
        self._renderer = renderer
        self.rendered, self.close = renderer.rendered, renderer.close

    def prepare(self, labels: Mapping[str, Stimulus]) -> None:
        self._renderer.prepare(labels)
        self._prepared, self.shown = dict(labels), {}

    def show(self, label: str) -> None:
        self._renderer.show(label)
        self.shown[label] = self._prepared[label]


class NullRenderer:
    """Renders and presses nothing, for speed: presses are counted, no error can be judged. Simulated."""

    simulated = True

    def __init__(self) -> None:
        self._names: dict[str, str] = {}
        self._presses: dict[str, int] = {}

    def prepare(self, labels: Mapping[str, Stimulus]) -> None:
        self._names = {label: stimulus.name for label, stimulus in labels.items()}
        self._presses = dict.fromkeys(self._names, 0)

    def show(self, label: str) -> None:
        self._presses[label] += 1

    def rendered(self) -> tuple[Rendered, ...]:
        return tuple(
            Rendered(label, name, self._presses[label], (None,) * self._presses[label])
            for label, name in sorted(self._names.items())
        )

    def close(self) -> None:
        """Do nothing."""


def filled_page(page: Page, language: str, random: np.random.Generator) -> dict[str, Value]:
    """Fill in a page: any choice, any whole number of a range, and that it is simulated."""
    return {one.name: _filled(one, language, random) for one in page.questions}


def _filled(question: Question, language: str, random: np.random.Generator) -> Value:
    choices = question.choices.get(language) or next(iter(question.choices.values()), ())
    if choices:
        return choices[int(random.integers(len(choices)))]
    if question.low is None and question.high is None:
        return SAID
    ends = [end for end in (question.low, question.high) if end is not None]
    low, high = ends[0], ends[-1]
    return float(np.clip(np.rint(random.uniform(low, high)), low, high))


class SimulatedParticipant:
    """One simulated person in one study. **A proxy**: nothing it says is evidence.

    Parameters
    ----------
    plan, folder : of the study. renderer : through which it feels; its own `renderer` for a session.
    number, seed : who it is, among those of one seed. settings : of all of them.
    """

    def __init__(
        self,
        plan: StudyPlan,
        folder: Path,
        renderer: StimulusRenderer,
        number: int = 0,
        seed: int = 0,
        settings: ProxySettings | None = None,
    ) -> None:
        self._plan, self._folder, self.renderer = plan, folder, RecordingRenderer(renderer)
        self._settings = settings or ProxySettings()
        self._random = np.random.default_rng([seed, number])
        self._people = draw_people(self._random, (1,), self._settings)

    def order(self, labels: tuple[str, ...]) -> tuple[str, ...]:
        """Return in which order it goes to a trial's labels: X first, each once, then some again."""
        found = labels
        while self._random.uniform() < AGAIN_ratio:
            found += (labels[int(self._random.integers(len(labels)))],)
        return found

    def takes_s(self) -> float:
        spread = self._settings.trial_spread_ratio * float(self._random.standard_normal())
        return self._settings.trial_s * float(np.exp(spread))

    def answer(self, item_name: str) -> TrialAnswer:
        item = next(item for item in self._plan.items if item.name == item_name)
        places, shown = self._ranked(item), self.renderer.shown
        first, second, task = places[0], places[1], task_of(self._plan.kind)
        between_JND = self._apart(shown[first], shown[second])
        reference = shown.get("X") or reference_of(self._plan, item, shown[first])
        to_reference = [self._apart(shown[label], reference) for label in places]
        trials = proxy_trials(
            self._plan.kind,
            self._people,
            between_JND[..., None],
            np.stack(to_reference, axis=-1)[:, None, :],
            self._random,
            self._plan.ties,
            tuple(rating.points for rating in self._plan.ratings),
            np.asarray([[int(shown[first].name != reference.name)]]),
        )
        chosen = int(trials.chosen[0, 0])
        own = task.simulate(self._people, float(between_JND[0]), self._random)
        return TrialAnswer(
            choice=own or (EQUAL if chosen < 0 else places[chosen]) if task.choices else "",
            ratings={
                rating.name: dict(zip(places, points[0, 0].tolist(), strict=True))
                for rating, points in zip(self._plan.ratings, trials.ratings, strict=True)
            },
        )

    def sit_down(self, study: Study, person: str, code: str, clock: SimulatedClock) -> Participant:
        """Begin, or resume, the session of a person of a study."""
        return Participant.resume(study, person, code, self.renderer, clock=clock)

    def do(self, participant: Participant, step: Step[TrialFace], clock: SimulatedClock) -> None:
        """Feel and answer the trial of a step."""
        participant.show_trial(step.number)
        order = self.order(step.trial.labels)
        piece_s = self.takes_s() / (len(order) + 1)
        for label in order:
            participant.go_to(label)
            clock.skip(piece_s)
        clock.skip(piece_s)
        participant.answer(step.number, self.answer(step.trial.item))

    def fill_in(self, page: Page, language: str) -> dict[str, Value]:
        """Fill in a page: any choice, any whole number of a range, and that it is simulated."""
        return filled_page(page, language, self._random)

    def _ranked(self, item: Item) -> list[str]:
        claim = self._plan.claim
        counted = item.stimuli[1].name if claim is None else claim.more
        rival = item.stimuli[0].name if claim is None else claim.less
        ranks = {counted: 0, rival: 1}
        shown = self.renderer.shown
        labels = sorted(label for label in shown if label != "X")
        return sorted(labels, key=lambda label: ranks.get(shown[label].name, 2))

    def _apart(self, first: Stimulus, second: Stimulus) -> np.ndarray:
        return self._people.felt_JND(difference_of(first, second, self._folder, self._settings.senses))


@lru_cache(maxsize=4096)
def difference_of(first: Stimulus, second: Stimulus, folder: Path, senses: Senses) -> PerceivedDifference:
    return perceived_difference(_features(first, folder, senses), _features(second, folder, senses), senses)


# the files of a frozen study do not change
_features = lru_cache(maxsize=1024)(stimulus_features)
