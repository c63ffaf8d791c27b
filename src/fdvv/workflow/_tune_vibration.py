"""Tune a model's vibrations with a person: press, ask, keep every answer, take what was liked best."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from fdvv.compensate import judge
from fdvv.device import Device
from fdvv.errors import DeviceError, InputError, ModelError
from fdvv.model import FDVVModel, ForceSurface, Vibration
from fdvv.vibration import Comparing, Job, KnownExciter, Preferred, Question, Rating
from fdvv.workflow._answer_log import AnswerLog, Given
from fdvv.workflow._compensate import check_speeds
from fdvv.workflow._exciter import prepare_exciter
from fdvv.workflow._held_back import held_back
from fdvv.workflow._receipt import make_receipt, save_receipt
from fdvv.workflow._session import Session
from fdvv.workflow._session_events import Ask, Guide
from fdvv.workflow._session_log import REMEDY
from fdvv.workflow._session_manifest import make_manifest, now, plain, table_digest
from fdvv.workflow._session_run import clear_latched, let_go
from fdvv.workflow._tune_candidates import Candidates, candidate_image, candidates_for, tuned_model
from fdvv.workflow._tune_result import OBSERVERS, TunedVibration, TuneResult, TuneSetup, TuneTold

State = Any
Answerer = Callable[[Question], int | Preferred | None]
"""Asks a person, or a simulated observer, once the presses are made; None: press again."""
PATIENCE = 10


def tune_vibration(
    device: Device,
    model: FDVVModel,
    velocities_mm_s: Sequence[float],
    method: Rating | Comparing,
    answer: Answerer,
    setup: TuneSetup | None = None,
    session: Session | None = None,
    guide: Guide | None = None,
    told: Callable[[TuneTold], None] = lambda _told: None,
) -> TuneResult:
    """Have vibrations pressed and rated or compared until the method is done; keep the best of each velocity.

    answer : is given what was pressed, and asks; it must show neither templates nor answers so far.
    told : called after every answer, once it is on file.
    session : its folder keeps every answer before the next is asked, and goes on where it stopped.

    Raises InputError on a model without a vibration of the press and on a folder that is no session of this
    job, DeviceError if the device fails or ten presses in a row cannot be used, KeyboardInterrupt on Ctrl-C.
    """
    setup, session, guide = setup or TuneSetup(), session or Session(), guide or Guide()
    speeds = check_speeds(velocities_mm_s)
    candidates = candidates_for(model, speeds, setup.grid, setup.exciter)
    surface = setup.surface or ForceSurface.of_model(model, speeds)
    if setup.exciter:
        prepare_exciter(device, setup.exciter)
    upload = _uploader(device, model, surface, setup.exciter)
    name = "rating" if isinstance(method, Rating) else "comparing in pairs"
    manifest = make_manifest(
        "tune", device, model, speeds, (name, _about(method, setup, candidates, surface)),
        (session.seed, session.parts),
    )  # fmt: skip
    with session.begun_answers(manifest) as log:
        state = _replayed(method, candidates, log)
        _greet(guide, log, method.done(state))
        course = _Course(device, candidates, upload, answer, session, guide, model.travel_mm, told)
        state = _asked(course, method, state, log)
        receipt = make_receipt(manifest, log.runs, [given.entry for given in log.answers])
        if session.folder:
            save_receipt(session.folder, receipt)
    found = _standing(candidates, method, state)
    simulated = device.info().simulated or setup.observer != OBSERVERS[0]
    result = TuneResult(model, name, device.info().name, setup.observer, simulated, found, receipt)
    return replace(result, model=_with_provenance(result))


@dataclass(frozen=True, eq=False)
class _Course:
    """What the loop needs."""

    device: Device
    candidates: tuple[Candidates, ...]
    upload: Callable[[Vibration], None]
    answer: Answerer
    session: Session
    guide: Guide
    travel_mm: float
    told: Callable[[TuneTold], None]


def _uploader(
    device: Any, model: FDVVModel, surface: ForceSurface, exciter: KnownExciter | None
) -> Callable[[Vibration], None]:
    """Give what puts a vibration on the device; always anew, so that its pause tells nothing."""
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
    method: Rating | Comparing, setup: TuneSetup, candidates: Sequence[Candidates], surface: ForceSurface
) -> dict[str, Any]:
    """Write what a session must agree in to go on."""
    return {
        **plain(method),
        "observer": setup.observer,
        "surface_sha256": table_digest(surface),
        "exciter": plain(setup.exciter) if setup.exciter else None,
        "candidates_sha256": hashlib.sha256(repr([c.plain() for c in candidates]).encode()).hexdigest(),
    }


def _replayed(method: Rating | Comparing, candidates: Sequence[Candidates], log: AnswerLog) -> State:
    """Rebuild the state from the answers on file. InputError if they were to other questions."""
    one: Any = method
    state = one.init(Job(tuple(len(c.vibrations) for c in candidates)))
    for given in log.answers:
        asked = one.ask(state)
        try:
            if asked is None or _place(asked, candidates) != (given.velocity_mm_s, given.templates):
                raise ModelError("was asked another question; another version of fdvv made it")
            state = one.tell(
                state, Preferred(given.answer) if isinstance(given.answer, str) else given.answer
            )
        except ValueError as error:
            raise InputError(log.folder, f"answer {given.number}", str(error), REMEDY) from error
    return state


def _place(asked: Question, candidates: Sequence[Candidates]) -> tuple[float, list[int]]:
    return candidates[asked.place].velocity_mm_s, list(asked.templates)


def _greet(guide: Guide, log: AnswerLog, done: bool) -> None:
    for warning in log.warnings:
        guide.notice(f"warning: {warning}")
    if log.folder and log.answers:
        rest = "is finished; this is its result again" if done else "goes on"
        guide.notice(f"the session in {log.folder}, with {len(log.answers)} answers, {rest}")


def _standing(
    candidates: Sequence[Candidates], method: Rating | Comparing, state: State
) -> tuple[TunedVibration, ...]:
    return tuple(TunedVibration(c, s) for c, s in zip(candidates, method.best(state), strict=True))


def _asked(course: _Course, method: Rating | Comparing, state: State, log: AnswerLog) -> State:
    """Press and ask until nothing is left to ask."""
    one: Any = method
    clear_latched(course.device, course.guide.notice)
    try:
        while (asked := one.ask(state)) is not None:
            told, speeds = _answered(course, asked)
            with held_back():
                after = one.tell(state, told)
                kept = str(told) if isinstance(told, Preferred) else told
                velocity, templates = _place(asked, course.candidates)
                given = Given(asked.number, velocity, templates, kept, speeds, now())
                log.add(given)
                state = after
            course.told(TuneTold(given, asked.total, _standing(course.candidates, method, state)))
        return state
    except KeyboardInterrupt:
        let_go(course.device)
        raise KeyboardInterrupt(f"interrupted; {_how_to_go_on(log)}") from None
    except DeviceError as error:
        let_go(course.device)
        raise DeviceError(f"{error}; {_how_to_go_on(log)}") from error
    except BaseException:
        let_go(course.device)
        raise


def _answered(course: _Course, asked: Question) -> tuple[int | Preferred, list[float | None]]:
    """Press what is asked about, as often as the person wants, until there is an answer."""
    while True:
        speeds = [_pressed(course, asked, template) for template in asked.templates]
        told = course.answer(asked)
        if told is not None:
            return told, speeds


def _pressed(course: _Course, asked: Question, template: int) -> float | None:
    """Have one vibration pressed at the pace; give the mean speed of the press."""
    found = course.candidates[asked.place]
    for _ in range(PATIENCE):
        course.upload(found.vibrations[template])
        course.guide.ask(Ask(found.velocity_mm_s, course.travel_mm, asked.number, asked.total))
        press = course.device.press(found.velocity_mm_s)
        verdict = judge(press, course.travel_mm, course.session.acceptance)
        if not verdict.reason:
            return float(verdict.achieved_mm_s) if np.isfinite(verdict.achieved_mm_s) else None
        course.guide.notice(f"not used, {verdict.reason}")
    name = course.device.info().name
    raise DeviceError(f"{name}: {PATIENCE} presses in a row could not be used; the last {verdict.reason}")


def _how_to_go_on(log: AnswerLog) -> str:
    made = f"{len(log.answers)} {'answer is' if len(log.answers) == 1 else 'answers are'}"
    if log.folder is None:
        return f"{made} lost; name a folder with --session to keep them"
    return f"{made} kept in {log.folder}; run the same command again to go on"


def _with_provenance(result: TuneResult) -> FDVVModel:
    """Give the tuned model, which tells how its vibrations came about."""
    chosen = [replace(t.vibration, velocity_mm_s=t.candidates.velocity_mm_s) for t in result.tuned]
    model = tuned_model(result.model, chosen)
    about = model.provenance
    speeds = ", ".join(f"{t.candidates.velocity_mm_s:g}" for t in result.tuned)
    by = "a person" if result.observer == OBSERVERS[0] else "a simulated observer (evidence of nothing)"
    told = (
        f"Vibrations of the press at {speeds} mm/s tuned by {by} with {result.method} "
        f"in {result.answers} answers on {result.device}."
    )
    sentences = [f"At {t.candidates.velocity_mm_s:g} mm/s {t.sentence}." for t in result.tuned]
    method = " ".join(text for text in (about.method, told, *sentences) if text)
    return replace(
        model, provenance=replace(about, method=method, simulated=about.simulated or result.simulated)
    )
