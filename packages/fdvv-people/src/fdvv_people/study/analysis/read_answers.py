"""Answers read from a CSV: fdvv's own with its code book, or a foreign one with its columns mapped."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from fdvv.errors import InputError
from fdvv.io.files import read_limited
from fdvv.io.text import decode_lines, sniff_separator
from fdvv.units import FloatArray
from fdvv_people.study.analysis.code_book import ANSWERS_FILE, CODE_BOOK_FILE, read_code_book, unescaped
from fdvv_people.study.analysis.columns import (
    CHANGES,
    NO,
    TIMING,
    YES,
    ColumnMap,
    Layout,
    Row,
    layout_of,
    places_of,
)
from fdvv_people.study.analysis.infer_columns import Inferred, RepeatedTrial, infer
from fdvv_people.study.plan.answers import Answers
from fdvv_people.study.plan.task import LABELS
from fdvv_people.study.plan.tasks import task_behind
from fdvv_people.study.plan.trial import EQUAL

LARGEST_bytes = 200_000_000
REMEDY = "save the table as CSV with one line of headings"
ONE_ITEM = "all"
"""Name of the button where there is no column of items."""
UNSEALED = "unsealed"
"""Folder below a study's where unsealing puts answers."""

TrialKey = tuple[str, str, int, int]
"""Person, item, round and, of staircases and thresholds, whose rounds have many trials, the line."""


@dataclass
class _Trial:
    """One row of answers while it is read."""

    person: str
    item: str
    round: int
    choice: str = ""
    correct: float = np.nan
    ratio: float = np.nan
    change: tuple[float, ...] = (np.nan,) * len(CHANGES)
    time_s: float = np.nan
    excluded: str = ""
    ratings: dict[tuple[str, str], float] = field(default_factory=dict)
    lines: dict[str, int] = field(default_factory=dict)
    refused: int = 0


@dataclass(frozen=True)
class AnswersTable:
    """Answers, and how the columns of their table were understood.

    Attributes
    ----------
    columns : the file's heading by role, of a foreign table. guessed : roles that names and contents
        suggested. unused : headings that serve nothing.
    """

    answers: Answers
    columns: Mapping[str, str] = field(default_factory=dict)
    guessed: frozenset[str] = frozenset()
    unused: tuple[str, ...] = ()


def read_answers(path: Path, columns: ColumnMap | None = None) -> Answers:
    """Return the answers of read_table. Raises InputError."""
    return read_table(path, columns).answers


def read_table(path: Path, columns: ColumnMap | None = None) -> AnswersTable:
    """Read answers from answers.csv, the folder that holds it, or a foreign CSV.

    A code book beside answers.csv describes it; of a foreign table what no map says is inferred, see
    infer_columns. Raises InputError that names line and column.
    """
    path, column_map = _table(Path(path)), columns or ColumnMap()
    book, beside = None, path.with_name(CODE_BOOK_FILE)
    if path.name == ANSWERS_FILE and beside.is_file():
        book = read_code_book(beside)
        stimuli = column_map.stimuli or book.stimuli
        simulated = column_map.simulated or book.simulated
        kind = column_map.kind or book.kind
        column_map = replace(column_map, kind=kind, stimuli=stimuli, simulated=simulated)
    lines, _ = decode_lines(path, read_limited(path, LARGEST_bytes, "split the file"), REMEDY)
    # a name that fdvv wrote may hold a semicolon
    mark = "," if book else sniff_separator(next(line for line in lines if line.strip()))
    mark = "," if mark == " " else mark
    reader = csv.reader(io.StringIO("\n".join(lines), newline=""), delimiter=mark)
    (_, heads), *rows = _filled(path, reader)
    for line, cells in rows:
        if len(cells) != len(heads):
            reason = f"{len(cells)} cells under {len(heads)} headings"
            raise InputError(path, f"line {line}", reason, "check separators and quotes")
    places_of(heads, column_map, book, path)
    found = Inferred(column_map) if book else infer(heads, [cells for _, cells in rows], column_map)
    if found.repeat:
        raise _repeat_error(path, heads, rows, found.repeat)
    layout = layout_of(heads, found.column_map, book, path)
    answers = _read(path, heads, rows, found.column_map, layout, decimal_comma=mark != ",")
    names = {role: heads[place] for role, place in layout.roles.items()}
    names |= {
        f"{rating}:{stimulus}".rstrip(":"): heads[place]
        for rating, places in layout.ratings.items()
        for stimulus, place in places.items()
    }
    return AnswersTable(answers, {} if book else names, frozenset(found.guessed), found.unused)


def _repeat_error(
    path: Path, heads: Sequence[str], rows: Sequence[tuple[int, list[str]]], trial: RepeatedTrial
) -> InputError:
    """Say which two lines are one trial, and in what they differ."""
    (first, before), (line, again) = rows[trial.first], rows[trial.again]
    other = ", ".join(head for head, a, b in zip(heads, before, again, strict=True) if a != b)
    which = ", ".join(f"{head} {again[heads.index(head)]}" for head in trial.heads)
    how = f"with another {other}" if other else "word for word"
    reason = f"is the trial of line {first} once more, {how}: {which}"
    remedy = "delete one of them, or tell them apart in a column called button, block or session"
    return InputError(path, f"line {line}", reason, remedy)


def _read(
    path: Path,
    heads: Sequence[str],
    rows: Sequence[tuple[int, list[str]]],
    column_map: ColumnMap,
    layout: Layout,
    decimal_comma: bool,
) -> Answers:
    trials: dict[TrialKey, _Trial] = {}
    rounds: dict[tuple[str, ...], int] = {}
    simulated = column_map.simulated
    for line, cells in rows:
        row = Row(path, heads, column_map, decimal_comma, line, cells)
        _take(row, layout, trials, rounds)
        simulated |= row.number(layout.roles.get("simulated")) == 1.0
    if not trials:
        raise InputError(path, "whole file", "it holds headings and no answer", REMEDY)
    found = list(trials.values())
    for trial in found:
        # nothing in it was chosen, and somebody said so of all
        if not trial.choice and trial.refused > 1 and trial.refused == len(trial.lines):
            trial.choice = EQUAL
    stimuli = _stimuli(path, column_map, layout, found)
    return _answers(found, replace(column_map, simulated=simulated), stimuli, layout, path)


def _filled(path: Path, reader: Iterator[list[str]]) -> Iterator[tuple[int, list[str]]]:
    try:
        for line, row in enumerate(reader, start=1):
            if any(cell.strip() for cell in row):
                yield line, [unescaped(cell.strip()) for cell in row]
    except csv.Error as error:
        raise InputError(path, "whole file", f"not a CSV ({error})", REMEDY) from error


def _take(
    row: Row, layout: Layout, trials: dict[TrialKey, _Trial], rounds: dict[tuple[str, ...], int]
) -> None:
    roles = layout.roles
    person = row.cells[roles["person"]]
    if not person:
        raise row.wrong(roles["person"], "nobody is named", "fill it in, or delete the line")
    item = row.cells[roles["item"]] if "item" in roles else ONE_ITEM
    stimulus = row.word(roles.get("stimulus"))
    seen = rounds[person, item, stimulus] = rounds.get((person, item, stimulus), -1) + 1
    number = row.number(roles.get("round"))
    # a round of a staircase or of thresholds has many trials
    step = any(not np.isnan(row.number(roles.get(name))) for name in ("ratio", *CHANGES))
    key = (person, item, seen if np.isnan(number) else int(number), row.line if step else 0)
    trial = trials.setdefault(key, _Trial(*key[:3]))
    if stimulus in trial.lines:
        which = f"{item}, {stimulus}" if stimulus else item
        reason = f"{person} has a second row of {which}, round {key[2]}, after line {trial.lines[stimulus]}"
        remedy = "delete one of them, or give every trial of a person its own round"
        raise InputError(row.path, f"line {row.line}", reason, remedy)
    trial.lines[stimulus] = row.line
    _fill(row, layout, trial, stimulus)


def _fill(row: Row, layout: Layout, trial: _Trial, stimulus: str) -> None:
    roles = layout.roles
    _choose(row, layout, trial, stimulus)
    for name in ("correct", "ratio", "time_s"):
        if name in roles:
            setattr(trial, name, row.number(roles[name]))
    trial.change = tuple(row.number(roles.get(name)) for name in CHANGES)
    if "correct" in roles and trial.correct not in (0.0, 1.0) and not np.isnan(trial.correct):
        raise row.wrong(roles["correct"], f"{trial.correct:g} is neither 1 nor 0", "code it so")
    trial.excluded = _reason(row.cells[roles["excluded"]]) if "excluded" in roles else trial.excluded
    for rating, places in layout.ratings.items():
        for named, place in places.items():
            trial.ratings[rating, named or stimulus] = row.number(place)


def _choose(row: Row, layout: Layout, trial: _Trial, stimulus: str) -> None:
    """Take the choice that a row names, or says of its own stimulus; all rows of a trial must agree."""
    place, found = layout.roles.get("choice"), ""
    if place is not None:
        found = row.word(place)
    elif "is_chosen" in layout.roles:
        place = layout.roles["is_chosen"]
        chosen = row.number(place)
        found = stimulus if chosen == 1.0 else ""
        trial.refused += chosen == 0.0
    if place is not None and found and trial.choice and found != trial.choice:
        reason = f"{trial.choice!r} and {found!r} are chosen in one trial"
        raise row.wrong(place, reason, "tell the rounds apart with --map round=COLUMN")
    trial.choice = found or trial.choice


def _reason(word: str) -> str:
    if not word or word.lower() in NO:
        return ""
    return "excluded in the file" if word.lower() in YES else word


def _stimuli(path: Path, column_map: ColumnMap, layout: Layout, trials: Sequence[_Trial]) -> tuple[str, ...]:
    rated = dict.fromkeys(key[1] for trial in trials for key in trial.ratings)
    words = set(task_behind(column_map.kind).choices) - set(LABELS)
    chosen = sorted({trial.choice for trial in trials} - {"", EQUAL} - words)
    found = tuple(sorted(rated) if layout.long else rated) or tuple(chosen)
    stimuli = column_map.stimuli or found
    strange = [one for one in (*chosen, *rated) if one not in stimuli]
    if strange:
        remedy = f"name it: --stimuli, or say what it means: --code {strange[0] or 'WORD'}=STIMULUS"
        reason = f"{strange[0]!r} is none of {', '.join(stimuli)}"
        raise InputError(path, "whole file", reason, remedy)
    return stimuli


def _answers(
    trials: Sequence[_Trial], column_map: ColumnMap, stimuli: tuple[str, ...], layout: Layout, path: Path
) -> Answers:
    names = np.array([(one.person, one.item, one.choice, one.excluded) for one in trials], dtype=str)
    ratings = {
        rating: np.array([[t.ratings.get((rating, s), np.nan) for s in stimuli] for t in trials])
        for rating in layout.ratings
    }
    ratio, time_s = (_numbers(trials, name) for name in ("ratio", "time_s"))
    change = np.array([one.change for one in trials], dtype=np.float64)
    grown = not np.isnan(change).all()
    choices = set(names[:, 2].tolist())
    kind = column_map.kind or ("thresholds" if grown else _kind(ratings, ratio, choices, stimuli, path))
    return Answers(
        kind,
        stimuli,
        person=names[:, 0],
        item=names[:, 1],
        round=np.array([one.round for one in trials]),
        choice=names[:, 2],
        correct=_numbers(trials, "correct"),
        ratings=ratings,
        ratio=None if np.isnan(ratio).all() else ratio,
        time_s=None if np.isnan(time_s).all() else time_s,
        excluded=names[:, 3],
        simulated=column_map.simulated,
        change=change if grown else None,
    )


def _numbers(trials: Sequence[_Trial], name: str) -> FloatArray:
    return np.array([getattr(one, name) for one in trials], dtype=np.float64)


def _kind(
    ratings: Mapping[str, FloatArray],
    ratio: FloatArray,
    choices: set[str],
    stimuli: tuple[str, ...],
    path: Path,
) -> str:
    if np.isfinite(ratio).any():
        return "staircase"
    if ratings and next(iter(ratings.values())).shape[1] == 2:
        return "realism"
    if not ratings and len(stimuli) == 2 and choices & set(stimuli):
        return "2ac" if EQUAL in choices else "preference"
    remedy = f"say it: --kind realism, abx, 2afc, 2ac, preference, mushra or {TIMING}"
    raise InputError(path, "whole file", "nothing tells what kind of study this was", remedy)


def _table(path: Path) -> Path:
    if not path.is_dir():
        return path
    for place in (path / ANSWERS_FILE, path / UNSEALED / ANSWERS_FILE):
        if place.is_file():
            return place
    remedy = "unseal the study first: fdvv study unseal, or name a CSV"
    raise InputError(path, "folder", f"it holds no {ANSWERS_FILE}", remedy)
