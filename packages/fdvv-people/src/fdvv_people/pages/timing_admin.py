"""What the operator's pages show of timing studies: people, how far the study is, what its plan comes to."""

from __future__ import annotations

import time

from fdvv.report.report import Section, Table
from fdvv_people.study.admin.standing import Kind
from fdvv_people.study.files.layout import UNSEALED
from fdvv_people.study.plan.plan_file import STUDY_FILE
from fdvv_people.timing.analysis.analyse import TimingAnalysis, analyse_timing
from fdvv_people.timing.analysis.report import timing_html
from fdvv_people.timing.analysis.scores import SCORES_FILE, read_scores
from fdvv_people.timing.analysis.sentences import verdict_sentence
from fdvv_people.timing.files.progress import PersonProgress, timing_progress
from fdvv_people.timing.files.study import TimingStudy, button_problems
from fdvv_people.timing.plan.plan import TimingPlan
from fdvv_people.timing.plan.plan_file import plan_problems, read_timing_plan

ROUND_s = {"easy": 2.8, "hard": 2.3}
"""What a press takes: the bullet's way, the dark before it, and the time in which a late press counts."""


def text_problems(text: str) -> tuple[str, ...]:
    """List what is wrong with the text of a plan. InputError where it is none."""
    return plan_problems(read_timing_plan(text, STUDY_FILE))


def study_problems(study: TimingStudy) -> tuple[str, ...]:
    """List what is wrong with a study's plan, buttons that cannot be opened among it. InputError."""
    plan = study.plan
    return (*plan_problems(plan), *button_problems(plan, study.folder))


def people_of(study: TimingStudy) -> tuple[PersonProgress, ...]:
    """Return how far everybody is now. InputError, OSError."""
    return timing_progress(study, time.time()).people


def standing_text(one: PersonProgress) -> str:
    """Return where a person is, in a few words."""
    if one.problem:
        return "not to be read"
    if one.state in ("withdrawn", "deleted"):
        return one.state
    return "declined" if one.phase == "out" else one.phase


def timing_sentence(study: TimingStudy) -> tuple[str, Kind]:
    """Return how far a study is, in a sentence. InputError, OSError."""
    if study.frozen is None:
        return _draft_sentence(study)
    if any("unsealed" in record for record in study.history()):
        return _found_sentence(study)
    people, planned = [one for one in people_of(study) if one.phase != "out"], study.plan.people
    done = sum(one.phase == "done" for one in people)
    if done >= planned:
        return f"All {planned} participants are done: unseal the study to see how they did.", "good"
    due = sum(one.phase in ("due", "overdue") for one in people)
    waiting = sum(one.phase == "waiting" for one in people)
    more = [f"{count} {what}" for count, what in ((waiting, "wait"), (due, "due to come back")) if count]
    return f"{done} of {planned} participants done{''.join(f', {one}' for one in more)}.", ""


def _found_sentence(study: TimingStudy) -> tuple[str, Kind]:
    found = analysed(study)
    if study.plan.claim is None:
        return "The study is open; it claims nothing, so read its report.", ""
    sentence = verdict_sentence(found)
    return f"{sentence[0].upper()}{sentence[1:]}", "good" if found.holds else "warning"


def analysed(study: TimingStudy) -> TimingAnalysis:
    """Return what an unsealed study found. InputError."""
    return analyse_timing(read_scores(study.folder / UNSEALED / SCORES_FILE, study.plan))


def report_html(study: TimingStudy, name: str) -> str:
    """Return the report of an unsealed study. InputError, BuildError."""
    origin = f"Study {name}, frozen as {study.fingerprint}."
    return timing_html(analysed(study), study.folder / UNSEALED, origin)


def _draft_sentence(study: TimingStudy) -> tuple[str, Kind]:
    if problems := study_problems(study):
        more = f" (and {len(problems) - 1} more)" if len(problems) > 1 else ""
        return f"Not ready to freeze: {problems[0]}{more}.", "warning"
    plan = study.plan
    return f"Ready to freeze: {_count(plan.people, 'participant')} × {_count(plan.trials, 'trial')}.", "good"


def timing_sections(plan: TimingPlan) -> list[Section]:
    """Return what a plan comes to for one person, and what is compared."""
    rounds = f"{plan.tap_s} s of tapping" if plan.tapping else f"{plan.presses} presses"
    rows = [
        ("training", str(plan.training_trials), rounds),
        ("validation", str(plan.trials - plan.training_trials), rounds),
    ]
    gap = f" {plan.gap_days:g} days lie between the two." if plan.training else ""
    times = f"About {_minutes(plan):.0f} minutes of pressing in all, without breaks.{gap}"
    each = [(one.name, one.kind, one.button, one.code) for one in plan.conditions]
    return [
        Section("One person", (times,), tables=(Table(("Part", "Trials", "A trial"), tuple(rows)),)),
        Section("Compared", (), tables=(Table(("Name", "Kind", "Button", "Key"), tuple(each)),)),
    ]


def _minutes(plan: TimingPlan) -> float:
    if plan.tapping:
        return plan.trials * plan.tap_s / 60.0
    return sum(plan.trials / len(plan.levels) * plan.presses * ROUND_s[level] for level in plan.levels) / 60.0


def _count(n: int, what: str) -> str:
    return f"{n} {what}{'s' * (n != 1)}"
