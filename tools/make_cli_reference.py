"""Write docs/reference/cli.md from the commands' own help; ``--check`` only tells whether it is stale."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import click

from fdvv.cli import cli

WIDTH = 100
PAGE = Path(__file__).parents[1] / "docs" / "reference" / "cli.md"

INTRODUCTION = """# Commands

Made from the commands' own help by `tools/make_cli_reference.py`; do not edit.

Every command that reports figures takes `--json` and then prints one JSON document on standard output and
nothing else; units are in the keys. Progress and warnings go to standard error. Exit status: 0 done; 1 it
ran but misses a bound that was set, or a device failed; 2 unusable input, with one line that names the
file, the place in it and what to do; 130 interrupted.
"""


def reference() -> str:
    """Give the page's text."""
    context = click.Context(cli, info_name="fdvv", **cli.context_settings)
    return "\n".join([INTRODUCTION, *sections(cli, context, "##")])


def sections(group: click.Group, context: click.Context, mark: str) -> Iterator[str]:
    """Give the help of every command of a group, and of the groups in it."""
    for name in group.list_commands(context):
        command = group.get_command(context, name)
        assert command is not None
        child = click.Context(command, context, name, max_content_width=WIDTH, terminal_width=WIDTH)
        yield f"{mark} {child.command_path}\n\n```\n{command.get_help(child)}\n```\n"
        if isinstance(command, click.Group):
            yield from sections(command, child, mark + "#")


if __name__ == "__main__":
    if "--check" in sys.argv:
        sys.exit(PAGE.read_text() != reference())
    PAGE.write_text(reference())
