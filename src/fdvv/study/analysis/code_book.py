"""The code book of a study's answers: what every column of the CSV beside it means."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import msgspec

from fdvv.documents import Kind, pretty, read_document
from fdvv.files import read_limited
from fdvv.study import EQUAL, Answers, StudyPlan

CODE_BOOK_FILE = "codebook.json"
KIND = Kind("fdvv-codebook", 1, "a code book", "write it with fdvv study export")
LARGEST_bytes = 4_000_000

ColumnType = Literal["text", "whole number", "number", "0 or 1"]


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
        """Give rating and stimulus of every rating's column."""
        return {one.name: (one.rating, one.stimulus) for one in self.columns if one.role == "rating"}


def code_book(answers: Answers, plan: StudyPlan | None = None) -> CodeBook:
    """Describe the columns that `answers_csv` writes. plan : knows the ends of the scales."""
    return CodeBook(
        study=plan.name if plan else "",
        kind=answers.kind,
        stimuli=answers.stimuli,
        simulated=answers.simulated,
        columns=(*_fixed(answers), *_ratings(answers, plan)),
    )


def code_book_text(book: CodeBook) -> str:
    """Write a code book as JSON."""
    return pretty(msgspec.to_builtins(book)) + "\n"


def read_code_book(path: Path) -> CodeBook:
    """Read a code book. InputError."""
    return read_document(
        read_limited(path, LARGEST_bytes, KIND.remedy),
        path,
        KIND,
        lambda data: msgspec.json.decode(data, type=CodeBook),
        lambda _place: None,
    )


def rating_column(rating: str, stimulus: str) -> str:
    """Name the column of a rating."""
    return f"{rating}_{stimulus}"


def _fixed(answers: Answers) -> tuple[CodedColumn, ...]:
    """Describe the columns that every study has."""
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


def _ratings(answers: Answers, plan: StudyPlan | None) -> tuple[CodedColumn, ...]:
    scales = {one.name: one for one in plan.ratings} if plan else {}
    found = []
    for rating in answers.ratings:
        scale = scales.get(rating)
        question = next(iter(scale.question.values()), "") if scale else ""
        low, high = (None, None) if scale is None else scale_ends(scale.points)
        for stimulus in answers.stimuli:
            meaning = f"{rating} of {stimulus}" + (f": {question}" if question else "")
            found.append(
                CodedColumn(
                    rating_column(rating, stimulus), "rating", meaning, "number",
                    rating=rating, stimulus=stimulus, low=low, high=high,
                )
            )  # fmt: skip
    return tuple(found)


def scale_ends(points: int) -> tuple[float, float]:
    """Give the ends of a scale: 7 is 1 to 7, 101 a slider from 0 to 100."""
    return (0.0, 100.0) if points == 101 else (1.0, float(points))
