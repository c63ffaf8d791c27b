"""fdvv study: the group; its commands are imported when they are run."""

from __future__ import annotations

import click

from fdvv.cli import ui

MODULES = {
    "declare": ("new", "check", "preview"),
    "keep": ("freeze", "verify", "status", "unseal", "withdraw"),
    "simulate": ("power", "simulate"),
    "analyse": ("analyse", "export", "jnds"),
}
"""Commands by the module below fdvv_people.cli.study that holds them."""
COMMANDS = {name: f"fdvv_people.cli.study.{module}" for module, names in MODULES.items() for name in names}


class StudyGroup(ui.LazyGroup):
    """Lists its commands in the order in which a study needs them."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(self.modules)


@click.group(cls=StudyGroup, modules=COMMANDS)
def study() -> None:
    """Compare buttons blind, with people, and analyse what they said.

    A study is declared in a file, checked and previewed, frozen before the first person, run in fdvv studio,
    unsealed when the last one is done, and analysed. Simulated participants test all of it before.
    """
