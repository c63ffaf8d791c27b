"""Options that the commands of fdvv optimize share."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any, TypeVar

import click

Command = TypeVar("Command", bound=Callable[..., Any])


class EngineType(click.ParamType[tuple[str, dict[str, Any]]]):
    """An engine's name, with options in braces if there are any: gp, or 'tpe:{"multivariate": false}'."""

    name = "engine"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[str, dict[str, Any]]:
        """Read name and options, or refuse them."""
        if isinstance(value, tuple):
            return value
        name, _, text = str(value).partition(":")
        try:
            options = json.loads(text) if text else {}
        except ValueError as error:
            self.fail(f"the options of {name} are no JSON object ({error})", param, ctx)
        if not isinstance(options, dict):
            self.fail(f"the options of {name} are no JSON object", param, ctx)
        return name, options


def engine_option(default: str) -> Callable[[Command], Command]:
    """Add the option that chooses an engine."""
    return click.option(
        "--engine",
        type=EngineType(),
        default=default,
        show_default=True,
        help="What suggests designs (docs/explanation/optimisation.md); options follow as name:{JSON}.",
    )


level_option = click.option(
    "--level", type=click.Choice(["easy", "hard"]), default="easy", show_default=True, help="Of the task."
)
rig_option = click.option(
    "--rig",
    default="ideal",
    show_default=True,
    help="Shipped rig that renders designs; ideal does so exactly.",
)
