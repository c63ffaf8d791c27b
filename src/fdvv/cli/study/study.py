"""fdvv study: the group; its commands are imported when they are run."""

from __future__ import annotations

import importlib

import click

MODULES = {
    "declare": ("new", "check", "preview"),
    "keep": ("freeze", "verify", "status", "unseal", "withdraw"),
    "simulate": ("power", "simulate"),
    "analyse": ("analyse", "export"),
}
"""Commands by the module below fdvv.cli.study that holds them, as functions of the command's name."""
COMMANDS = {name: module for module, names in MODULES.items() for name in names}


class StudyGroup(click.Group):
    """A group that imports a command when it is asked for."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the names of the commands."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Import and give one command."""
        if cmd_name not in COMMANDS:
            return None
        found = getattr(importlib.import_module(f"fdvv.cli.study.{COMMANDS[cmd_name]}"), cmd_name)
        assert isinstance(found, click.Command)
        return found


@click.group(cls=StudyGroup)
def study() -> None:
    """Compare buttons blind, with people, and analyse what they said.

    A study is declared in a file, checked and previewed, frozen before the first person, run in fdvv studio,
    unsealed when the last one is done, and analysed. Simulated participants test all of it before.
    """
