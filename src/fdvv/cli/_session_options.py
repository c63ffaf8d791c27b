"""What fdvv compensate and probe share: the device, the speeds, and the session that presses are kept in."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from fdvv.cli._output import Finite, check_folder
from fdvv.cli._session_view import View, session_view

if TYPE_CHECKING:
    from fdvv.device import Device
    from fdvv.workflow import Guide, Session

Command = TypeVar("Command", bound=Callable[..., Any])


def session_options(command: Command) -> Command:
    """Add the options that choose a device, the speeds, and where the presses are kept."""
    path = click.Path(path_type=Path, exists=True, dir_okay=False)
    options = (
        click.option("--device", default="twin", show_default=True,
                     help="'twin' is simulated; see fdvv device."),
        click.option("--rig", type=path, help="TOML file of the twin's rig (docs/reference/rig.md)."),
        click.option("--finger", type=path, help="TOML file of the twin's finger."),
        click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True,
                     help="Repeats the twin."),
        click.option("--velocity", "velocities_mm_s", type=Finite(min=5, max=500), multiple=True,
                     default=(50.0, 100.0, 150.0, 200.0), show_default=True, help="mm/s; repeatable."),
        click.option("--session", "folder", type=click.Path(path_type=Path),
                     help="Folder that keeps every press; name it again to go on where it stopped. Those of "
                          "a person are always kept, beside the result if no folder is named."),
        click.option("--pace-tolerance", "pace_ratio", type=Finite(min=0.05, max=1), default=0.35,
                     show_default=True, help="Part by which a press may miss its speed and still be used."),
    )  # fmt: skip
    for option in reversed(options):
        command = option(command)
    return command


def open_session(
    folder: Path | None,
    device: str,
    parts: tuple[int, Path | None, Path | None],
    pace_ratio: float,
    default: Path,
) -> Session:
    """Choose where presses are kept. Raises InputError where that cannot be.

    parts : seed, rig and finger of a simulated device; default : the folder for a person's presses.
    """
    from fdvv.compensate import Acceptance
    from fdvv.device import pressed_by_person
    from fdvv.workflow import Session

    if folder is None and pressed_by_person(device):
        folder = default
    if folder:
        check_folder(folder)
    seed, rig, finger = parts
    return Session(folder, seed, rig, finger, Acceptance(pace_ratio=pace_ratio))


@contextmanager
def guided(session: Session, device: str, as_json: bool) -> Iterator[tuple[Device, View, Guide]]:
    """Open the device, show the session, and let the device go at the end, whatever happens."""
    from fdvv.device import pressed_by_person
    from fdvv.workflow import Guide

    found = session.open_device(device)
    try:
        with session_view(pressed_by_person(device), as_json) as view:
            yield found, view, Guide(view.ask, view.notice)
    finally:
        if hasattr(found, "close"):
            found.close()


def beside(result: Path | None, button: str, what: str) -> Path:
    """Name the folder for the presses behind a result: beside its file, else here after the button."""
    name = (result or Path(Path(button).name)).name.partition(".")[0] or "button"
    return (result.parent if result else Path()) / f"{name}.{what}"
