"""What the commands of fdvv device share: options, and a device that is closed again."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from fdvv.cli._output import Finite

if TYPE_CHECKING:
    from fdvv.device import Device, Remote

Command = TypeVar("Command", bound=Callable[..., Any])


def device_option(command: Command) -> Command:
    """Add the option that chooses a device."""
    add = click.option("--device", "spec", default="host", show_default=True, help="See fdvv device.")
    return add(command)


record_option = click.option(
    "--record", "recording", type=click.Path(path_type=Path, dir_okay=False),
    help="Append the session to this file; replay it with --device replay:FILE.",
)  # fmt: skip
velocity_option = click.option(
    "--velocity", "velocities_mm_s", type=Finite(min=5, max=500), multiple=True,
    default=(50.0, 100.0, 150.0, 200.0), show_default=True, help="Rows of a model's table, mm/s; repeatable.",
)  # fmt: skip


@contextmanager
def opened(
    spec: str, recording: Path | None = None, rig: Path | None = None, seed: int = 0
) -> Iterator[Device]:
    """Open a device and close it again, whatever happens; rig and seed are of a simulated one."""
    from fdvv.device import Recorder
    from fdvv.workflow import open_device

    found = open_device(spec, rig, None, seed)
    try:
        found = Recorder(found, recording) if recording else found
        yield found
    finally:
        if hasattr(found, "close"):
            found.close()


@contextmanager
def remote(spec: str) -> Iterator[Remote]:
    """Open a device that has the firmware in it; InputError if it has not."""
    from fdvv.device import Remote
    from fdvv.errors import InputError

    with opened(spec) as found:
        if not isinstance(found, Remote):
            raise InputError("--device", spec, "there is no firmware in it", "use host or serial:PORT")
        yield found
