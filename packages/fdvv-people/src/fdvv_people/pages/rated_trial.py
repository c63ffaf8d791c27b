"""A played trial that waits for the answers to its questionnaire: asked again until they are on the disk."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from fdvv.errors import InputError, ModelError
from fdvv_people.optimize.problem import Trial, TrialState
from fdvv_people.optimize.run.session import Optimization
from fdvv_people.optimize.run.setup import OptimizeSetup
from fdvv_people.pages.played_trial import pointing_of
from fdvv_people.task.questionnaire import LIKING, check_answers, liking_score
from fdvv_people.task.rounds import KeptRounds, TaskRounds

if TYPE_CHECKING:
    from fdvv_people.pages.optimizations import Optimizations


def waiting_trial(session: Optimization, rounds: KeptRounds) -> Trial | None:
    """Return the trial of a run whose presses are all on the disk and that nobody has rated yet."""
    setup = session.setup
    if not _asks_people(setup):
        return None
    shown = [one for one in (*session.trials, *session.retests) if one.state is TrialState.SHOWN]
    return next((one for one in shown if len(rounds.counting(one.number)) >= setup.presses), None)


def _asks_people(setup: OptimizeSetup) -> bool:
    return setup.asks_liking and not setup.simulated


def rate_trial(runs: Optimizations, run: int, number: int, answers: Sequence[int]) -> None:
    """Keep the answers to a waiting trial's questionnaire, on the disk before the trial is scored.

    InputError where no such trial waits, or on answers beyond the questionnaire.
    """
    with runs.session(run) as session:
        if not _asks_people(session.setup):
            raise _waits_for_none(number)
        rounds = TaskRounds(runs.folder(run))
        try:
            waiting = waiting_trial(session, rounds)
            if waiting is None or waiting.number != number:
                raise _waits_for_none(number)
            answers = check_answers(answers)
            rounds.rate(number, answers)
        finally:
            rounds.close()
        try:
            scores = pointing_of(session.setup).scores([one.press for one in rounds.counting(number)])
        except ModelError as error:
            session.give_up(number, str(error))
            return
        session.answer(number, {**scores, LIKING.name: liking_score(answers)})


def _waits_for_none(number: int) -> InputError:
    return InputError("optimise", f"trial {number + 1}", "waits for no answers", "play it first")
