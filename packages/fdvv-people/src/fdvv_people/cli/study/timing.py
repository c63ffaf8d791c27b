"""What fdvv study analyse and export do with a timing study."""

from __future__ import annotations

from pathlib import Path

import click
import msgspec

from fdvv.cli import ui
from fdvv.io.files import read_limited, write_atomic
from fdvv.report.report import write_report
from fdvv_people.report.prose import interval_text
from fdvv_people.study.admin.study import Study
from fdvv_people.study.files.layout import UNSEALED
from fdvv_people.study.timing.analyse import TimingAnalysis, analyse_timing
from fdvv_people.study.timing.report import capitalised, timing_dict, timing_html
from fdvv_people.study.timing.scores import SCORES_FILE, unsealed_scores
from fdvv_people.study.timing.sentences import (
    measure_of,
    next_sentence,
    strokes_sentence,
    verdict_sentence,
)
from fdvv_people.study.timing.unseal import TRAINING_FILE

ANALYSIS_FILE = "analysis.json"


def analyse(folder: Path, report: Path | None, as_json: bool) -> None:
    """Analyse an unsealed timing study, and write its report where one is asked for."""
    study = Study.open(folder)
    found = analyse_timing(unsealed_scores(study))
    if report is not None:
        origin = f"study {study.plan.name}, fingerprint {study.fingerprint}"
        write_report(report, timing_html(found, study.folder / UNSEALED, origin))
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


def export(source: Path, folder: Path) -> tuple[int, bool, list[Path]]:
    """Write the scores, the training and everything that the analysis found into a folder.

    Returns how many trials there are, whether they are simulated, and the files.
    """
    study = Study.open(source)
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
    return len(scores.rows), scores.simulated, written
