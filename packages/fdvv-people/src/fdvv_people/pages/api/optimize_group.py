"""One button for several people, from their runs, and what a button of one's own gains."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from fdvv_people.optimize.group.group import PersonalRun, group_of, of_one_kind, personal_run
from fdvv_people.optimize.group.report import gain_sentence
from fdvv_people.pages.api.optimize import TITLE, Number
from fdvv_people.pages.optimizations import Optimizations
from fdvv_studio.studio.contract import Message, call


class OptimizeGroupAsk(Message):
    """Name runs, one per person."""

    runs: Annotated[list[Number], Meta(max_length=100)]


class OptimizePerson(Message):
    """A person of a group.

    gain : by how much a button of their own is expected to be better than the group's, in the objective's
    unit. error : its standard deviation.
    """

    run: int
    name: str
    gain: float
    error: float


class OptimizeGroup(Message):
    """One button for all. sentence : what a button of one's own gains. objective : that was scored."""

    sentence: str
    objective: str
    simulated: bool
    design: dict[str, float]
    people: list[OptimizePerson]


@call("optimize.group")
def group(optimizations: Optimizations, ask: OptimizeGroupAsk) -> OptimizeGroup:
    numbers = list(dict.fromkeys(ask.runs))
    found = group_of(of_one_kind([_read(optimizations, run) for run in numbers]))
    people = [
        OptimizePerson(run, one.name, gain, sd)
        for run, one, gain, sd in zip(numbers, found.runs, found.expected, found.sd, strict=True)
    ]
    return OptimizeGroup(
        gain_sentence(found, None),
        found.runs[0].setup.objectives[0].name,
        found.simulated,
        found.design,
        people,
    )


def _read(optimizations: Optimizations, run: int) -> PersonalRun:
    with optimizations.session(run) as session:
        return personal_run(session, str(session.setup.about.get(TITLE, "")) or f"run {run}")
