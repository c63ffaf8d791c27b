"""fdvv optimize group."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fdvv.cli import ui

if TYPE_CHECKING:
    from fdvv_people.optimize.group.group import Group
    from fdvv_people.optimize.group.playoff import Playoff

REPORT_FILE, FIGURES_FILE = "report.html", "group.json"


@click.command()
@click.argument("runs", nargs=-1, required=True, type=ui.FOLDER)
@ui.option("--folder", required=True, type=ui.PATH, help="New or empty folder of the result.")
@ui.option(
    "--blocks",
    type=click.IntRange(0, 1000),
    default=16,
    help="In each of which simulated people play both buttons again; 0 and 1: only what the runs let expect.",
)
@ui.json_option
def group(runs: tuple[Path, ...], folder: Path, blocks: int, as_json: bool) -> None:
    """Find one button for all people who played RUNS, and what a button of one's own gains over it.

    RUNS are folders of finished runs, one per person, of the same space and task. Simulated people then play
    both buttons again. Of real people the gain is what their scores let expect. FOLDER holds the group's
    button, group.json and report.html.
    """
    from fdvv.io.documents import pretty
    from fdvv.io.files import require_new_folder, write_atomic
    from fdvv.model.file import MODEL_SUFFIX, save_model
    from fdvv.report.report import write_report
    from fdvv_people.optimize.group.group import GROUP, group_of, read_personal_runs
    from fdvv_people.optimize.group.report import group_html, group_report

    ui.check_folder(folder)
    require_new_folder(folder, "name a new one")
    found = group_of(read_personal_runs(runs))
    playoff = _play(found, blocks) if found.simulated and blocks > 1 else None
    document = group_report(found, playoff)
    path = folder / f"{GROUP}{MODEL_SUFFIX}"
    if found.runs[0].setup.space.kind != "own":
        save_model(found.model(found.design), path)
    write_atomic(folder / FIGURES_FILE, pretty(document) + "\n")
    write_report(folder / REPORT_FILE, group_html(found, playoff))
    if as_json:
        ui.print_json(document)
        return
    _print(found, playoff, document)
    ui.print_wrapped(f"next: {_next_step(found, playoff, folder, path)}")


def _play(found: Group, blocks: int) -> Playoff:
    from fdvv_people.optimize.group.playoff import play_off

    with ui.progress("people", len(found.runs)) as move:
        return play_off(found, blocks, move)


def _print(found: Group, playoff: Playoff | None, document: dict[str, Any]) -> None:
    click.echo(
        f"{found.runs[0].setup.title}{ui.simulated(found.simulated)}, {ui.counted(len(found.runs), 'run')}"
    )
    if playoff:
        rows = [
            [one.name, one.own, one.group, one.gain.difference if one.gain else 0.0] for one in playoff.people
        ]
        ui.print_table(["person", "own", "the group's", "gain"], rows, left=1)
    else:
        rows = [[run.name, gain] for run, gain in zip(found.runs, found.expected, strict=True)]
        ui.print_table(["person", "gain expected"], rows, left=1)
    click.echo(
        f"the group's button: {', '.join(f'{key} {value:.2f}' for key, value in found.design.items())}"
    )
    ui.print_wrapped(document["verdict"])


def _next_step(found: Group, playoff: Playoff | None, folder: Path, path: Path) -> str:
    report = folder / REPORT_FILE
    if playoff is None and path.exists():
        others = "everybody's own among its buttons"
        return f"have both played blind: fdvv study new timing, with {path} and {others}; {report} draws them"
    if (playoff.gain if playoff else found.gain).kind == "better":
        return f"make everybody's own; {report} draws them"
    return f"take the group's button, or ask more people; {report} draws all buttons"
