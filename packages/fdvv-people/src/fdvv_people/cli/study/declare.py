"""fdvv study new, check and preview: a study before it is frozen."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from fdvv.cli import ui

if TYPE_CHECKING:
    from fdvv.report.report import Section

KINDS = (
    *("realism", "abx", "2afc", "2ac", "preference", "mushra", "staircase", "thresholds"),
    *("timing", "tapping"),
)
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
    from fdvv_people.study.plan.plan_file import write_template

    ui.check_folder(folder)
    chosen = kind_named(folder, kind)
    path = write_template(chosen, folder, folder.absolute().name)
    click.echo(f"written to {path}")
    click.echo(f"its kind is {chosen}; edit it, then: fdvv study check {folder}")


def kind_named(folder: Path, kind: str | None) -> str:
    """Return the kind of a new study: as asked, or as its folder is called, or the paper's study."""
    name = folder.absolute().name
    return kind or (name if name in KINDS else DEFAULT)


@click.command()
@study_argument
@ui.json_option
def check(study: Path, as_json: bool) -> None:
    """Check a study's file, and that everything it names is there and differs. Exit status 1 if not.

    STUDY is a study.toml, or the folder of one. All that is wrong is listed at once.
    """
    from fdvv_people.study.kind import kind_of
    from fdvv_people.study.plan.plan_file import read_plan_file

    text, path = read_plan_file(study)
    kind = kind_of(path)
    plan = kind.read_plan(text, path)
    account = kind.account(plan, path.parent)
    if as_json:
        found = {"problems": account.problems, "notes": list(account.notes)}
        ui.print_json({"name": plan.name, "ok": not account.problems, **found})
    elif account.problems:
        _print_problems(plan.name, account.problems)
    else:
        for note in account.notes:
            ui.print_wrapped(f"note: {note}")
        ui.print_wrapped(f"{plan.name}: can be run; {account.text}")
    if account.problems:
        raise click.exceptions.Exit(1)


def _print_problems(name: str, problems: Sequence[str]) -> None:
    for problem in problems:
        ui.print_wrapped(f"problem: {problem}")
    click.echo(f"{name}: cannot be run, {ui.counted(len(problems), 'problem')}")


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
    from fdvv_people.study.kind import kind_of

    ui.check_output(html, ".html")
    kind_of(study).require("preview", study)
    look = review_study(study)
    if look.problems:
        _print_problems(look.plan.name, look.problems)
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
