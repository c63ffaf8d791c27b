"""Write docs/reference/cli.md from the commands' own help; ``--check`` only tells whether it is stale."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from fdvv.cli import cli

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
    parts = [INTRODUCTION]
    for name in cli.list_commands(context):
        command = cli.get_command(context, name)
        assert command is not None
        size = 100
        child = click.Context(command, context, name, max_content_width=size, terminal_width=size)
        parts.append(f"## fdvv {name}\n\n```\n{command.get_help(child)}\n```\n")
    return "\n".join(parts)


if __name__ == "__main__":
    if "--check" in sys.argv:
        sys.exit(PAGE.read_text() != reference())
    PAGE.write_text(reference())
