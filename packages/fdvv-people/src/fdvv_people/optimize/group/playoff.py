"""Simulated people press again: the group's button and their own, in blocks. Simulated."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fdvv.errors import InputError
from fdvv_people.optimize.group.group import Group, PersonalRun
from fdvv_people.optimize.people.simulate import score_design
from fdvv_people.optimize.run.player import play_seed, player_of
from fdvv_people.optimize.run.setup import designer_of
from fdvv_people.optimize.run.verdict import Retest, paired

BLOCKS = 16
"""In each of which a person plays both buttons once; a trial of 20 presses takes 25 ms."""
PLAYOFF = 5
"""Purpose of the random numbers: the presses are none of a run's."""


@dataclass(frozen=True)
class PersonalGain:
    """What a person gains with a button of their own, in the objective's unit.

    Attributes
    ----------
    name : the person's. own, group : mean scores of both buttons. gain : with an interval over blocks; None
        where the group's button is the person's own.
    """

    name: str
    own: float
    group: float
    gain: Retest | None


@dataclass(frozen=True)
class Playoff:
    """What was played again.

    Attributes
    ----------
    people : in the order of the group. blocks : that each played.
    gain : mean over people with its interval (Student's t over people): it counts for people like these.
    """

    people: tuple[PersonalGain, ...]
    blocks: int
    gain: Retest

    @property
    def gaining(self) -> int:
        """How many people are better off with their own, each by their own interval."""
        return sum(one.gain is not None and one.gain.kind == "better" for one in self.people)


def play_off(
    group: Group, blocks: int = BLOCKS, progress: Callable[[int, int], None] = lambda _done, _total: None
) -> Playoff:
    """Let everybody play their own and the group's button in so many blocks, at least two.

    InputError where a person is not simulated.
    """
    found = []
    for number, run in enumerate(group.runs):
        progress(number, len(group.runs))
        found.append(_person(run, group, blocks))
    progress(len(group.runs), len(group.runs))
    gain = paired([one.gain.difference if one.gain else 0.0 for one in found])
    assert gain is not None  # a group has two people
    return Playoff(tuple(found), blocks, gain)


def _person(run: PersonalRun, group: Group, blocks: int) -> PersonalGain:
    if not run.setup.simulated:
        raise InputError("run", run.name, "is of no simulated person", "have both buttons played in a study")
    objective = run.setup.objectives[0]
    same = run.own == group.design
    own = [_score(run, run.own, 2 * block) for block in range(blocks)]
    other = own if same else [_score(run, group.design, 2 * block + 1) for block in range(blocks)]
    gains = [objective.sign * (theirs - mine) for theirs, mine in zip(other, own, strict=True)]
    gain = None if same else paired(gains)
    return PersonalGain(run.name, float(np.mean(own)), float(np.mean(other)), gain)


def _score(run: PersonalRun, design: dict[str, float], place: int) -> float:
    player, objective = player_of(run.setup), run.setup.objectives[0].name
    before = player.presses_before + run.played + place * player.task.rounds
    seed = play_seed(player.seed, PLAYOFF, place)
    model = designer_of(run.setup.space)(design)
    scores = score_design(player.task, model, player.user, seed, rig=player.rig, presses_before=before)
    return scores[objective].value
