"""fdvv study new, check and preview: a study before it is frozen."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from fdvv.cli import ui
from fdvv.errors import InputError

if TYPE_CHECKING:
    from fdvv.report.report import Section
    from fdvv_people.study.admin.review import StudyReview

TIMING = ("timing", "tapping")
KINDS = ("realism", "abx", "2afc", "2ac", "preference", "mushra", "staircase", "thresholds", *TIMING)
DEFAULT = "realism"

study_argument = click.argument("study", type=ui.PATH)


@click.command()
@click.argument("folder", type=ui.PATH)
@ui.option(
    "--kind",
    type=click.Choice(KINDS),
    help="What people do; by default as the folder is called where that is a kind, else realism, the paper's "
    "study of what is rendered. timing is the paper's experiment with optimised buttons.",
)
def new(folder: Path, kind: str | None) -> None:
    """Begin a study: a folder with a commented study.toml to edit, and the buttons it names.

    The study is called as the folder. It holds the paper's design, or a usual one of its kind; what every
    field means is in docs/reference/study-file.md. Nothing counts before fdvv study freeze.
    """
    ui.check_folder(folder)
    chosen = kind_named(folder, kind)
    path = write_kind(chosen, folder)
    click.echo(f"written to {path}")
    click.echo(f"its kind is {chosen}; edit it, then: fdvv study check {folder}")


def kind_named(folder: Path, kind: str | None) -> str:
    """Return the kind of a new study: as asked, or as its folder is called, or the paper's study."""
    name = folder.absolute().name
    return kind or (name if name in KINDS else DEFAULT)


def write_kind(kind: str, folder: Path) -> Path:
    """Write a shipped study of a kind, called as its folder; return its file. InputError, OSError."""
    from fdvv_people.study.plan.plan_file import write_template
    from fdvv_people.timing.plan.plan_file import timing_template

    write = timing_template if kind in TIMING else write_template
    return write(kind, folder, folder.absolute().name)


def refuse_timing(study: Path, command: str, instead: str) -> None:
    """Refuse a command that timing studies have no use for. InputError."""
    from fdvv_people.timing.plan.plan_file import is_timing

    if is_timing(study):
        raise InputError(study, command, "is for studies that ask about what is rendered", instead)


@click.command()
@study_argument
@ui.json_option
def check(study: Path, as_json: bool) -> None:
    """Check a study's file, and that everything it names is there and differs. Exit status 1 if not.

    STUDY is a study.toml, or the folder of one. All that is wrong is listed at once.
    """
    from fdvv_people.cli.study.timing import check_timing
    from fdvv_people.study.admin.preview import summarise_plan
    from fdvv_people.study.admin.review import review_study
    from fdvv_people.timing.plan.plan_file import is_timing

    if is_timing(study):
        check_timing(study, as_json)
        return
    look = review_study(study)
    if as_json:
        notes = {"notes": [*look.notes, *(() if look.problems else summarise_plan(look.plan).notes)]}
        ui.print_json({"name": look.plan.name, "ok": not look.problems, "problems": look.problems, **notes})
    else:
        _print_check(look)
    if look.problems:
        raise click.exceptions.Exit(1)


def _print_check(look: StudyReview) -> None:
    from fdvv_people.study.admin.preview import summarise_plan

    _print_problems(look)
    if look.problems:
        return
    account = summarise_plan(look.plan)
    for note in (*look.notes, *account.notes):
        ui.print_wrapped(f"note: {note}")
    trials = ui.counted(account.trials, "trial")
    click.echo(
        f"{look.plan.name}: can be run; {trials} a person, about {account.minutes:.0f} minutes (assumed), "
        f"{look.plan.people} people"
    )


def _print_problems(look: StudyReview) -> None:
    for problem in look.problems:
        ui.print_wrapped(f"problem: {problem}")
    if look.problems:
        click.echo(f"{look.plan.name}: cannot be run, {ui.counted(len(look.problems), 'problem')}")


@click.command()
@study_argument
@ui.option("--html", type=ui.NEW_FILE, metavar="OUT.html", help="Write the account as a page.")
@ui.json_option
def preview(study: Path, html: Path | None, as_json: bool) -> None:
    """Show what a study will be: what a person does, what is asked, orders, rules and claim.

    STUDY is a study.toml, or the folder of one. Nothing is drawn: what labels will hide, not even this knows.
    Exit status 1 where the study cannot be run.
    """
    from fdvv.report.report import write_report
    from fdvv_people.study.admin.preview import (
        preview_dict,
        preview_html,
        preview_sections,
        preview_summary,
        preview_title,
    )
    from fdvv_people.study.admin.review import review_study

    ui.check_output(html, ".html")
    refuse_timing(study, "preview", "see what it comes to: fdvv study check")
    look = review_study(study)
    if look.problems:
        _print_problems(look)
        raise click.exceptions.Exit(1)
    if html:
        write_report(html, preview_html(look))
    if as_json:
        ui.print_json(preview_dict(look))
        return
    ui.print_wrapped(preview_title(look.plan))
    ui.print_wrapped(preview_summary(look.plan))
    for section in preview_sections(look):
        _print_section(section)
    if html:
        click.echo(f"\nwritten to {html}")


def _print_section(section: Section) -> None:
    click.echo(f"\n{section.title}")
    for text in section.paragraphs:
        ui.print_wrapped(text)
    for table in section.tables:
        ui.print_table(table.columns, table.rows, left=len(table.columns))
        ui.print_wrapped(table.caption)
