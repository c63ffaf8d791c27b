"""fdvv check."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fdvv.cli._output import (
    counted,
    json_option,
    number,
    one_line,
    print_json,
    print_table,
    print_wrapped,
)

if TYPE_CHECKING:
    from fdvv.recording import FileCheck

LISTED = 10
"""Of the problems of a file."""


@click.command()
@click.argument("files", nargs=-1, required=True, metavar="FILE...")
@json_option
def check(files: tuple[str, ...], as_json: bool) -> None:
    """Check files: what each is, whether it is whole, and what it holds.

    FILE is anything that fdvv writes: a model, a program or its image, a rig, an actuation, the folder of a
    session, a recording of a device or of a bench. A log that fdvv reads is told of as well. Exit status: 0
    all are whole; 1 all can be read, but there are problems; 2 one cannot be used.
    """
    from fdvv.errors import InputError
    from fdvv.recording import unusable
    from fdvv.workflow import check_file

    found = []
    for file in files:
        try:
            found.append(check_file(Path(file)))
        except InputError as error:
            found.append(unusable(Path(file), "a file", error))
    if as_json:
        print_json({"files": [one.to_dict() for one in found]})
    else:
        for one in found:
            if one.usable:
                _print(one)
    for one in found:
        if not one.usable:
            click.echo(f"fdvv: {one_line(f'{one.path}: {one.problems[0]}')}", err=True)
    raise click.exceptions.Exit(max(one.status for one in found))


def _print(one: FileCheck) -> None:
    """Print the verdict in a line, and below it what was found."""
    told = "whole" if not one.problems else f"can be read, with {counted(len(one.problems), 'problem')}"
    print_wrapped(f"{one.path}: {one.kind}, {told}")
    for problem in one.problems[:LISTED]:
        print_wrapped(f"  problem: {problem}")
    if len(one.problems) > LISTED:
        click.echo(f"  and {len(one.problems) - LISTED} more")
    facts = dict(one.facts)
    streams = facts.pop("streams", [])
    facts["bench"] = {name: value for name, value in facts.get("bench", {}).items() if value}
    plain = ", ".join(f"{name} {_short(value)}" for name, value in facts.items() if _told(value))
    print_wrapped(f"  {plain}")
    if streams:
        print_table(
            ["stream", "quantity", "clock", "kind", "samples", "rate Hz", "gaps %", "step s"],
            [_row(stream) for stream in streams],
            left=4,
        )
    for note in one.notes:
        print_wrapped(f"  note: {note}")


def _row(stream: dict[str, Any]) -> list[str]:
    return [
        stream["name"],
        f"{stream['quantity']}, {stream['unit']}",
        stream["clock"],
        stream["kind"] if stream["axes"] == 1 else f"{stream['axes']} {stream['kind']}",
        str(stream["samples"]),
        number(stream["rate_Hz"], 1),
        number(stream["gaps_percent"], 1),
        number(stream["longest_step_s"], 4),
    ]


def _told(value: Any) -> bool:
    """Tell whether a fact says anything to a person."""
    return value is not None and value != "" and value != [] and value != {}


def _short(value: Any) -> str:
    """Write a fact in a few words; lists of records by their number."""
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
