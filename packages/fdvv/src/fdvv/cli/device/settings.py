"""fdvv device settings: what a board holds of its rig, read and written."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import asdict, replace
from pathlib import Path

import click

from fdvv.cli import ui
from fdvv.cli.options import device_option, remote
from fdvv.errors import DeviceError, InputError, did_you_mean
from fdvv.io.documents import read_toml
from fdvv.io.files import write_atomic


@click.group()
def settings() -> None:
    """Read and write calibration and limits of a board: settings get, settings set."""


@settings.command("get")
@device_option
@ui.option("-o", "--output", type=ui.PATH, help="Write them to this .toml, which settings set reads.")
@ui.json_option
def get(spec: str, output: Path | None, as_json: bool) -> None:
    """Show the settings that a board holds; docs/reference/protocol.md explains each."""
    ui.check_output(output, ".toml")
    with remote(spec) as found:
        held = asdict(found.client.read_settings())
    held.pop("spare", None)
    if output:
        write_atomic(output, "".join(f"{name} = {value}\n" for name, value in held.items()))
    if as_json:
        ui.print_json(held)
        return
    if not output:
        ui.print_table(["setting", "value"], [[name, str(value)] for name, value in held.items()])
    ui.print_written(output)


@settings.command("set")
@click.argument("values", nargs=-1, required=True, metavar="FILE.toml|NAME=VALUE...")
@device_option
def set_(values: tuple[str, ...], spec: str) -> None:
    """Write settings to a board: those of a file, or single ones as NAME=VALUE; the others stay.

    The board refuses what is out of range, and what is looser than it was built for. It forgets its program,
    and a fault whose cause the settings were is cleared, such as a supply that they did not expect.
    """
    from fdvv.protocol.tables import Fault

    asked: dict[str, int] = {}
    for value in values:
        asked |= _of_words(value) if "=" in value else _of_file(Path(value))
    with remote(spec) as found:
        held = found.client.read_settings()
        found.configure(replace(held, **asked))
        fault = found.fault()
        if fault.fault is not Fault.NONE:
            with suppress(DeviceError):  # its cause lasts
                found.clear_fault()
                click.echo(f"cleared {fault}")
        changed = {name: value for name, value in asked.items() if getattr(held, name) != value}
        name = found.info().name
    lines = ", ".join(f"{key} {getattr(held, key)} -> {value}" for key, value in changed.items())
    click.echo(f"{name}: {lines or 'nothing changed'}")


def _of_words(text: str) -> dict[str, int]:
    name, _, value = text.partition("=")
    try:
        return _checked({name.strip(): int(value)}, text)
    except ValueError:
        raise InputError(
            "VALUE", text, "is no whole number", "write NAME=VALUE, such as lead_us=900"
        ) from None


def _of_file(path: Path) -> dict[str, int]:
    if not path.is_file():
        raise InputError("FILE", str(path), "does not exist", "write a file of settings get, or NAME=VALUE")
    return _checked(read_toml(path.read_bytes(), path, "write it with fdvv device settings get"), str(path))


def _checked(values: dict[str, object], source: str) -> dict[str, int]:
    from fdvv.protocol.tables import Settings

    found = {}
    for name, value in values.items():
        if name not in Settings.LIMITS:
            remedy = did_you_mean(name, Settings.LIMITS, "fdvv device settings get shows them all")
            raise InputError(source, name, "is no setting", remedy)
        low, high = Settings.LIMITS[name]
        if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
            raise InputError(source, f"{name} = {value}", "is out of range", f"use {low} to {high}")
        found[name] = value
    return found
