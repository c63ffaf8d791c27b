"""A small study, people in it, and a stage that presses nothing: for tests of sessions."""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping
from pathlib import Path

from fdvv.errors import DeviceError
from fdvv_people.study.admin.study import Study
from fdvv_people.study.files.seal import Cost
from fdvv_people.study.plan.events import TrialFace, rated_labels
from fdvv_people.study.plan.plan import Stimulus
from fdvv_people.study.plan.sitting import Step
from fdvv_people.study.plan.trial import Rendered, TrialAnswer
from fdvv_people.study.session.participant import Participant
from fdvv_people.study.stimulus.renderer import StimulusRenderer

PASSPHRASE = "correct horse battery staple"
CHEAP = Cost(1, 8192)
PLAN = """
name = "demo"
title.en = "Demo"
title.de = "Probe"
kind = "realism"
rounds = {rounds}
practice = {practice}
people = 4
languages = ["en", "de"]
break_every_min = {break_every_min}
break_min = {break_min}
switch_s = 0.0
{more}
[[items]]
name = "Clear"
stimuli = [
    {{ name = "FD", button = "mx-clear", rendered = "FD" }},
    {{ name = "FDVV", button = "mx-clear", rendered = "FDVV" }},
]
[[items]]
name = "Dome"
stimuli = [
    {{ name = "FD", button = "rubber-dome", rendered = "FD" }},
    {{ name = "FDVV", button = "rubber-dome", rendered = "FDVV" }},
]
[[ratings]]
name = "realism"
question.en = "How real?"
question.de = "Wie echt?"
{tables}
"""
CONSENT = """
[[pages]]
name = "consent"
when = "consent"
title.en = "Consent"
title.de = "Einwilligung"
text.en = "Pressing buttons."
text.de = "Tasten drücken."
[[pages]]
name = "you"
when = "before"
title.en = "You"
title.de = "Sie"
[[pages.questions]]
name = "hand"
question.en = "Which hand?"
question.de = "Welche Hand?"
choices.en = ["left", "right"]
choices.de = ["links", "rechts"]
"""


def frozen_study(folder: Path, *, text: str = PLAN, **changes: object) -> Study:
    """Declare and freeze a study, its keys stretched cheaply."""
    about = {"rounds": 2, "practice": 1, "break_every_min": 0.0, "break_min": 0.0, "more": "", "tables": ""}
    study = Study.declare_text(folder, text.format(**(about | changes)), folder.parent)
    study.freeze(PASSPHRASE, CHEAP)
    return study


def enrolled(study: Study, stage: StimulusRenderer, **about: Callable[[], float]) -> tuple[Participant, str]:
    """Enrol somebody, their code stretched cheaply."""
    person, code = study.enrol(cost=CHEAP)
    return Participant.resume(study, person, code, stage, **about), code


class StillStage:
    """Renders nothing, and reports so many presses of every label.

    dies : says, each time it is used, whether the device goes away now.
    on_prepare : called with what is prepared.
    """

    simulated = True

    def __init__(
        self,
        dies: Callable[[], bool] = lambda: False,
        on_prepare: Callable[[Mapping[str, Stimulus]], None] = lambda _labels: None,
    ) -> None:
        self._dies, self._prepared_call = dies, on_prepare
        self.labels: Mapping[str, Stimulus] = {}
        self.shows: list[str] = []
        self.closed = False

    def prepare(self, labels: Mapping[str, Stimulus]) -> None:
        self._live("the image of FD cannot be stored")
        self.labels = labels
        self._prepared_call(labels)

    def show(self, label: str) -> None:
        self._live(f"{self.labels[label].name} fell into a fault")
        self.shows.append(label)

    def rendered(self) -> tuple[Rendered, ...]:
        self._live("telemetry of FDVV ended")
        return tuple(self._rendered(label, one) for label, one in self.labels.items())

    def _rendered(self, label: str, one: Stimulus) -> Rendered:
        # what differs between renderings differs in length here too
        error_cN = (1.0,) if one.rendered == "FD" else (2.25, 0.125)
        return Rendered(label, one.name, 2, error_cN, (80.0,), len(one.name))

    def close(self) -> None:
        self.closed = True

    def _live(self, reason: str) -> None:
        if self.closed or self._dies():
            raise DeviceError(reason)


def answer_of(trial: TrialFace, attempt: int = 1) -> TrialAnswer:
    """Return an answer that depends on trial and attempt only."""
    drawn = random.Random(f"{trial.number} {attempt}")
    ratings = {label: float(drawn.randint(1, 7)) for label in rated_labels(trial)}
    return TrialAnswer(drawn.choice(["A", "B", "equal"]), {"realism": ratings})


def do_step(one: Participant, step: Step[TrialFace]) -> None:
    """Do what a step asks, having felt every label."""
    if step.kind == "page":
        one.answer_page(step.page, {"hand": "right"} if step.page == "you" else {})
    elif step.kind == "break":
        one.end_break()
    else:
        one.show_trial(step.number)
        for label in step.trial.labels:
            one.go_to(label)
        assert one.trial is not None
        one.answer(step.number, answer_of(one.trial, one.state.attempts[step.number]))


def do_all(one: Participant, trials: int = 10_000) -> None:
    """Do all that is asked, or so many trials of it."""
    while (step := one.step()).kind not in ("done", "declined", "withdrawn") and len(
        one.state.answers
    ) < trials:
        do_step(one, step)
