"""The work of a job that tunes a vibration with whoever answers."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from fdvv.compensate import Acceptance
from fdvv.model import Vibration, load_model, save_model
from fdvv.studio._drawn import DIGITS, known, rounded
from fdvv.studio._messages_events import (
    JobBegun,
    JobOutcome,
    PlayedWave,
    QuestionAnswered,
    QuestionAsked,
    StageTold,
    TuneCandidate,
    TuneRanking,
)
from fdvv.studio._messages_orders import TuneOrder
from fdvv.studio._work import Work, let_close
from fdvv.vibration import Comparing, Preferred, Question, Rating, TemplateGrid, vibration_samples
from fdvv.workflow import (
    Candidates,
    Session,
    TunedVibration,
    TuneSetup,
    TuneTold,
    candidates_for,
    load_actuation,
    simulated_observer,
    tune_vibration,
)

WAVE_Hz, QUIET_s = 8000, 0.005
"""Of what is played on the page; the strongest modes of switches lie below 3 kHz."""


def tune(work: Work, order: TuneOrder) -> None:
    """Press and ask until nothing is left to ask, and keep the best in a model."""
    model = load_model(work.folder.button)
    learned = load_actuation(work.folder.actuation) if work.folder.actuation.exists() else None
    grid = TemplateGrid(order.frequency_ratios, order.gain_ratios)
    candidates = candidates_for(model, sorted(order.velocities_mm_s), grid)
    setup = TuneSetup(learned.surface if learned else None, None, grid, order.observer)
    rig = work.folder.rig if work.folder.rig.exists() else None
    session = Session(work.folder.session, order.seed, rig, None, Acceptance(pace_ratio=order.pace_ratio))
    device = session.open_device(order.device)
    try:
        info = device.info()
        work.tell(JobBegun(work.run, info.name, info.simulated))
        work.tell(StageTold("tune", f"answers of a {order.observer}"))
        result = tune_vibration(
            device,
            model,
            order.velocities_mm_s,
            _method(order),
            _answerer(work, order, candidates),
            setup,
            session,
            work.guide(order.device),
            lambda told: work.tell(_answered(told)),
        )
    finally:
        let_close(device)
    save_model(replace(result.model, name=order.name), work.folder.result("button"))
    rankings = tuple(_ranking(tuned) for tuned in result.tuned)
    sentence = "; ".join(f"{r.velocity_mm_s:g} mm/s: {r.sentence}" for r in rankings)
    work.tell(JobOutcome("tune", sentence, result.answers, 0, result.simulated, rankings=rankings))


def _method(order: TuneOrder) -> Rating | Comparing:
    if order.asking == "rate":
        return Rating(order.repeats, order.seed)
    return Comparing(order.comparisons or None, seed=order.seed)


def _answerer(work: Work, order: TuneOrder, candidates: tuple[Candidates, ...]) -> Any:
    """Give who answers."""
    if order.observer != "person":
        return simulated_observer(candidates, order.seed).answer

    def answer(question: Question) -> int | Preferred | None:
        found = candidates[question.place]
        waves = tuple(_wave(found.vibrations[template]) for template in question.templates)
        about = question.number, question.total, found.velocity_mm_s
        work.tell(QuestionAsked(*about, waves, _wave(found.vibrations[0])))
        told = work.ask(question.number)
        return None if told == "again" else int(told) if told.isdigit() else Preferred(told)

    return answer


def _wave(vibration: Vibration) -> PlayedWave:
    samples = vibration_samples(vibration, WAVE_Hz, QUIET_s)
    return PlayedWave(WAVE_Hz, rounded(samples))


def _answered(told: TuneTold) -> QuestionAnswered:
    given = told.given
    rankings = tuple(_ranking(tuned) for tuned in told.tuned if tuned.standing.answers)
    return QuestionAnswered(given.number, told.total, given.velocity_mm_s, str(given.answer), rankings)


def _ranking(tuned: TunedVibration) -> TuneRanking:
    standing = tuned.standing
    return TuneRanking(
        tuned.candidates.velocity_mm_s,
        standing.answers,
        tuned.sentence,
        tuple(_candidate(tuned, i) for i in range(len(standing.scores))),
    )


def _candidate(tuned: TunedVibration, i: int) -> TuneCandidate:
    standing, vibration = tuned.standing, tuned.candidates.vibrations[i]
    strongest = max(vibration.modes, key=lambda mode: abs(mode.amplitude_m_s2))
    return TuneCandidate(
        f"template {i}" if i else "measured",
        round(strongest.frequency_Hz, 1),
        round(strongest.amplitude_m_s2, DIGITS),
        round(standing.scores[i], DIGITS),
        known(standing.errors[i]),
        i in standing.alike,
        i == standing.best,
    )
