"""What codes hid, joined with the scores, and written as plain tables."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from fdvv.errors import InputError, ModelError
from fdvv.io.files import private_folder, write_atomic
from fdvv_people.study.analysis.code_book import csv_text
from fdvv_people.study.files.opened import CHANGED, OpenedPerson
from fdvv_people.study.files.people import Person
from fdvv_people.study.timing.events import RoundKept, TimedBegun
from fdvv_people.study.timing.plan import DAY_s, TimingPlan
from fdvv_people.study.timing.schedule import TimingFace
from fdvv_people.study.timing.scores import SCORES_FILE, ScoreRow, TimingScores, scores_text
from fdvv_people.study.timing.state import TimingState
from fdvv_people.task.tapping import strokes_Hz

ROUNDS_FILE, TRAINING_FILE = "rounds.csv", "training.csv"
ROUNDS = (
    *("person", "phase", "level", "trial", "condition", "attempt", "round", "counts", "target_s"),
    *("activations_s", "late_ms", "source", "hand", "display_ms", "display_error_ms", "input_ms"),
    *("input_error_ms", "clock_error_ms", "transport_ms"),
)
"""Columns of rounds.csv: a row is a press of pointing, or a second of tapping; blanks part the numbers."""


@dataclass(frozen=True)
class UnsealedSession:
    """What was unsealed of a person. conditions : by trial. begun : first beginning of each, by trial."""

    person: Person
    state: TimingState
    conditions: Mapping[int, str]
    begun: Mapping[int, TimedBegun]
    suspect: bool


def unseal_timing(plan: TimingPlan, people: Sequence[OpenedPerson], folder: Path) -> TimingScores:
    """Join what people scored with what their codes hid, and write it; see `StudyKind.unseal`."""
    unsealed = [_session(plan, one) for one in people if one.events]
    scores = TimingScores(plan, tuple(row for one in unsealed for row in _rows(one)))
    private_folder(folder)
    write_atomic(folder / SCORES_FILE, scores_text(scores.rows))
    rounds = (cells for one in unsealed for cells in _round_cells(one))
    write_atomic(folder / ROUNDS_FILE, csv_text(ROUNDS, rounds))
    write_atomic(folder / TRAINING_FILE, _training_text(unsealed))
    return scores


def _session(plan: TimingPlan, one: OpenedPerson) -> UnsealedSession:
    """Join a person's schedule with their log."""
    try:
        state = TimingState.of(plan, one.events)
    except ModelError as error:
        raise InputError(
            one.person.name, "session", str(error), "install the fdvv that ran the study"
        ) from error
    conditions = {trial.number: next(iter(trial.labels.values())) for trial in one.schedule.trials}
    begun = {event.number: event for event in reversed(one.events) if isinstance(event, TimedBegun)}
    return UnsealedSession(one.person, state, conditions, begun, one.changed)


def _rows(one: UnsealedSession) -> Iterator[ScoreRow]:
    state, plan = one.state, one.state.plan
    name, size = next(iter(plan.task_of(plan.all_levels[0]).objectives)).name, len(plan.conditions)
    faces = [face for face in state.started.trials if face.phase == "validation"]
    for i, face in enumerate(faces):
        if face.number not in one.begun:
            continue
        score = state.scores.get(face.number, {})
        first, lost, counting = score.get(name), score.get("lost_ratio"), state.counting(face.number)
        begun = one.begun[face.number]
        given_up = "its button could not be rendered" if face.number in state.skipped else ""
        yield ScoreRow(
            person=one.person.name,
            level=face.level,
            round=face.round,
            place=i % size,
            trial=face.number,
            code=face.code,
            condition=one.conditions[face.number],
            on=begun.on,
            attempts=state.attempts[face.number],
            rounds=len(counting),
            score=first.value if first else math.nan,
            error=first.error if first and first.error is not None else math.nan,
            lost_ratio=lost.value if lost else math.nan,
            strokes_Hz=strokes_Hz([one.press for one in counting]) if plan.tapping else math.nan,
            gap_days=math.nan if state.trained_s is None else (begun.at_s - state.trained_s) / DAY_s,
            excluded=CHANGED if one.suspect else given_up or ("" if first else "it was not finished"),
            simulated=one.person.simulated,
        )


def _round_cells(one: UnsealedSession) -> Iterator[Sequence[object]]:
    faces = {face.number: face for face in one.state.started.trials}
    for number, kept in sorted(one.state.rounds.items()):
        counting = {id(found) for found in one.state.counting(number)}
        for found in kept:
            yield _cells(one, faces[number], found, id(found) in counting)


def _cells(one: UnsealedSession, face: TimingFace, found: RoundKept, counts: bool) -> Sequence[object]:
    timing, keys = found.timing, found.activations_s
    late = 1e3 * (keys[0] - found.target_s) if keys and found.target_s is not None else None
    return (
        *(one.person.name, face.phase, face.level, face.number, one.conditions.get(face.number, "")),
        *(found.attempt, found.round, int(counts), _plain(found.target_s)),
        *(" ".join(f"{key:.6f}" for key in keys), _plain(late), timing.source, timing.hand),
        *(timing.display_ms, timing.display_error_ms, timing.input_ms, timing.input_error_ms),
        *(_plain(timing.clock_error_ms), _plain(timing.transport_ms)),
    )


def _plain(value: float | None) -> str:
    return "" if value is None else f"{value:.6f}"


def _training_text(people: Sequence[UnsealedSession]) -> str:
    """Return every design that was tried, with what it scored."""
    tried = [
        (one, face) for one in people for face in one.state.started.trials if face.number in one.state.designs
    ]
    names = list(dict.fromkeys(n for one, face in tried for n in one.state.designs[face.number].design))
    heads = ("person", "level", "trial", "score", "error", "failed", *names)
    return csv_text(heads, (_design_cells(one, face, names) for one, face in tried))


def _design_cells(one: UnsealedSession, face: TimingFace, names: Sequence[str]) -> list[object]:
    score = next(iter(one.state.scores.get(face.number, {}).values()), None)
    design = one.state.designs[face.number].design
    return [
        *(one.person.name, face.level, face.round),
        *(_plain(score.value if score else None), _plain(score.error if score else None)),
        one.state.failed.get(face.number, ""),
        *(f"{design[name]:.6g}" for name in names),
    ]
