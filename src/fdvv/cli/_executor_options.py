"""The options of commands that share their work out over processes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeVar

import click

Command = TypeVar("Command", bound=Callable[..., Any])


def executor_options(command: Command) -> Command:
    """Add the options that choose who works."""
    options = (
        click.option("--processes", type=click.IntRange(1, 1024),
                     help="Of this machine; by default as many as it has."),
        click.option("--workers", type=click.IntRange(1, 1024), help="Start so many dask workers instead."),
        click.option("--cluster", metavar="ADDRESS", help="Use the dask cluster of this scheduler instead."),
    )  # fmt: skip
    for option in reversed(options):
        command = option(command)
    return command


def check_executor(processes: int | None, workers: int | None, cluster: str | None) -> None:
    """Refuse two of the options at once."""
    if sum(choice is not None for choice in (processes, workers, cluster)) > 1:
        raise click.UsageError("--processes, --workers and --cluster exclude each other")


@contextmanager
def kept_on_interrupt(folder: Path) -> Iterator[None]:
    """Say what Ctrl-C leaves."""
    try:
        yield
    except KeyboardInterrupt:
        raise KeyboardInterrupt(
            f"interrupted; what is done is kept in {folder}, the same command goes on"
        ) from None
