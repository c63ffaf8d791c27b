"""What the commands of fdvv study do with a timing study."""

from __future__ import annotations

import time
from dataclasses import asdict
from pathlib import Path

import click
import msgspec

from fdvv.cli import ui
from fdvv.cli.options import kept_on_interrupt
from fdvv.errors import InputError
from fdvv.io.files import read_limited, write_atomic
from fdvv.report.report import write_report
from fdvv_people.cli.study.keep import PeopleTable
from fdvv_people.report.prose import interval_text
from fdvv_people.study.files.layout import UNSEALED
from fdvv_people.study.plan.plan_file import STUDY_FILE
from fdvv_people.timing.analysis.analyse import TimingAnalysis, analyse_timing
from fdvv_people.timing.analysis.report import capitalised, timing_dict, timing_html
from fdvv_people.timing.analysis.scores import SCORES_FILE, TimingScores, read_scores
from fdvv_people.timing.analysis.sentences import (
    measure_of,
    next_sentence,
    strokes_sentence,
    verdict_sentence,
)
from fdvv_people.timing.analysis.unseal import TRAINING_FILE
from fdvv_people.timing.files.progress import DUE, PersonProgress, timing_progress
from fdvv_people.timing.files.study import TimingStudy, button_problems
from fdvv_people.timing.plan.plan import TimingPlan
from fdvv_people.timing.plan.plan_file import plan_problems, read_timing_plan
from fdvv_people.timing.simulation.sessions import simulate_timing

ANALYSIS_FILE = "analysis.json"
LARGEST_bytes = 4_000_000
BETWEEN_s = 10.0
"""Between two trials (assumed)."""


def check_timing(study: Path, as_json: bool) -> None:
    """Print what is wrong with a timing study's file, or what it comes to. Exit status 1 if it is wrong."""
    path = study / STUDY_FILE if study.is_dir() else study
    plan = read_timing_plan(read_limited(path, LARGEST_bytes, "name the file of a study"), path)
    problems = plan_problems(plan) or tuple(button_problems(plan, path.parent))
    if as_json:
        ui.print_json({"name": plan.name, "ok": not problems, "problems": problems, "notes": []})
    elif problems:
        for problem in problems:
            ui.print_wrapped(f"problem: {problem}")
        click.echo(f"{plan.name}: cannot be run, {ui.counted(len(problems), 'problem')}")
    else:
        ui.print_wrapped(_account(plan))
    if problems:
        raise click.exceptions.Exit(1)


def _account(plan: TimingPlan) -> str:
    trials = plan.trials - plan.training_trials
    minutes = f"about {_minutes(plan, trials):.0f} minutes (assumed)"
    text = f"{plan.name}: can be run; {ui.counted(trials, 'trial')} of validation a person, {minutes}"
    if plan.training:
        before = (
            f"{plan.training_trials} of training, about {_minutes(plan, plan.training_trials):.0f} minutes"
        )
        text += f", {plan.gap_days:g} days after {before}"
    return f"{text}; {plan.people} people"


def _minutes(plan: TimingPlan, trials: int) -> float:
    """Return how long trials take, breaks between them included."""
    round_s = sum(plan.round_s(level) for level in plan.all_levels) / len(plan.all_levels)
    minutes = trials * (plan.trial_rounds * round_s + BETWEEN_s) / 60.0
    breaks = int(minutes / plan.break_every_min) if plan.break_every_min else 0
    return minutes + breaks * plan.break_min


def timed_people(study: TimingStudy) -> PeopleTable:
    """Return how far the people of a timing study are, who is due, and the words that call them back."""
    people = timing_progress(study, time.time()).people
    rows = [
        [one.person, one.language, one.phase, f"{one.done} of {one.trials}", one.rounds, one.due_at[:10]]
        for one in people
    ]
    columns = ["person", "language", "phase", "trials", "rounds", "not before"]
    lines = [_due_line(one) for one in people if one.phase in DUE]
    return PeopleTable(msgspec.to_builtins(people), columns, rows, 4, lines)


def _due_line(one: PersonProgress) -> str:
    late = f", overdue since {one.overdue_at[:10]}" if one.phase == "overdue" else ""
    return f"due: {one.person}{late}: {one.reminder}"


def timing_simulate(folder: Path, people: int | None, seed: int, as_json: bool) -> None:
    """Run a whole frozen timing study with simulated people."""
    study = TimingStudy.open(folder)
    kept = f"interrupted; who was done is kept in {folder}, the same command goes on"
    with kept_on_interrupt(kept), ui.progress("simulated people", 1) as tell:
        found = simulate_timing(study, people, seed, progress=tell)
    if as_json:
        ui.print_json({**asdict(found), "study": study.plan.name, "fingerprint": study.fingerprint})
        return
    click.echo(
        f"simulated: {study.plan.name}, {ui.counted(len(found.finished), 'simulated participant')} done"
    )
    rows = [[one.person, one.trials, one.rounds, one.breaks, f"{one.days:.1f}"] for one in found.sessions]
    if rows:
        click.echo("")
        ui.print_table(["simulated", "trials", "rounds", "breaks", "days"], rows)
        click.echo("")
    ui.print_wrapped(f"Unseal the scores of the simulated people with: fdvv study unseal {folder}")


def unsealed_scores(study: TimingStudy) -> TimingScores:
    """Return what was unsealed of a timing study. InputError where nothing was."""
    path = study.folder / UNSEALED / SCORES_FILE
    if not path.is_file():
        raise InputError(
            study.folder, "study", "is not unsealed", f"unseal it: fdvv study unseal {study.folder}"
        )
    return read_scores(path, study.plan)


def timing_analyse(folder: Path, report: Path | None, as_json: bool) -> None:
    """Analyse an unsealed timing study, and write its report where one is asked for."""
    study = TimingStudy.open(folder)
    found = analyse_timing(unsealed_scores(study))
    if report is not None:
        origin = f"study {study.plan.name}, fingerprint {study.fingerprint}"
        write_report(report, timing_html(found, folder / UNSEALED, origin))
    if as_json:
        ui.print_json(timing_dict(found))
        return
    _print(found)
    if report is not None:
        click.echo(f"report: {report}")


def _print(found: TimingAnalysis) -> None:
    plan, (measure, unit) = found.scores.plan, measure_of(found.scores.plan)
    counts = f"{sum(row.counts for row in found.scores.rows)} trials of {len(found.scores.people)} people"
    click.echo(f"{plan.name} ({plan.kind}): {counts}")
    ui.print_wrapped(f"{capitalised(verdict_sentence(found))} {next_sentence(found)}")
    columns = ["button", "level", f"{measure} ({unit})", "SD of people"]
    rows = [[one.condition, one.level, one.mean, one.people_sd] for one in found.means]
    if plan.tapping:
        columns.append(f"strokes ({unit})")
        rows = [[*row, one.strokes_Hz] for row, one in zip(rows, found.means, strict=True)]
    ui.print_table(columns, rows, left=2, digits=dict.fromkeys(columns[2:], 2))
    if strokes := strokes_sentence(found):
        ui.print_wrapped(strokes)
    contrasts = [
        [one.rival, interval_text(one.mixed.value, 2), one.mixed.t, _p(one.holm_p), _p(one.flip_p)]
        for one in found.rivals
    ]
    if contrasts:
        heads = [f"{found.rivals[0].better} minus", f"{unit}, 95 %", "t", "Holm p", "flipped signs p"]
        ui.print_table(heads, contrasts)
    ui.print_warnings(list(found.notes))


def _p(p: float | None) -> str:
    return "–" if p is None else "< .001" if p < 0.001 else f"{p:.3f}"


def timing_export(source: Path, folder: Path, as_json: bool) -> None:
    """Write the scores, the training and everything that the analysis found into a folder."""
    study = TimingStudy.open(source)
    scores = unsealed_scores(study)
    document = timing_dict(analyse_timing(scores))
    written = []
    for name in (SCORES_FILE, TRAINING_FILE):
        data = read_limited(study.folder / UNSEALED / name, 64_000_000, "unseal the study again")
        written.append(folder / name)
        write_atomic(folder / name, data)
    text = msgspec.json.format(msgspec.json.encode(document), indent=1).decode()
    written.append(folder / ANALYSIS_FILE)
    write_atomic(folder / ANALYSIS_FILE, text + "\n")
    if as_json:
        ui.print_json({"rows": len(scores.rows), "files": [str(path) for path in written]})
        return
    simulated = " of simulated participants: a proxy, no evidence" if scores.simulated else ""
    click.echo(f"{ui.counted(len(scores.rows), 'trial')}{simulated}")
    for path in written:
        click.echo(str(path))
