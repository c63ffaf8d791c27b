"""The code book of a study's answers: what every column of the CSV beside it means."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Literal

import msgspec
import numpy as np

from fdvv.io.documents import Kind, pretty
from fdvv.io.files import read_limited, write_atomic
from fdvv.model.noticeable import DIMENSIONS
from fdvv_people.study.files.layout import read_record
from fdvv_people.study.plan.answers import Answers
from fdvv_people.study.plan.plan import StudyPlan
from fdvv_people.study.plan.trial import EQUAL

CODE_BOOK_FILE = "codebook.json"
KIND = Kind("fdvv-codebook", 1, "a code book", "write it with fdvv study export")
LARGEST_bytes = 4_000_000
ColumnType = Literal["text", "whole number", "number", "0 or 1"]
ANSWERS_FILE = "answers.csv"
FORMULA = re.compile(r"'*[=+\-@\t\r]")
"""How text begins that a spreadsheet would calculate, or that was kept from that before."""
NUMBERS = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?( [+-]?[\d.eE+-]+| nan)*")
"""A number, or several as `rendered.csv` has them."""


class CodedColumn(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """One column of the CSV.

    Attributes
    ----------
    name : its heading. role : what it is taken for: person, item, …, or "rating". type, unit : of its cells.
    values : what a cell may say, and its meaning; {}: anything of the type.
    rating, stimulus : of a rating, which scale and which rendering. low, high : ends of the scale.
    """

    name: str
    role: str
    meaning: str
    type: ColumnType
    unit: str = ""
    values: dict[str, str] = {}
    rating: str = ""
    stimulus: str = ""
    low: float | None = None
    high: float | None = None


class CodeBook(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """What the columns of answers.csv mean.

    Attributes
    ----------
    study, kind : name and kind of the study. stimuli : names, in order; of two, a preference counts for the
        second. simulated : nobody took part. missing : how a cell says that there is nothing.
    """

    format: Literal["fdvv-codebook"] = "fdvv-codebook"
    version: Literal[1] = 1
    study: str = ""
    kind: str
    stimuli: tuple[str, ...]
    simulated: bool
    missing: str = "an empty cell"
    columns: tuple[CodedColumn, ...]

    def rating_columns(self) -> dict[str, tuple[str, str]]:
        """Return rating and stimulus of every rating's column."""
        return {one.name: (one.rating, one.stimulus) for one in self.columns if one.role == "rating"}


def code_book(answers: Answers, plan: StudyPlan | None = None) -> CodeBook:
    """Describe the columns that `answers_csv` writes. plan : knows the ends of the scales."""
    return CodeBook(
        study=plan.name if plan else "",
        kind=answers.kind,
        stimuli=answers.stimuli,
        simulated=answers.simulated,
        columns=(*_fixed(answers), *_changes(answers), *_ratings(answers, plan)),
    )


def code_book_text(book: CodeBook) -> str:
    return pretty(msgspec.to_builtins(book)) + "\n"


def read_code_book(path: Path) -> CodeBook:
    """Read a code book. InputError."""
    return read_record(read_limited(path, LARGEST_bytes, KIND.remedy), path, KIND, CodeBook)


def rating_column(rating: str, stimulus: str) -> str:
    return f"{rating}_{stimulus}"


def _fixed(answers: Answers) -> tuple[CodedColumn, ...]:
    chosen = {name: f"{name} was chosen" for name in answers.stimuli} | {EQUAL: "no difference"}
    right = {"1": "the answer was right", "0": "it was wrong"}
    return (
        CodedColumn("person", "person", "who answered", "text"),
        CodedColumn("item", "item", "the button that the trial was about", "text"),
        CodedColumn("round", "round", "how often the item had been met before", "whole number"),
        CodedColumn("choice", "choice", "what was chosen", "text", values=chosen),
        CodedColumn("correct", "correct", "empty too where no answer is right", "0 or 1", values=right),
        CodedColumn("ratio", "ratio", "force added to the comparison of a staircase", "number", "1"),
        CodedColumn("time_s", "time_s", "from the trial shown to the answer", "number", "s"),
        CodedColumn("excluded", "excluded", "why the trial does not count; empty where it does", "text"),
        CodedColumn(
            "simulated",
            "simulated",
            "who answered",
            "0 or 1",
            values={"1": "a simulated participant: a proxy, no evidence", "0": "a person"},
        ),
    )


def _changes(answers: Answers) -> tuple[CodedColumn, ...]:
    if answers.change is None:
        return ()
    return tuple(
        CodedColumn(f"{one}_ratio", f"{one}_ratio", f"{one} added to the comparison", "number", "1")
        for one in DIMENSIONS
    )


def _ratings(answers: Answers, plan: StudyPlan | None) -> tuple[CodedColumn, ...]:
    scales = {one.name: one for one in plan.ratings} if plan else {}
    found = []
    for rating in answers.ratings:
        scale = scales.get(rating)
        question = next(iter(scale.question.values()), "") if scale else ""
        low, high = map(float, scale.ends) if scale else (None, None)
        for stimulus in answers.stimuli:
            meaning = f"{rating} of {stimulus}" + (f": {question}" if question else "")
            found.append(
                CodedColumn(
                    rating_column(rating, stimulus), "rating", meaning, "number",
                    rating=rating, stimulus=stimulus, low=low, high=high,
                )
            )  # fmt: skip
    return tuple(found)


def write_answers(folder: Path, answers: Answers, plan: StudyPlan | None = None) -> tuple[Path, Path]:
    """Write answers.csv and codebook.json into a folder, each whole or not at all; return both. OSError."""
    table, book = folder / ANSWERS_FILE, folder / CODE_BOOK_FILE
    write_atomic(table, answers_csv(answers))
    write_atomic(book, code_book_text(code_book(answers, plan)))
    return table, book


def answers_csv(answers: Answers) -> str:
    """Write answers as CSV: UTF-8, commas, a point in decimals, an empty cell where there is nothing.

    A row is a trial; columns as `code_book` describes them. Numbers keep every digit.
    """
    n = len(answers.person)
    missing = np.full(n, np.nan)
    columns: list[np.ndarray] = [
        *(answers.person, answers.item, answers.round, answers.choice, answers.correct),
        missing if answers.ratio is None else answers.ratio,
        missing if answers.time_s is None else answers.time_s,
        np.full(n, "") if answers.excluded is None else answers.excluded,
        np.full(n, int(answers.simulated)),
        *(() if answers.change is None else answers.change.T),
        *(column for rating in answers.ratings.values() for column in rating.T),
    ]
    cells = [[cell_text(one) for one in column.tolist()] for column in columns]
    return csv_text([one.name for one in code_book(answers).columns], zip(*cells, strict=True))


def csv_text(heads: Iterable[str], rows: Iterable[Iterable[object]]) -> str:
    """Write a table as all files of a study have it: commas, a line of headings, lines end as on Unix.

    Text that a spreadsheet would calculate, as ``=1+1``, gets an apostrophe before it; numbers stay.
    """
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow([_escaped(one) for one in heads])
    writer.writerows([_escaped(one) for one in row] for row in rows)
    return stream.getvalue()


def _escaped(cell: object) -> object:
    formula = isinstance(cell, str) and FORMULA.match(cell) and not NUMBERS.fullmatch(cell)
    return f"'{cell}" if formula else cell


def unescaped(cell: str) -> str:
    """Return the text of a cell without the apostrophe that keeps a spreadsheet from calculating it."""
    return cell[1:] if cell.startswith("'") and FORMULA.match(cell) else cell


def cell_text(value: str | float) -> str:
    """Write a name, or a number with every digit it has; nothing where it is missing."""
    if isinstance(value, str):
        return value
    value = float(value)
    if np.isnan(value):
        return ""
    return str(int(value)) if value.is_integer() else repr(value)
