"""Unsealing: recorded first, then read; and written as plain tables."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from fdvv.errors import InputError
from fdvv.files import write_atomic
from fdvv.study import Answers, StudyPlan
from fdvv.workflow._session_manifest import now
from fdvv.workflow._study_chain import read_chained
from fdvv.workflow._study_export import write_answers
from fdvv.workflow._study_files import PEOPLE, REMEDY, SCHEDULE_FILE, SEALED_FILE, SESSION_FILE, UNSEALED
from fdvv.workflow._study_log import ChainedLog
from fdvv.workflow._study_people import Person, open_with_keeper, people_of
from fdvv.workflow._study_rows import Row, UnsealedPerson, answers_of, unseal_person
from fdvv.workflow._study_seal import Keeper

RENDERED_FILE, PAGES_FILE = "rendered.csv", "pages.csv"
RENDERED = (
    *("person", "trial", "practice", "item", "round", "label", "stimulus", "ratio", "switches", "presses"),
    *("largest_error_cN", "errors_cN", "velocities_mm_s", "vibrations", "faults", "excluded"),
)
"""Columns of rendered.csv: a row is a label of an answered trial; blanks part the numbers in a cell."""


def check_words(**words: str) -> dict[str, str]:
    """Give who and why as they are recorded. InputError where one is empty."""
    found = {name: " ".join(text.split()) for name, text in words.items()}
    for name, text in found.items():
        if not text:
            raise InputError(name, "whole", "is empty", "say who unseals the study, and why")
    return found


def refuse_problems(folder: Path, problems: Sequence[str]) -> None:
    """Refuse to unseal a study that is not whole. InputError."""
    if problems:
        more = f" (and {len(problems) - 1} more)" if len(problems) > 1 else ""
        remedy = f"{REMEDY}; --despite goes on without the people concerned"
        raise InputError(folder, "study", problems[0] + more, remedy)


def unseal_folder(
    folder: Path, plan: StudyPlan, log: ChainedLog, keeper: Keeper, told: Mapping[str, object]
) -> Answers:
    """Record that a study is unsealed, then join and write its answers. log : of the study, open.

    told : who, why, and what was wrong with the study then. InputError, OSError.
    """
    log.write({"unsealed": {"when": now(), **told}})
    people = [found for person in people_of(log.records) if (found := _person(folder, plan, person, keeper))]
    answers = answers_of(plan, people)
    write_answers(folder / UNSEALED, answers, plan)
    write_atomic(folder / UNSEALED / RENDERED_FILE, _table(RENDERED, _rendered(people)))
    write_atomic(
        folder / UNSEALED / PAGES_FILE, _table(("person", "page", "question", "answer"), _pages(people))
    )
    return answers


def _person(folder: Path, plan: StudyPlan, person: Person, keeper: Keeper) -> UnsealedPerson | None:
    """Unseal one person; None of whom nothing is kept, or whose schedule is not there to be read."""
    own = folder / PEOPLE / person.name
    if person.state == "deleted":
        return None
    try:
        schedule = open_with_keeper(own / SCHEDULE_FILE, keeper)
    except InputError:
        return None  # told of by verify, and on record
    key = bytes.fromhex(schedule.key)
    session, sealed = read_chained(own / SESSION_FILE, key), read_chained(own / SEALED_FILE, key)
    damaged = bool(session.problems or sealed.problems)
    return unseal_person(plan, person, schedule, session.records, sealed.records, keeper, damaged)


def _rendered(people: Sequence[UnsealedPerson]) -> Iterator[Sequence[object]]:
    for one in people:
        for row in (*one.practice, *one.rows):
            # labels of a trial that is still to be answered stay sealed
            yield from _labels(row) if row.answer else ()


def _labels(row: Row) -> Iterator[Sequence[object]]:
    trial, answer = row.trial, row.answer
    assert answer is not None
    for one in row.rendered:
        errors = [error for error in one.error_cN if error is not None]
        yield (
            *(
                row.person,
                trial.number,
                int(trial.practice),
                trial.item,
                trial.round,
                one.label,
                one.stimulus,
            ),
            "" if row.ratio != row.ratio else f"{row.ratio:.6g}",
            *(sum(label == one.label for _, label in answer.switches), one.presses),
            f"{max(errors):.3f}" if errors else "",
            *(_numbers(one.error_cN), _numbers(one.velocity_mm_s)),
            *(one.vibrations, "; ".join(one.faults), row.excluded),
        )


def _numbers(values: Sequence[float | None]) -> str:
    return " ".join("nan" if value is None else f"{value:.3f}" for value in values)


def _pages(people: Sequence[UnsealedPerson]) -> Iterator[Sequence[object]]:
    for one in people:
        for page, values in one.pages.items():
            for question, value in values.items():
                yield one.person.name, page, question, "" if value is None else value


def _table(heads: Sequence[str], rows: Iterator[Sequence[object]]) -> str:
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(heads)
    writer.writerows(rows)
    return stream.getvalue()
