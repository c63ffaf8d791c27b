"""A simulated person in a timing session: every step of it, presses on the twin. Simulated."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from fdvv.errors import ModelError
from fdvv_people.optimize.people.groups import TAPPERS
from fdvv_people.optimize.people.press_simulator import refusal_of
from fdvv_people.optimize.people.simulate import simulate_task
from fdvv_people.optimize.people.user import SimulatedUser, UserSettings, draw_user
from fdvv_people.optimize.people.week import WeekGap, a_week_later
from fdvv_people.optimize.run.player import play_seed
from fdvv_people.study.admin.study import Study
from fdvv_people.study.plan.events import Value
from fdvv_people.study.plan.plan import Page
from fdvv_people.study.plan.sitting import Step
from fdvv_people.study.simulation.participant import filled_page
from fdvv_people.study.simulation.sessions import SimulatedClock
from fdvv_people.study.timing.buttons import Button, opened_button
from fdvv_people.study.timing.participant import BegunTrial, TimingParticipant
from fdvv_people.study.timing.plan import TimingPlan
from fdvv_people.study.timing.schedule import TimingFace
from fdvv_people.task.rounds import ClockSource, RoundTiming
from fdvv_people.task.tapping import RapidTapping
from fdvv_people.task.task import TaskPress

TIMING = RoundTiming(ClockSource.DEVICE, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, None, "button")
"""Of simulated presses: target and key are on one clock, without any delay."""
PLACE_s, BETWEEN_s = 20.0, 5.0
"""To put a switch on the table, and between two trials (assumed)."""
MOST_STROKES = 10
"""Strokes a second that are simulated of tapping; people make fewer (TAPPERS)."""


@dataclass
class SimulatedTimer:
    """One simulated person.

    Attributes
    ----------
    user : who it is in training. seed : of the study's simulation; presses depend on it, the person's number
        and the trial's alone. rig : what renders buttons, and stands under the switches. gap : what the time
        between training and validation does.
    """

    user: SimulatedUser
    seed: int
    rig: str = "ideal"
    gap: WeekGap = field(default_factory=WeekGap)

    def sit_down(self, study: Study, person: str, code: str, clock: SimulatedClock) -> TimingParticipant:
        """Begin, or resume, the session of a person of a study."""
        return TimingParticipant.resume(study, person, code, clock=clock)

    def fill_in(self, page: Page, language: str) -> dict[str, Value]:
        """Fill in a page, in a way that anybody could."""
        return filled_page(page, language, np.random.default_rng([self.seed, self.user.number]))

    def do(self, participant: TimingParticipant, step: Step[TimingFace], clock: SimulatedClock) -> None:
        """Place the switch of a step, or play its trial."""
        if step.kind == "place":
            clock.skip(PLACE_s)
            participant.place(step.number)
        else:
            clock.skip(BETWEEN_s)
            begun = self.play(participant, step.number)
            clock.skip(begun.rounds * participant.study.plan.round_s(step.trial.level))

    def play(self, participant: TimingParticipant, number: int) -> BegunTrial:
        """Play a trial, or what is left of it, round by round."""
        begun = participant.begin(number, "simulated")
        button = begun.button or _on_the_table(participant, begun)
        if refusal := refusal_of(button, self.rig):
            participant.fail(number, refusal)
            return begun
        for press in self._rounds(participant, begun, button)[begun.kept :]:
            participant.keep(number, press.target_s, press.activations_s, TIMING)
        return begun

    def _rounds(
        self, participant: TimingParticipant, begun: BegunTrial, button: Button
    ) -> Sequence[TaskPress]:
        plan, face = participant.study.plan, begun.face
        user = self.user if face.phase == "training" else self._later(participant)
        seed = play_seed(self.seed, user.number, face.number)
        task = RapidTapping(MOST_STROKES * plan.tap_s) if plan.tapping else begun.task
        before = face.number * plan.trial_rounds if face.phase == "training" else 0
        found = simulate_task(task, button, user, seed, rig=self.rig, presses_before=before)
        return seconds_of(found, plan.tap_s) if plan.tapping else found

    def _later(self, participant: TimingParticipant) -> SimulatedUser:
        plan = participant.study.plan
        if plan.training is None:
            return self.user
        return a_week_later(self.user, self.gap, plan.training_trials * plan.presses, self.seed)


def _on_the_table(participant: TimingParticipant, begun: BegunTrial) -> Button:
    """Return the model that stands for a switch or key."""
    study = participant.study
    return opened_button(study.folder, study.plan.condition(begun.face.switch))


def seconds_of(presses: Sequence[TaskPress], count: int) -> tuple[TaskPress, ...]:
    """Return taps by whole seconds from the first of them, as a screen keeps them.

    ModelError where nobody tapped at all.
    """
    keys = np.sort([key for press in presses for key in press.activations_s])
    if not keys.size:
        raise ModelError("nobody tapped")
    keys = keys - keys[0]
    second = keys.astype(int)
    return tuple(TaskPress(None, tuple(keys[second == i].tolist())) for i in range(count))


def draw_timer(plan: TimingPlan, number: int, seed: int, rig: str) -> SimulatedTimer:
    """Draw one person of a study, who of tapping has a finger's limit. rig : what renders buttons."""
    return SimulatedTimer(draw_user(number, seed, TAPPERS if plan.tapping else UserSettings()), seed, rig)
