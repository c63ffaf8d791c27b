"""A simulated person who tries the designs of an optimisation, one after the other. Simulated."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from fdvv.errors import InputError, ModelError
from fdvv_people.optimize.people.groups import PAPER_GROUP, group_named
from fdvv_people.optimize.people.press_simulator import TASK_RIGS, refusal_of
from fdvv_people.optimize.people.simulate import score_design
from fdvv_people.optimize.people.taste import Taste, draw_taste, rate
from fdvv_people.optimize.people.user import SimulatedUser, draw_user
from fdvv_people.optimize.problem import Trial, TrialState
from fdvv_people.optimize.run.session import Optimization
from fdvv_people.optimize.run.setup import OptimizeSetup
from fdvv_people.task.accuracy import Accuracy
from fdvv_people.task.pointing import LEVELS_px_s, TemporalPointing
from fdvv_people.task.questionnaire import LIKING, liking_score
from fdvv_people.task.tapping import RapidTapping
from fdvv_people.task.task import Task

SIMULATED_TASKS = POINTING, TAPPING, ACCURACY = "temporal-pointing", "tapping", "accuracy"
"""Names of the tasks that simulated people can play."""
TrialDone = Callable[[Trial], None]
"""Called with every trial when it is done or has failed."""


@dataclass(frozen=True)
class SimulatedPlayer:
    """Somebody simulated who plays a task with the designs of a run.

    Attributes
    ----------
    user : the person. task : what is played. rig : what renders the designs.
    seed : of the presses; those of a trial depend on it and on the trial's number alone.
    taste : what the person likes, for runs that ask.
    presses_before : made before the first trial, for users who learn or tire.
    """

    user: SimulatedUser
    task: Task
    rig: str = "ideal"
    seed: int = 0
    presses_before: int = 0
    taste: Taste = field(default_factory=Taste)

    def try_next(self, session: Optimization) -> Trial | None:
        """Try the next trial of a run, then of its retest; None when both are over.

        What the rig's firmware cannot hold fails with its reason; nobody presses it.
        """
        trial = next(iter(session.ask()), None)
        if trial is None:
            return None
        # a run killed in the middle of a trial has shown it already
        shown = trial if trial.state is TrialState.SHOWN else session.show(trial.number)
        model = session.button(shown)
        if refusal := refusal_of(model, self.rig):
            return session.give_up(shown.number, refusal)
        seed = play_seed(self.seed, shown.number)
        before = self.presses_before + shown.number * self.task.rounds
        scores = score_design(self.task, model, self.user, seed, rig=self.rig, presses_before=before)
        if session.setup.asks_liking:
            scores[LIKING.name] = liking_score(rate(model, self.taste, seed))
        return session.answer(shown.number, scores)

    def play(self, session: Optimization, report: TrialDone = lambda _trial: None) -> None:
        """Try trials until the run is over. An interrupted run continues with the same trials."""
        while (trial := self.try_next(session)) is not None:
            report(trial)


def play_seed(*path: int) -> int:
    """Make a seed of its own for a place in a study, as (seed, phase, number)."""
    return int(np.random.SeedSequence(path).generate_state(1, np.uint64)[0] >> 1)


def task_named(name: str, level: str | None, presses: int = 20, also: tuple[str, ...] = ()) -> Task:
    """Return a task by its name; level only where the task has levels, presses: of a trial.

    also : further objectives, of temporal pointing alone.

    InputError on one that no simulated person plays, an unknown level, presses too few for the task, and on
    objectives that it does not score.
    """
    if name not in SIMULATED_TASKS:
        known = ", ".join(SIMULATED_TASKS)
        raise InputError("task", name, "no simulated person plays it", f"use one of {known}")
    if name == POINTING and level not in LEVELS_px_s:
        raise InputError("level", str(level), "is unknown", f"use one of {', '.join(LEVELS_px_s)}")
    if also and name != POINTING:
        raise InputError(
            "objectives", also[0], f"is not scored in {name}", f"leave it out, or play {POINTING}"
        )
    try:
        if name == POINTING:
            return TemporalPointing(str(level), presses, also=also)
        return RapidTapping(presses) if name == TAPPING else Accuracy(presses)
    except ModelError as error:
        raise InputError("presses", str(presses), str(error), "give more") from error


def played_min(setup: OptimizeSetup, trials: int) -> float:
    """Return how long so many trials of temporal pointing take, in minutes, without breaks between them."""
    return trials * setup.presses * TemporalPointing(setup.level or "easy").period_s / 60


SIMULATED_PAIRS = 40
"""Of a retest; 20 presses of a simulated person take 25 ms."""
SIMULATED_BLOCKS = 16
"""Of a retest with four switches, one of them the start: as many trials."""


def about_player(person: int, rig: str, presses: int, group: str = PAPER_GROUP) -> dict[str, Any]:
    """Return what a setup keeps of who plays (``about``). Raises InputError on an unknown rig or group."""
    group_named(group)
    if rig not in TASK_RIGS:
        raise InputError("rig", rig, "none is called so", f"use one of {', '.join(TASK_RIGS)}")
    return {"player": {"person": person, "group": group, "rig": rig, "presses": presses}}


def person_of(setup: OptimizeSetup) -> int:
    """Return the seed of the simulated person that a setup names. InputError where it names none."""
    player = setup.about.get("player")
    if not isinstance(player, dict) or not isinstance(player.get("person"), int):
        remedy = "resume it in the studio, or begin a run with --person"
        raise InputError("run", "$.about.player", "no simulated person plays this run", remedy)
    return int(player["person"])


def player_of(setup: OptimizeSetup) -> SimulatedPlayer:
    """Return the simulated person that a setup names. InputError where it names none: a human plays it."""
    person, player = person_of(setup), setup.about["player"]
    presses, rig = int(player.get("presses", 20)), str(player.get("rig", "ideal"))
    # runs of an earlier fdvv name no group
    people = group_named(str(player.get("group", PAPER_GROUP)))
    user = draw_user(0, person, people)
    task = task_named(setup.task, setup.level, presses, setup.task_also)
    return SimulatedPlayer(user, task, rig, setup.seed, taste=draw_taste(0, person))
