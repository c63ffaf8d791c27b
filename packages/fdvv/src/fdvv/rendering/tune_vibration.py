"""Tune a model's vibrations with a person: press, ask, store every answer, choose the preferred one."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from fdvv.compensation.method import UNTUNED, Tuning
from fdvv.compensation.presses import judge_press
from fdvv.device.contract import Device
from fdvv.errors import DeviceError, InputError, ModelError
from fdvv.io.files import defer_interrupt
from fdvv.model.model import FDVVModel
from fdvv.model.surface import ForceSurface
from fdvv.model.vibration import Vibration
from fdvv.rendering.compensate import check_speeds
from fdvv.rendering.evaluation.vibration_presses import has_exciter
from fdvv.rendering.exciter import prepare_exciter
from fdvv.rendering.press_made import clear_latched
from fdvv.rendering.run_summary import RunSummary, write_run_summary
from fdvv.rendering.session import Session, now, plain, table_digest
from fdvv.rendering.session_log import REMEDY, AnswerLog, AnswerRecord
from fdvv.rendering.session_run import Guide, PressRequest, how_to_resume, release_on_error
from fdvv.rendering.tune_candidates import Candidates, candidate_image, candidates_for, replace_vibrations
from fdvv.rendering.tuning import tune
from fdvv.vibration.exciter import KnownExciter
from fdvv.vibration.templates import TemplateGrid
from fdvv.vibration.tune import Job, Method, Preferred, Question, Ranking, Rating, TuningState

NOTHING_VIBRATES = (
    "this rig has no exciter, nothing of the vibration is felt; name one that has (--rig voltage)"
)
OBSERVERS = ("person", "simulated observer")


@dataclass(frozen=True, eq=False)
class TuneSetup:
    """Settings of the device while a vibration is tuned.

    Attributes
    ----------
    surface : forces learned by compensation; None: the model's own.
    exciter : if identified, vibrations are played through its inverse.
    grid : of templates.
    observer : "person", or "simulated observer", whose results are no evidence.
    tuning : of the controller, learned with the surface.
    """

    surface: ForceSurface | None = None
    exciter: KnownExciter | None = None
    grid: TemplateGrid = field(default_factory=TemplateGrid)
    observer: str = OBSERVERS[0]
    tuning: Tuning = UNTUNED

    def __post_init__(self) -> None:
        if self.observer not in OBSERVERS:
            raise ModelError(f"observer must be one of {', '.join(OBSERVERS)}, got {self.observer!r}")


@dataclass(frozen=True, eq=False)
class TunedVibration:
    """The result at one velocity."""

    candidates: Candidates
    standing: Ranking

    @property
    def vibration(self) -> Vibration:
        return self.candidates.vibrations[self.standing.best]

    @property
    def sentence(self) -> str:
        """Summary of how certain the preference is."""
        s, count = self.standing, len(self.candidates.vibrations)
        if not s.distinct:
            return f"no difference found between {count} vibrations; the measured one is kept"
        others = len(s.alike) - 1
        tied = f", {others} more cannot be distinguished from it" if others else ""
        return f"{'the measured one' if not s.best else f'template {s.best}'} of {count} was best{tied}"

    def to_dict(self) -> dict[str, Any]:
        s = self.standing
        rows = zip(self.candidates.plain(), s.scores, s.errors, self.candidates.scores(), strict=True)
        return {
            "velocity_mm_s": self.candidates.velocity_mm_s,
            "best": s.best,
            "alike": list(s.alike),
            "answers": s.answers,
            "explanation": self.sentence,
            "candidates": [
                {"vibration": v, "score": score, "error": error, "objective": objective}
                for v, score, error, objective in rows
            ],
        }


@dataclass(frozen=True, eq=False)
class AnswerEvent:
    """An answer on file, and the result of all so far.

    Attributes
    ----------
    given : the answer. total : largest number of questions.
    tuned : current result at each velocity; not to be shown to the person who answers.
    """

    given: AnswerRecord
    total: int
    tuned: tuple[TunedVibration, ...]


@dataclass(frozen=True, eq=False)
class TuneResult:
    """A tuned model and how it came about; simulated if device or observer is."""

    model: FDVVModel
    method: str
    device: str
    observer: str
    simulated: bool
    tuned: tuple[TunedVibration, ...]
    receipt: RunSummary

    @property
    def answers(self) -> int:
        return self.receipt.used

    def to_dict(self) -> dict[str, Any]:
        names = ("method", "device", "observer", "simulated", "answers")
        head = {name: getattr(self, name) for name in names}
        return {"model": self.model.name, **head, "velocities": [t.to_dict() for t in self.tuned]}


Answerer = Callable[[Question], int | Preferred | None]
"""Asks a person or a simulated observer after the presses; None: press again."""
PATIENCE = 10
"""Assumed: a person may miss the speed some times, and a rig that never succeeds must not go on for ever."""


def tune_vibration(
    device: Device,
    model: FDVVModel,
    velocities_mm_s: Sequence[float],
    method: Method,
    answer: Answerer,
    setup: TuneSetup | None = None,
    session: Session | None = None,
    guide: Guide | None = None,
    answered: Callable[[AnswerEvent], None] = lambda _event: None,
) -> TuneResult:
    """Have vibrations pressed and rated or compared until the method is done; keep the best of each velocity.

    answer : is given what was pressed, and asks; it must show neither templates nor answers so far.
    answered : called after every answer, once it is on file.
    session : its folder stores every answer before the next question, and resumes where it stopped.

    Raises InputError on a model without a vibration of the press and on a folder that is no session of this
    job, DeviceError if the device fails or ten presses in a row cannot be used, KeyboardInterrupt on Ctrl-C.
    """
    setup, session, guide = setup or TuneSetup(), session or Session(), guide or Guide()
    speeds = check_speeds(velocities_mm_s)
    candidates = candidates_for(model, speeds, setup.grid, setup.exciter)
    surface = setup.surface or ForceSurface.of_model(model, speeds)
    if setup.surface:
        tune(device, setup.tuning)
    if setup.exciter:
        prepare_exciter(device, setup.exciter)
    upload = _uploader(device, model, surface, setup.exciter)
    name = "rating" if isinstance(method, Rating) else "comparing in pairs"
    settings = _about(method, setup, candidates, surface)
    manifest = session.manifest("tune", device, model, speeds, name, settings)
    with session.open_log(manifest, AnswerLog) as log:
        state = _replay(method, candidates, log)
        _greet(guide, log, method.is_done(state))
        if not has_exciter(device):
            guide.notice(NOTHING_VIBRATES)
        plan = _TuningPlan(device, candidates, upload, answer, session, guide, model.travel_mm, answered)
        state = _ask_questions(plan, method, state, log)
        entries = [given.entry for given in log.entries]
        receipt = write_run_summary(session.folder, manifest, log.runs, entries)
    ranking = _standing(candidates, method, state)
    simulated = device.info().simulated or setup.observer != OBSERVERS[0]
    result = TuneResult(model, name, device.info().name, setup.observer, simulated, ranking, receipt)
    return replace(result, model=_with_provenance(result))


@dataclass(frozen=True, eq=False)
class _TuningPlan:
    device: Device
    candidates: tuple[Candidates, ...]
    upload: Callable[[Vibration], None]
    answer: Answerer
    session: Session
    guide: Guide
    travel_mm: float
    answered: Callable[[AnswerEvent], None]


def _uploader(
    device: Any, model: FDVVModel, surface: ForceSurface, exciter: KnownExciter | None
) -> Callable[[Vibration], None]:
    """Return a function that uploads a vibration, always anew: the pause must not reveal a repetition."""
    if not hasattr(device, "upload_program"):
        reason = "it runs tables of force only"
        raise InputError("--device", device.info().name, reason, "use twin, host or serial:PORT")

    images: dict[Vibration, bytes] = {}

    def upload(vibration: Vibration) -> None:
        if vibration not in images:
            images[vibration] = candidate_image(model, surface, vibration, exciter)
        device.upload_program(images[vibration])

    return upload


def _about(
    method: Method, setup: TuneSetup, candidates: Sequence[Candidates], surface: ForceSurface
) -> dict[str, Any]:
    """Return the settings in which a session must agree to be resumed."""
    return {
        **plain(method),
        "observer": setup.observer,
        "surface_sha256": table_digest(surface),
        "exciter": plain(setup.exciter) if setup.exciter else None,
        "candidates_sha256": hashlib.sha256(repr([c.plain() for c in candidates]).encode()).hexdigest(),
    }


def _replay(method: Method, candidates: Sequence[Candidates], log: AnswerLog) -> TuningState:
    """Rebuild the state from the answers on file. Raises InputError if they belong to other questions."""
    state = method.init(Job(tuple(len(c.vibrations) for c in candidates)))
    for given in log.entries:
        question = method.ask(state)
        try:
            if question is None or _place(question, candidates) != (given.velocity_mm_s, given.templates):
                raise ModelError("was asked another question; another version of fdvv made it")
            answer = given.answer
            state = method.tell(state, Preferred(answer) if isinstance(answer, str) else answer)
        except ValueError as error:
            raise InputError(log.folder, f"answer {given.number}", str(error), REMEDY) from error
    return state


def _place(question: Question, candidates: Sequence[Candidates]) -> tuple[float, list[int]]:
    return candidates[question.place].velocity_mm_s, list(question.templates)


def _greet(guide: Guide, log: AnswerLog, done: bool) -> None:
    for warning in log.warnings:
        guide.notice(f"warning: {warning}")
    if log.folder and log.entries:
        rest = "is finished; this is its result again" if done else "goes on"
        guide.notice(f"the session in {log.folder}, with {len(log.entries)} answers, {rest}")


def _standing(
    candidates: Sequence[Candidates], method: Method, state: TuningState
) -> tuple[TunedVibration, ...]:
    return tuple(TunedVibration(c, s) for c, s in zip(candidates, method.best(state), strict=True))


def _ask_questions(plan: _TuningPlan, method: Method, state: TuningState, log: AnswerLog) -> TuningState:
    clear_latched(plan.device, plan.guide.notice)
    with release_on_error(plan.device, lambda: how_to_resume(log, len(log.entries), "answer", "answers")):
        while (question := method.ask(state)) is not None:
            reply, speeds = _ask_until_answered(plan, question)
            with defer_interrupt():
                after = method.tell(state, reply)
                stored = str(reply) if isinstance(reply, Preferred) else reply
                velocity, templates = _place(question, plan.candidates)
                given = AnswerRecord(question.number, velocity, templates, stored, speeds, now())
                log.add(given)
                state = after
            plan.answered(AnswerEvent(given, question.total, _standing(plan.candidates, method, state)))
    return state


def _ask_until_answered(plan: _TuningPlan, question: Question) -> tuple[int | Preferred, list[float | None]]:
    """Have the vibrations pressed, as often as the person wants, until there is an answer."""
    while True:
        speeds = [_press(plan, question, template) for template in question.templates]
        if (reply := plan.answer(question)) is not None:
            return reply, speeds


def _press(plan: _TuningPlan, question: Question, template: int) -> float | None:
    """Have one vibration pressed at the requested speed; return the mean speed of the press."""
    options = plan.candidates[question.place]
    for _ in range(PATIENCE):
        plan.upload(options.vibrations[template])
        plan.guide.ask(PressRequest(options.velocity_mm_s, plan.travel_mm, question.number, question.total))
        press = plan.device.press(options.velocity_mm_s)
        verdict = judge_press(press, plan.travel_mm, plan.session.acceptance)
        if not verdict.reason:
            return float(verdict.achieved_mm_s) if np.isfinite(verdict.achieved_mm_s) else None
        plan.guide.notice(f"not used, {verdict.reason}")
    name = plan.device.info().name
    raise DeviceError(f"{name}: {PATIENCE} presses in a row could not be used; the last {verdict.reason}")


def _with_provenance(result: TuneResult) -> FDVVModel:
    """Return the tuned model, with the tuning in its provenance."""
    chosen = [replace(t.vibration, velocity_mm_s=t.candidates.velocity_mm_s) for t in result.tuned]
    model = replace_vibrations(result.model, chosen)
    about = model.provenance
    speeds = ", ".join(f"{t.candidates.velocity_mm_s:g}" for t in result.tuned)
    by = "a person" if result.observer == OBSERVERS[0] else "a simulated observer (evidence of nothing)"
    summary = (
        f"Vibrations of the press at {speeds} mm/s tuned by {by} with {result.method} "
        f"in {result.answers} answers on {result.device}."
    )
    sentences = [f"At {t.candidates.velocity_mm_s:g} mm/s {t.sentence}." for t in result.tuned]
    method = " ".join(text for text in (about.method, summary, *sentences) if text)
    simulated = about.simulated or result.simulated
    return replace(model, provenance=replace(about, method=method, simulated=simulated))
