"""The options of fdvv compensate that choose how it learns."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

if TYPE_CHECKING:
    from fdvv.compensate import PaperLaw, RigAware

Command = TypeVar("Command", bound=Callable[..., Any])
RIG_AWARE, PAPER = "rig-aware", "paper"
ROUNDS = {RIG_AWARE: 3, PAPER: 4}
PRESSES = 12


def method_options(command: Command) -> Command:
    """Add the options that choose the method."""
    options = (
        click.option("--method", type=click.Choice(list(ROUNDS)), default=RIG_AWARE, show_default=True,
                     help="How to learn."),
        click.option("--rounds", type=click.IntRange(0, 20),
                     help=f"Presses per velocity once the rig is known, {ROUNDS[RIG_AWARE]} by default; "
                          f"with the paper's law runs averaged, {ROUNDS[PAPER]}."),
        click.option("--presses", type=click.IntRange(1, 100),
                     help=f"With the paper's law, per round and velocity; {PRESSES} by default."),
        click.option("--literal", is_flag=True, help="The paper's law exactly as printed."),
        click.option("--rig-known", type=click.Path(path_type=Path, exists=True, dir_okay=False),
                     help="The *.rig.json of what this rig has taught before."),
        click.option("--save-rig", type=click.Path(path_type=Path),
                     help="The *.rig.json to write of what the rig has taught."),
    )  # fmt: skip
    for option in reversed(options):
        command = option(command)
    return command


def law_of(
    method: str,
    rounds: int | None,
    presses: int | None,
    literal: bool,
    rig_known: Path | None,
    save_rig: Path | None,
) -> PaperLaw | RigAware:
    """Make the method that was asked for. InputError on an option of the other one, or on a file."""
    from fdvv.compensate import PaperLaw, RigAware, load_memory

    rounds = ROUNDS[method] if rounds is None else rounds
    if method == RIG_AWARE:
        _refuse({"--presses": presses, "--literal": literal}, PAPER)
        return RigAware(rounds, load_memory(rig_known) if rig_known else None)
    _refuse({"--rig-known": rig_known, "--save-rig": save_rig, "--rounds 0": rounds == 0}, RIG_AWARE)
    make = PaperLaw.literal if literal else PaperLaw
    return make(rounds=rounds, presses_per_round=presses or PRESSES)


def _refuse(options: dict[str, object], other: str) -> None:
    """Refuse the options that are given here but belong to the other method."""
    from fdvv.errors import InputError

    for name, value in options.items():
        if value:
            reason = f"belongs to the method {other}"
            raise InputError(name, "option", reason, f"add --method {other}, or leave {name} out")
