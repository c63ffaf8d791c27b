"""A person, or a script, plays a run on an LED strip; what fdvv optimize run and resume share."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, TypeVar

import click

from fdvv.cli._device_options import remote

if TYPE_CHECKING:
    from fdvv.optimize import Trial
    from fdvv.workflow import OptimizeSession

Command = TypeVar("Command", bound=Callable[..., Any])


def strip_options(command: Command) -> Command:
    """Add the options that choose strip and rig."""
    strip = click.option(
        "--strip", metavar="DEVICE",
        help="A person plays on the LED strip at serial:PORT; host: a simulated one.",
    )  # fmt: skip
    device = click.option(
        "--device", default="host", show_default=True, help="With --strip: the rig that renders designs."
    )
    return strip(device(command))


Play = Callable[["OptimizeSession"], "Iterator[Trial]"]


@contextmanager
def on_strip(strip: str | None, device: str) -> Iterator[Play | None]:
    """Open strip and rig before a run is begun; give what plays it there, None where no strip is asked for.

    InputError, DeviceError.
    """
    if strip is None:
        yield None
        return
    from fdvv.device import open_strip
    from fdvv.workflow import run_on_any_strip

    with remote(device) as rig, open_strip(strip) as task:
        yield lambda session: run_on_any_strip(session, rig, task, _wait)


def _wait(trial: Trial) -> None:
    """Wait until the person is there."""
    click.prompt(f"trial {trial.number}: press Enter when ready", default="", show_default=False, err=True)
