"""People's means with a row a person, as programs want repeated measures; and every figure as JSON."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path

import numpy as np

from fdvv.documents import finite
from fdvv.files import write_atomic
from fdvv.study import EQUAL
from fdvv.workflow._study_dict import analysis_dict
from fdvv.workflow._study_export import number_text
from fdvv.workflow._study_ratings import names_of, people_means
from fdvv.workflow._study_records import StudyAnalysis

PEOPLE_FILE, ANALYSIS_FILE = "people.csv", "analysis.json"


def write_analysis(folder: Path, found: StudyAnalysis) -> tuple[Path, Path]:
    """Write people.csv and analysis.json into a folder, each whole or not at all; give both. OSError."""
    table, figures = folder / PEOPLE_FILE, folder / ANALYSIS_FILE
    write_atomic(table, people_csv(found))
    write_atomic(figures, json.dumps(finite(analysis_dict(found)), indent=1, allow_nan=False) + "\n")
    return table, figures


def people_csv(found: StudyAnalysis) -> str:
    """Write a row a person: means of what counts, in columns RATING_BUTTON_STIMULUS; shares of choices.

    choice_BUTTON_STIMULUS and choice_BUTTON_equal are parts of the answers, correct_BUTTON that
    of right ones. An empty cell where a person gave nothing that counts.
    """
    answers = found.screening.answers
    buttons = names_of(answers.item)
    heads, columns = ["person"], [list(found.screening.people)]
    for rating, values in answers.ratings.items():
        means = people_means(answers, values)
        for j, button in enumerate(buttons):
            for k, stimulus in enumerate(answers.stimuli):
                heads.append(f"{rating}_{button}_{stimulus}")
                columns.append([number_text(one) for one in means[:, j, k]])
    names = (*answers.stimuli, EQUAL) if np.any(answers.choice != "") else ()
    chosen = [np.where(answers.choice == "", np.nan, answers.choice == name) for name in names]
    parts = dict(zip([f"choice_{{}}_{name}" for name in names], chosen, strict=True))
    if np.isfinite(answers.correct).any():
        parts["correct_{}"] = answers.correct
    for pattern, part in parts.items():
        means = people_means(answers, part[:, np.newaxis].astype(np.float64))
        for j, button in enumerate(buttons):
            heads.append(pattern.format(button))
            columns.append([number_text(one) for one in means[:, j, 0]])
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow([*heads, "simulated"])
    writer.writerows([*row, str(int(found.simulated))] for row in zip(*columns, strict=True))
    return stream.getvalue()
