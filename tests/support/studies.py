"""Small studies, run by way of the real logs; what was rendered in them is made up."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from fdvv_people.study.admin.study import Study
from fdvv_people.study.files.people import SealedTrial
from fdvv_people.study.files.seal import Cost
from fdvv_people.study.plan.events import PageAnswered, TrialAnswered, TrialShown
from fdvv_people.study.plan.trial import Rendered, StudyTrial, TrialAnswer
from fdvv_people.study.session.log import OpenedSession

PASSPHRASE = "four words of no sense"
CHEAP = Cost(1, 8192)
"""Of a guess at a passphrase or a code: tests need no strength."""
HEAD = """
format = "fdvv-study"
version = 1
name = "small"
title = {{ en = "Small" }}
kind = "{kind}"
rounds = {rounds}
practice = 1
people = 4
languages = ["en"]
"""
TWO_ITEMS = """
[[items]]
name = "clear"
stimuli = [
  { name = "FD", button = "mx-clear", rendered = "FD" },
  { name = "FDVV", button = "mx-clear" },
]
[[items]]
name = "red"
stimuli = [
  { name = "FD", button = "own.fdvv.json", rendered = "FD" },
  { name = "FDVV", button = "own.fdvv.json" },
]
"""
RATING = """
[[ratings]]
name = "realism"
question = { en = "How real?" }
"""
PAGES = """
[[pages]]
name = "consent"
when = "consent"
title = { en = "Consent" }
[[pages]]
name = "about"
when = "before"
title = { en = "You" }
[[pages.questions]]
name = "age"
question = { en = "Age" }
low = 18
high = 99
"""

Judge = Callable[[StudyTrial], TrialAnswer]
Render = Callable[[StudyTrial], tuple[Rendered, ...]]


def plan_file(folder: Path, kind: str = "realism", rounds: int = 2, more: str = "") -> Path:
    """Write a plan of two items, one of them a file beside it."""
    from fdvv.model.file import load_builtin, save_model

    folder.mkdir(parents=True, exist_ok=True)
    save_model(load_builtin("rubber-dome"), folder / "own.fdvv.json")
    head = HEAD.format(kind=kind, rounds=rounds)
    (folder / "plan.toml").write_text(head + more + TWO_ITEMS + RATING + PAGES)
    return folder / "plan.toml"


def small_study(folder: Path, kind: str = "realism", rounds: int = 2, more: str = "") -> Study:
    """Declare and freeze a study below a folder."""
    study = Study.declare(folder / "study", plan_file(folder / "desk", kind, rounds, more))
    study.freeze(PASSPHRASE, CHEAP)
    return study


def attended(folder: Path, passphrase: str = PASSPHRASE) -> Study:
    """Open a study and its sessions, as the key holder does; that is not recorded."""
    study = Study.open(folder)
    study.run_key = study.key_holder(passphrase).run_key
    return study


def chosen(name: str, ratings: dict[str, float] | None = None) -> Judge:
    """Return who always chooses the label that hides a stimulus, and rates by stimulus."""
    points = ratings or {"FD": 3.0, "FDVV": 5.0}

    def judge(trial: StudyTrial) -> TrialAnswer:
        hidden = {label: stimulus for label, stimulus in trial.labels.items() if label != "X"}
        label = next(label for label, stimulus in hidden.items() if stimulus == name)
        rated = {one: points[stimulus] for one, stimulus in hidden.items()}
        presses = dict.fromkeys(trial.labels, 2)
        switches = tuple((float(i), one) for i, one in enumerate(trial.labels))
        return TrialAnswer(label, {"realism": rated}, switches, presses, 7.5)

    return judge


def rendered(trial: StudyTrial, error_cN: float = 2.0) -> tuple[Rendered, ...]:
    """Return what a sound device tells."""
    return tuple(
        Rendered(label, stimulus, 2, (error_cN, error_cN / 2), (101.0, 99.0), 2)
        for label, stimulus in trial.labels.items()
    )


def answered(
    study: Study,
    person: str,
    code: str,
    judge: Judge,
    render: Render = rendered,
    trials: int | None = None,
    age: float = 33.0,
) -> None:
    """Answer pages and so many trials, practice included, and close."""
    opened = OpenedSession(study, person, code, 0.0)
    opened.add(PageAnswered(1.0, "consent"))
    opened.add(PageAnswered(2.0, "about", {"age": age}))
    for trial in opened.schedule.trials[:trials]:
        opened.add(TrialShown(10.0 * trial.number, trial.number, 1))
        opened.seal(SealedTrial(trial.number, trial.ratio, render(trial)))
        opened.add(TrialAnswered(10.0 * trial.number + 5.0, trial.number, 1, judge(trial)))
    opened.close()
    if trials is None:
        study.finished(person)


@contextmanager
def in_haste() -> Iterator[None]:
    """Have nobody wait until something is on the disk: for studies that several tests look at."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(os, "fsync", lambda _file: None)
        yield


def all_files(folder: Path) -> list[Path]:
    """List every file below a folder."""
    return sorted(path for path in folder.rglob("*") if path.is_file())
