"""People's means with a row a person, as programs want repeated measures; and every figure as JSON."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from fdvv.io.documents import finite
from fdvv.io.files import write_atomic
from fdvv_people.study.analysis.code_book import cell_text, csv_text
from fdvv_people.study.analysis.columns import TIMING
from fdvv_people.study.analysis.jnds import UNITS
from fdvv_people.study.analysis.ratings import complete_rows, names_of, people_means
from fdvv_people.study.analysis.records import (
    ClaimResult,
    JndResult,
    RatedResult,
    StudyAnalysis,
    ThresholdResult,
    TimingResult,
)
from fdvv_people.study.plan.trial import EQUAL

PROXY = "simulated participants: a proxy, no evidence"
"""Notice wherever simulated answers are shown."""

PEOPLE_FILE, ANALYSIS_FILE, JNDS_FILE = "people.csv", "analysis.json", "jnds.csv"
JNDS = (
    *("person", "button", "dimension", "jnd_ratio", "low_ratio", "high_ratio", "log_error", "trials"),
    *("jnd", "unit", "simulated"),
)
"""Columns of jnds.csv."""


def analysis_dict(found: StudyAnalysis) -> dict[str, Any]:
    """Return everything an analysis found; units are in the names, shares and ratios are parts of 1."""
    return {
        "study": found.title,
        "kind": found.kind,
        "simulated": found.simulated,
        **({"proxy": PROXY} if found.simulated else {}),
        "buttons": list(found.buttons),
        "stimuli": list(found.stimuli),
        "screening": _screening(found),
        "claim": found.claim and _claim(found.claim),
        "tests": [one.to_dict() for one in found.tests],
        "ordinal": [asdict(one) for one in found.scales],
        "preference": found.preference and found.preference.to_dict(),
        "by_button": [one.to_dict() for one in found.by_button],
        "rated": [_rated(one) for one in found.rated],
        "threshold": found.threshold and asdict(found.threshold),
        "thresholds": [_threshold(one) for one in found.thresholds],
        "jnd": {name: asdict(one) for name, one in found.jnd.items()},
        "jnds": [_jnd(one) for one in found.jnds],
        "standards": {button: dict(sizes) for button, sizes in found.standards.items()},
        "timing": found.timing and _timing(found.timing),
        "people": [asdict(one) for one in found.people],
        "notes": list(found.notes),
    }


def _screening(found: StudyAnalysis) -> dict[str, Any]:
    screening = found.screening
    return {
        "people": len(screening.people),
        "people_counted": screening.people_counted,
        "trials": screening.planned,
        "answered": screening.answered,
        "counted": screening.counted,
        "reasons": dict(screening.reasons),
        "left_out": dict(screening.left_out),
    }


def _claim(found: ClaimResult) -> dict[str, Any]:
    return {
        **msgspec.to_builtins(found.claim),
        "registered": found.registered,
        "measured_by": found.measure,
        "supported": found.supported,
        "test": asdict(found.test),
    }


def _rated(found: RatedResult) -> dict[str, Any]:
    return {
        "button": found.button,
        "rating": found.rating,
        "stimuli": {name: asdict(one) for name, one in found.spreads.items()},
        "friedman": found.friedman and asdict(found.friedman),
        "pairs": [asdict(one) for one in found.pairs],
        "unpaired_ratings": found.unpaired,
    }


def _threshold(found: ThresholdResult) -> dict[str, Any]:
    return {
        "person": found.person,
        "button": found.button,
        "trials": int(found.ratios.size),
        "threshold_ratio": found.threshold.value,
        "low": found.threshold.low,
        "high": found.threshold.high,
    }


def _jnd(found: JndResult) -> dict[str, Any]:
    return {
        "person": found.person,
        "button": found.button,
        "trials": found.trials,
        "correct": found.correct,
        "jnds": {name: asdict(one) for name, one in found.jnds.items()},
        "surfaces": [
            {"across": one.across, "up": one.up, "points": one.points.tolist()} for one in found.surfaces
        ],
    }


def _timing(found: TimingResult) -> dict[str, Any]:
    return {
        "measure": found.measure,
        "people": len(found.scores),
        "means": {
            f"{button}, {level}": float(found.scores[:, i, j].mean())
            for i, button in enumerate(found.buttons)
            for j, level in enumerate(found.levels)
        },
        "anova": found.anova and [asdict(one) for one in found.anova.effects],
        "pairs": {level: [asdict(one) for one in pairs] for level, pairs in found.pairs.items()},
    }


def write_analysis(folder: Path, found: StudyAnalysis) -> tuple[Path, ...]:
    """Write people.csv and analysis.json into a folder, and jnds.csv where JNDs were measured; return them.

    Each is written whole or not at all. OSError.
    """
    table, figures = folder / PEOPLE_FILE, folder / ANALYSIS_FILE
    write_atomic(table, people_csv(found))
    write_atomic(figures, json.dumps(finite(analysis_dict(found)), indent=1, allow_nan=False) + "\n")
    if not found.jnds:
        return table, figures
    write_atomic(folder / JNDS_FILE, jnds_csv(found))
    return table, figures, folder / JNDS_FILE


def jnds_csv(found: StudyAnalysis) -> str:
    """Write a row for each person, button and dimension: the JND as a ratio, and in its unit."""
    rows = []
    for one in found.jnds:
        for name, jnd in one.jnds.items():
            size = found.standards.get(one.button, {}).get(name)
            absolute = ("", "") if size is None else (cell_text(size * jnd.ratio), UNITS[name])
            numbers = (jnd.ratio, jnd.low, jnd.high, jnd.log_error, float(jnd.trials))
            cells = (one.person, one.button, name, *map(cell_text, numbers), *absolute)
            rows.append((*cells, cell_text(float(found.simulated))))
    return csv_text(JNDS, rows)


def people_csv(found: StudyAnalysis) -> str:
    """Write a row a person: means of what counts, in columns RATING_BUTTON_STIMULUS; shares of choices.

    choice_BUTTON_STIMULUS and choice_BUTTON_equal are parts of the answers, correct_BUTTON that
    of right ones. An empty cell where a person gave nothing that counts.
    """
    answers = found.screening.answers
    buttons = names_of(answers.item)
    heads, columns = ["person"], [list(found.screening.people)]
    for rating, values in answers.ratings.items():
        # of two stimuli the means are those that are tested: of trials in which both were rated
        paired = values.shape[1] == 2 and answers.kind != TIMING
        means = people_means(answers, complete_rows(values) if paired else values)
        for j, button in enumerate(buttons):
            for k, stimulus in enumerate(answers.stimuli):
                heads.append(f"{rating}_{button}_{stimulus}")
                columns.append([cell_text(one) for one in means[:, j, k]])
    names = (*answers.stimuli, EQUAL) if np.any(answers.choice != "") else ()
    chosen = [np.where(answers.choice == "", np.nan, answers.choice == name) for name in names]
    parts = dict(zip([f"choice_{{}}_{name}" for name in names], chosen, strict=True))
    if np.isfinite(answers.correct).any():
        parts["correct_{}"] = answers.correct
    for pattern, part in parts.items():
        means = people_means(answers, part[:, np.newaxis].astype(np.float64))
        for j, button in enumerate(buttons):
            heads.append(pattern.format(button))
            columns.append([cell_text(one) for one in means[:, j, 0]])
    columns.append([cell_text(found.simulated)] * len(found.screening.people))
    return csv_text([*heads, "simulated"], zip(*columns, strict=True))
