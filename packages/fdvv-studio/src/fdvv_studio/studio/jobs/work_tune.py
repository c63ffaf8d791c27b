"""The work of a job that tunes a vibration with an observer's answers."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from fdvv.compensation.method import UNTUNED
from fdvv.model.file import load_model, save_model
from fdvv.model.vibration import Vibration
from fdvv.rendering.tune_candidates import Candidates, candidates_for, simulated_observer
from fdvv.rendering.tune_vibration import AnswerEvent, TunedVibration, TuneSetup, tune_vibration
from fdvv.vibration.tune import Preferred, Question
from fdvv.vibration.wave import vibration_samples
from fdvv_studio.studio.jobs import events
from fdvv_studio.studio.jobs.orders import TuneOrder
from fdvv_studio.studio.jobs.work import Work
from fdvv_studio.studio.rounding import DIGITS, finite_or_none, round_row

WAVE_Hz, QUIET_s = 8000, 0.005
"""Of what is played on the page; the strongest modes of switches lie below 3 kHz."""


def tune(work: Work, order: TuneOrder) -> None:
    """Press and ask until nothing is left to ask, and keep the best in a model."""
    model, learned = load_model(work.folder.button), work.load_learned()
    surface, tuning = (learned.surface, learned.outcome.tuning) if learned else (None, UNTUNED)
    settings, speeds = order.settings, order.settings.velocities_mm_s
    candidates = candidates_for(model, sorted(speeds), settings.grid())
    with work.session(order, work.folder.session, settings.seed) as (device, session):
        work.begin(device.info())
        work.tell(events.StageEvent("tune", f"answers of a {order.observer}"))
        result = tune_vibration(
            device,
            model,
            speeds,
            settings.question(),
            _answerer(work, order, candidates),
            TuneSetup(surface, None, settings.grid(), order.observer, tuning),
            session,
            work.guide(order.device),
            lambda progress: work.tell(_answer_event(progress)),
        )
    save_model(replace(result.model, name=order.name), work.folder.result("button"))
    rankings = tuple(_ranking(tuned) for tuned in result.tuned)
    sentence = "; ".join(f"{r.velocity_mm_s:g} mm/s: {r.sentence}" for r in rankings)
    work.tell(events.JobOutcome("tune", sentence, result.answers, 0, result.simulated, rankings=rankings))


def _answerer(work: Work, order: TuneOrder, candidates: tuple[Candidates, ...]) -> Any:
    if order.observer != "person":
        return simulated_observer(candidates, order.settings.seed).answer

    def answer(question: Question) -> int | Preferred | None:
        candidate = candidates[question.place]
        waves = tuple(_wave(candidate.vibrations[template]) for template in question.templates)
        about = question.number, question.total, candidate.velocity_mm_s
        work.tell(events.QuestionAsked(*about, waves, _wave(candidate.vibrations[0])))
        said = work.ask(question.number)
        return None if said == "again" else int(said) if said.isdigit() else Preferred(said)

    return answer


def _wave(vibration: Vibration) -> events.PlayedWave:
    return events.PlayedWave(WAVE_Hz, round_row(vibration_samples(vibration, WAVE_Hz, QUIET_s)))


def _answer_event(progress: AnswerEvent) -> events.QuestionAnswered:
    given = progress.given
    rankings = tuple(_ranking(tuned) for tuned in progress.tuned if tuned.standing.answers)
    return events.QuestionAnswered(
        given.number, progress.total, given.velocity_mm_s, str(given.answer), rankings
    )


def _ranking(tuned: TunedVibration) -> events.TuneRanking:
    standing = tuned.standing
    return events.TuneRanking(
        tuned.candidates.velocity_mm_s,
        standing.answers,
        tuned.sentence,
        tuple(_candidate(tuned, i) for i in range(len(standing.scores))),
    )


def _candidate(tuned: TunedVibration, i: int) -> events.TuneCandidate:
    standing, vibration = tuned.standing, tuned.candidates.vibrations[i]
    strongest = max(vibration.modes, key=lambda mode: abs(mode.amplitude_m_s2))
    return events.TuneCandidate(
        f"template {i}" if i else "measured",
        round(strongest.frequency_Hz, 1),
        round(strongest.amplitude_m_s2, DIGITS),
        round(standing.scores[i], DIGITS),
        finite_or_none(standing.errors[i]),
        i in standing.alike,
        i == standing.best,
    )
