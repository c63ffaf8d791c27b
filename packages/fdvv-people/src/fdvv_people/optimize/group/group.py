"""Runs of several people side by side: the button that is best for all of them, and each person's own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fdvv.errors import InputError
from fdvv.model.model import FDVVModel
from fdvv.units import FloatArray
from fdvv_people.optimize.engines.gp_model import finished, score_table
from fdvv_people.optimize.group.belief import GroupBelief, GroupScores, believe_group
from fdvv_people.optimize.problem import Trial
from fdvv_people.optimize.run.session import Optimization
from fdvv_people.optimize.run.setup import OptimizeSetup, designer_of
from fdvv_people.optimize.run.verdict import Retest
from fdvv_people.optimize.space import Design, DesignSpace

GROUP = "group"


@dataclass(frozen=True)
class PersonalRun:
    """What one person's run came to.

    Attributes
    ----------
    name : the person's, that of the run's folder. setup, space : of the run.
    trials : scored in the search. own : the design that is recommended to this person.
    played : presses that the person has made, those of the end too.
    """

    name: str
    setup: OptimizeSetup
    space: DesignSpace
    trials: tuple[Trial, ...]
    own: dict[str, float]
    played: int


@dataclass(frozen=True, eq=False)
class Group:
    """Several people, the button for all of them and each person's own.

    Attributes
    ----------
    runs : one per person. design : best for all on average, by what is expected of each of them.
    expected : (people,) by how much each person's own is expected to be better than it, in the objective's
        unit. sd : (people,) of these. gain : their mean, see `expected_gain`.
    """

    runs: tuple[PersonalRun, ...]
    design: dict[str, float]
    expected: tuple[float, ...]
    sd: tuple[float, ...]
    gain: Retest

    @property
    def simulated(self) -> bool:
        """Whether all are simulated, so that they can press again at once."""
        return all(run.setup.simulated for run in self.runs)

    def model(self, design: Design, name: str = GROUP) -> FDVVModel:
        """Return the button that a design is. InputError where designs are another program's numbers."""
        return designer_of(self.runs[0].setup.space)(design).renamed(name)


def personal_run(session: Optimization, name: str) -> PersonalRun:
    """Return what a run came to. InputError where it is not over, or has no single score."""
    if session.setup.preference or len(session.problem.objectives) > 1:
        raise InputError("run", name, "has no single score", "use runs that are scored in one objective")
    own = session.recommended() if session.searched else None
    if own is None:
        raise InputError("run", name, "is not over", "go on with it: fdvv optimize resume, or the studio")
    played = session.setup.presses * (len(session.trials) + len(session.retests))
    done = tuple(finished(session.problem, session.trials))
    return PersonalRun(name, session.setup, session.space, done, own, played)


def read_personal_runs(folders: Sequence[Path]) -> tuple[PersonalRun, ...]:
    """Read the runs of several people, one each. InputError where they cannot be compared."""
    if len({folder.resolve() for folder in folders}) < len(folders):
        raise InputError("runs", "people", "one comes twice", "name a folder per person")
    return of_one_kind([_read(folder) for folder in folders])


def _read(folder: Path) -> PersonalRun:
    with Optimization.open(folder) as session:
        return personal_run(session, folder.resolve().name)


def of_one_kind(runs: Sequence[PersonalRun]) -> tuple[PersonalRun, ...]:
    """Return runs that can be compared. InputError on fewer than two people, and where they differ."""
    if len(runs) < 2:
        raise InputError("runs", "people", "are fewer than two", "name a run of each person")
    for run in runs[1:]:
        if different := _differs(runs[0], run):
            remedy = "use runs of one space, task and objective"
            reason = f"differs from {runs[0].name} in its {different}"
            raise InputError("run", run.name, reason, remedy)
    people = [run.setup.about.get("player") for run in runs]
    for number, person in enumerate(people):
        if person is not None and person in people[:number]:
            other = runs[people.index(person)].name
            raise InputError("run", runs[number].name, f"is of the same person as {other}", "leave one out")
    return tuple(runs)


def _differs(one: PersonalRun, other: PersonalRun) -> str:
    """Return what keeps two runs from being compared; empty if nothing does."""
    if (one.space.parameters, one.setup.space) != (other.space.parameters, other.setup.space):
        return "space"
    first, second = ((run.setup.task, run.setup.level, run.setup.presses) for run in (one, other))
    if first != second:
        return "task"
    return "" if one.setup.objectives == other.setup.objectives else "objective"


def group_of(runs: Sequence[PersonalRun]) -> Group:
    """Find the tried design that is best for all on average, and what each person's own gains over it.

    Raises BuildError without scikit-learn.
    """
    space, objective = runs[0].space, runs[0].setup.objectives[0]
    values, errors = score_table([objective], [trial for run in runs for trial in run.trials])
    tried = [trial.design for run in runs for trial in run.trials]
    people = np.repeat(np.arange(len(runs)), [len(run.trials) for run in runs])
    scores = GroupScores(people, space.to_unit(tried), values[:, 0], errors[:, 0].copy())
    belief = believe_group(scores, space.length)
    best = tried[int(np.argmin(belief.means(scores.places).mean(axis=0)))]
    return _group(tuple(runs), dict(best), belief)


def _group(runs: tuple[PersonalRun, ...], design: dict[str, float], belief: GroupBelief) -> Group:
    space = runs[0].space
    everybody = space.to_unit([design] * len(runs))
    own = space.to_unit([run.own for run in runs])
    drawn = belief.differences(everybody, own)
    expected, sd = drawn.mean(axis=0), drawn.std(axis=0)
    return Group(runs, design, tuple(expected.tolist()), tuple(sd.tolist()), expected_gain(drawn))


def expected_gain(drawn: FloatArray) -> Retest:
    """Return the mean gain of people that draws (n, people) of their posterior let expect.

    Its interval holds 95 % of the draws; the chance is the share of those above 0.
    """
    means = drawn.mean(axis=1)
    low, high = np.percentile(means, [2.5, 97.5])
    chance = float(np.mean(means > 0) + 0.5 * np.mean(means == 0))
    return Retest(drawn.shape[1], float(means.mean()), float(low), float(high), chance)
