"""fdvv sweep."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import click

from fdvv.cli import ui
from fdvv.cli.options import Workers, executor_options
from fdvv.force_text import ForceTitle, force_name


@click.command()
@click.argument("plan", type=ui.FILE)
@ui.option(
    "-o", "--output", type=ui.NEW_FOLDER, help="The folder of results: new, or that of the same sweep."
)
@ui.option("--preview", is_flag=True, help="Only count the cells and time a few of them.")
@executor_options
@ui.json_option
def sweep(plan: Path, output: Path | None, preview: bool, where: Workers, as_json: bool) -> None:
    """Try every combination of rigs, fingers, buttons and methods; simulated.

    PLAN is a *.toml file of lists and ranges (docs/reference/sweep-files.md). Every combination is a row of a
    Parquet file with a column for each factor and figure; one that fails is a row with its reason. Whatever
    ended a sweep, the same command goes on. The result is the same however many processes work on it.
    """
    from fdvv_campaigns.sweep.plan import read_sweep_plan

    sweep_plan = read_sweep_plan(plan)
    if preview:
        _preview(sweep_plan, plan, output, where.processes or where.workers, as_json)
        return
    if output is None:
        raise click.UsageError("a sweep needs --output FOLDER, or --preview")
    ui.check_folder(output)
    _run(sweep_plan, plan, output, where, as_json)


def _run(sweep_plan: Any, plan: Path, output: Path, where: Workers, as_json: bool) -> None:
    from fdvv_campaigns.sweep.sweep import run_sweep, sweep_summary

    with where.at_work(output, "cells", sweep_plan.count) as (executor, tell):
        result = run_sweep(sweep_plan, output, executor, tell, plan.parent)
    document = {**result.to_dict(), "summary": sweep_summary(result)}
    if as_json:
        ui.print_json(document)
        return
    cells = ui.counted(result.cells, "cell")
    click.echo(f"{sweep_plan.measure}: {cells} (simulated), {result.failed} failed")
    for part in document["summary"]:
        figure, factor = part["figure"], part["factor"]
        title = force_name(figure)
        columns: list[str] = ["median", "5 %", "95 %"]
        if isinstance(title, ForceTitle):
            columns = [ForceTitle(column, 3) for column in columns]
        rows = [
            [str(row["value"]), row["cells"], *(row[k] for k in ("median", "low", "high"))]
            for row in part["rows"]
        ]
        head = [f"{title} by {force_name(factor)}", "cells", *columns]
        ui.print_table(head, rows, digits=dict.fromkeys(columns, 3))
    if result.failed:
        ui.print_warnings([f"{ui.counted(result.failed, 'cell')} failed; the first: {result.first_reason()}"])
    click.echo(f"written to {result.path}")


def _preview(sweep_plan: Any, plan: Path, output: Path | None, processes: int | None, as_json: bool) -> None:
    from fdvv_campaigns.sweep.sweep import preview_sweep

    preview = preview_sweep(sweep_plan, output, plan.parent)
    count = processes or len(os.sched_getaffinity(0))
    ui.print_warnings([f"a cell that was tried failed: {reason}" for reason in preview.failed])
    if as_json:
        ui.print_json({
            "cells": preview.cells, "done": preview.done, "cell_s": preview.cell_s, "processes": count,
            "estimated_s": preview.seconds(count), "failed": list(preview.failed),
        })  # fmt: skip
        return
    for name, values in sweep_plan.levels().items():
        listed = ", ".join(f"{v:g}" if isinstance(v, float) else str(v) for v in values[:6])
        more = f" ... {values[-1]}" if len(values) > 6 else ""
        click.echo(f"{name} ({len(values)}): {listed}{more}")
    each = f"{preview.cell_s:.3g} s each"
    click.echo(f"{ui.counted(preview.cells, 'cell')}, {preview.done} done, about {each}")
    click.echo(f"about {_duration(preview.seconds(count))} with {ui.counted(count, 'process')}; simulated")


def _duration(seconds: float) -> str:
    if seconds < 120:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 7200 else f"{seconds / 3600:.1f} h"
