"""fdvv check."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fdvv.cli import ui
from fdvv.errors import InputError

if TYPE_CHECKING:
    from fdvv.recording.check import FileCheck

EMPTY: tuple[Any, ...] = (None, "", [], {})
"""Facts that tell nothing; 0 and no do."""
LISTED = 10
"""Of the problems of a file."""


@click.command()
@click.argument("files", nargs=-1, required=True, metavar="FILE...")
@ui.rate_option
@ui.json_option
def check(files: tuple[str, ...], rate_Hz: float | None, as_json: bool) -> None:
    """Check files: what each is, whether it is whole, and what it holds.

    FILE is anything that fdvv writes: a model, a program or its image, a rig, an actuation, the folder of a
    session, a recording of a device or of a bench, trials of an optimisation, the log of a study. Logs and
    force curves that fdvv reads are checked as well. Exit status: 0 all are whole; 1 all can be read, but
    there are problems; 2 one cannot be used.
    """
    from fdvv.cli.check_file import check_file
    from fdvv.recording.check import unusable

    found = []
    for file in files:
        try:
            found.append(check_file(Path(file), rate_Hz))
        except InputError as error:
            found.append(unusable(Path(file), "a file", error))
    if as_json:
        ui.print_json({"files": [one.to_dict() for one in found]})
    else:
        for one in found:
            if one.usable:
                _print(one)
    for one in found:
        if not one.usable:
            ui.print_stderr(f"fdvv: {ui.one_line(f'{one.path}: {one.problems[0]}')}")
    raise click.exceptions.Exit(max(one.status for one in found))


def _print(one: FileCheck) -> None:
    verdict = "whole" if not one.problems else f"can be read, with {ui.counted(len(one.problems), 'problem')}"
    ui.print_wrapped(f"{one.path}: {one.kind}, {verdict}")
    for problem in one.problems[:LISTED]:
        ui.print_wrapped(f"  problem: {problem}")
    if len(one.problems) > LISTED:
        click.echo(f"  and {len(one.problems) - LISTED} more")
    facts = dict(one.facts)
    streams = facts.pop("streams", [])
    facts["bench"] = {name: value for name, value in facts.get("bench", {}).items() if value}
    plain = ", ".join(f"{name} {_short(value)}" for name, value in facts.items() if value not in EMPTY)
    ui.print_wrapped(f"  {plain}")
    if streams:
        ui.print_table(
            ["stream", "quantity", "clock", "kind", "samples", "rate Hz", "gaps %", "step s"],
            [_row(stream) for stream in streams],
            left=4,
        )
    for note in one.notes:
        ui.print_wrapped(f"  note: {note}")


def _row(stream: dict[str, Any]) -> list[Any]:
    return [
        stream["name"],
        f"{stream['quantity']}, {stream['unit']}",
        stream["clock"],
        stream["kind"] if stream["axes"] == 1 else f"{stream['axes']} {stream['kind']}",
        stream["samples"],
        ui.number(stream["rate_Hz"], 1),
        ui.number(stream["gaps_percent"], 1),
        ui.number(stream["longest_step_s"], 4),
    ]


def _short(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:g}"
    if isinstance(value, dict):
        return "(" + ", ".join(f"{name} {_short(inner)}" for name, inner in value.items()) + ")"
    if isinstance(value, list):
        records = value and isinstance(value[0], dict)
        return str(len(value)) if records else "/".join(_short(inner) for inner in value)
    return str(value)
