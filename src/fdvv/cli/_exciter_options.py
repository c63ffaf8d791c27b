"""The option that names a known exciter."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from fdvv.vibration import KnownExciter

exciter_option = click.option(
    "--exciter", type=click.Path(path_type=Path, exists=True, dir_okay=False),
    help="What fdvv device exciter wrote: vibrations are played through its inverse.",
)  # fmt: skip


def opened_exciter(path: Path | None) -> KnownExciter | None:
    """Read the file of a known exciter, if one is named. Raises InputError."""
    from fdvv.vibration import load_exciter

    return load_exciter(path) if path else None
