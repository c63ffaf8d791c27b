"""Answers as a plain CSV with its code book: for R, JASP, pandas, and for fdvv itself."""

from __future__ import annotations

import csv
import io
from pathlib import Path

import numpy as np

from fdvv.files import write_atomic
from fdvv.study import Answers, StudyPlan
from fdvv.workflow._study_code_book import CODE_BOOK_FILE, code_book, code_book_text

ANSWERS_FILE = "answers.csv"


def write_answers(folder: Path, answers: Answers, plan: StudyPlan | None = None) -> tuple[Path, Path]:
    """Write answers.csv and codebook.json into a folder, each whole or not at all; give both. OSError."""
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
    columns: list[list[str]] = [
        [str(one) for one in answers.person],
        [str(one) for one in answers.item],
        [str(int(one)) for one in answers.round],
        [str(one) for one in answers.choice],
        _numbers(answers.correct),
        _numbers(missing if answers.ratio is None else answers.ratio),
        _numbers(missing if answers.time_s is None else answers.time_s),
        [""] * n if answers.excluded is None else [str(one) for one in answers.excluded],
        [str(int(answers.simulated))] * n,
    ]
    for rating in answers.ratings.values():
        columns += [_numbers(column) for column in rating.T]
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(one.name for one in code_book(answers).columns)
    writer.writerows(zip(*columns, strict=True))
    return stream.getvalue()


def _numbers(column: np.ndarray) -> list[str]:
    """Write numbers with as many digits as they have; nan is nothing."""
    return [number_text(float(one)) for one in column]


def number_text(value: float) -> str:
    """Write a number with every digit it has; nothing where it is missing."""
    value = float(value)
    if np.isnan(value):
        return ""
    return str(int(value)) if value.is_integer() else repr(value)
