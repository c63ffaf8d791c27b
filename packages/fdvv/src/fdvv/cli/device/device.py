"""fdvv device: list, info, selftest and monitor; upload, press and exciter are beside; strip is an extra."""

from __future__ import annotations

import json
from collections.abc import Callable
from contextlib import nullcontext
from dataclasses import asdict, fields
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import click

from fdvv import extras
from fdvv.cli import ui
from fdvv.cli.options import device_option, opened, remote
from fdvv.device.serial import serial_ports
from fdvv.errors import BuildError
from fdvv.force_text import ForceTitle, force_name, force_number, force_text

if TYPE_CHECKING:
    from rich.text import Text

    from fdvv.device.client import Client
    from fdvv.device.remote import Remote
    from fdvv.device.telemetry import TickColumns


def follow(device: Remote, duration_s: float, every: int, output: Path | None) -> dict[str, Any]:
    """Watch a device, show and write what it tells; give the counts. DeviceError if it goes away."""
    from fdvv.device.remote import watch

    records = 0
    telemetry, info = device.client.telemetry, device.info()
    target = output.open("w", encoding="ascii") if output else nullcontext()
    with target as stream, ui.live(per_s=20) as shown:
        write = writer(stream, output) if output and stream else None
        for columns in watch(device, duration_s, every):
            records += columns.tick.size
            if write:
                write(columns)
            if shown and columns.tick.size:
                shown.update(line_of(columns, telemetry.missing_ticks))
    lost = ("missing_ticks", "missing_frames", "lost_records", "late_ticks")
    return {
        "device": info.name,
        "simulated": info.simulated,
        "records": records,
        **{name: getattr(telemetry, name) for name in lost},
    }


def line_of(columns: TickColumns, missing: int) -> Text:
    """Write the newest tick for a terminal."""
    from rich.text import Text

    return Text(
        f"tick {columns.tick[-1]}  {columns.displacement_mm[-1]:7.3f} mm  "
        f"{columns.velocity_mm_s[-1]:7.1f} mm/s  {force_text(columns.commanded_cN[-1], '7.1f')}  "
        f"state {columns.state[-1]}  missing {missing}"
    )


def writer(stream: IO[str], output: Path) -> Callable[[TickColumns], None]:
    """Return a function that writes ticks to an open file, as CSV or as a JSON document per line."""
    from fdvv.device.telemetry import TickColumns

    names = [field.name for field in fields(TickColumns)]
    as_json = output.suffix.lower() == ".jsonl"
    if not as_json:
        stream.write(",".join(names) + "\n")

    def write(columns: TickColumns) -> None:
        lists = (getattr(columns, name).tolist() for name in names)
        for row in zip(*lists, strict=True):
            line = json.dumps(dict(zip(names, row, strict=True))) if as_json else ",".join(map(str, row))
            stream.write(line + "\n")

    return write


MODULES = {
    **dict.fromkeys(("exciter", "press", "upload"), "fdvv.cli.device.press"),
    **dict.fromkeys(("new", "serve", "conform"), "fdvv.cli.device.own"),
    "settings": "fdvv.cli.device.settings",
}


@click.group(cls=ui.LazyGroup, modules=MODULES, extra="device_commands")
def device() -> None:
    """Work with a device: look at it, press it, set it, check it, or make one of your own.

    --device is 'host' (the firmware as a program of this machine), 'emulated' (the program of the board in an
    emulator), 'twin', 'serial:PORT', 'replay:FILE', a motor drive (moteus, odrive, simplefoc) with its stage
    file, or a simulated rig of your own. What is simulated says so.
    """


@device.command("list")
@ui.json_option
def list_(as_json: bool) -> None:
    """List what --device may be, serial ports among it."""
    from fdvv.device.open import KINDS

    rows = [{"device": name, "about": about} for name, about in KINDS.items()]
    rows += [{"device": name, "about": "a rig of your own, simulated"} for name in extras.names("rigs")]
    note = []
    try:
        rows += [{"device": f"serial:{path}", "about": about} for path, about in serial_ports()]
    except BuildError as error:
        note.append(str(error))
    if as_json:
        ui.print_json({"devices": rows})
        return
    ui.print_table(["device", "what it is"], [list(row.values()) for row in rows], left=2)
    ui.print_warnings(note)


@device.command()
@device_option
@ui.json_option
def info(spec: str, as_json: bool) -> None:
    """Show what a device is: limits, firmware, mode, latched fault, counters."""
    from fdvv.device.lacking import lacking
    from fdvv.device.remote import Remote

    with opened(spec) as found:
        document: dict[str, Any] = asdict(found.info())
        if isinstance(found, Remote):
            document |= _firmware(found)
        document["lacks"] = list(lacking(found))
    if as_json:
        ui.print_json(document)
        return
    flat = {k: v for k, v in document.items() if v is not None and not isinstance(v, dict)}
    flat |= document.get("load_cell") or {}
    flat |= document.get("counters", {})
    lacks = flat.pop("lacks")
    ui.print_table(["what", "value"], [_fact(*one) for one in flat.items()], left=2)
    for line in lacks:
        ui.print_wrapped(line)


def _fact(name: str, value: Any) -> list[object]:
    title = force_name(name)
    return [title, force_number(value) if isinstance(title, ForceTitle) else str(value)]


def _firmware(found: Remote) -> dict[str, Any]:
    from fdvv.protocol.tables import Mode

    hello, client = found.client.hello, found.client
    version = ".".join(str(hello.firmware >> shift & 255) for shift in (16, 8, 0))
    return {
        "firmware": version,
        "protocol": f"{hello.hash:08x}",
        "serial": hello.serial,
        "mode": Mode(client.ping().mode).name.lower(),
        "fault": str(found.fault()),
        **_coil(client),
        "force_loop": found.force_loop.state(),
        "load_cell": asdict(found.load_cell) if found.load_cell else None,
        "counters": asdict(client.counters()),
    }


def _coil(client: Client) -> dict[str, Any]:
    """Return the most that the coil may have warmed, and what its thermistor says, None without one."""
    coil = client.read_coil()
    return {"coil_K": coil.heat_K, "thermistor_K": None if coil.thermistor_K == 65535 else coil.thermistor_K}


@device.command()
@device_option
@ui.json_option
def selftest(spec: str, as_json: bool) -> None:
    """Have a device test its parts; exit status 1 if one fails."""
    import struct

    from fdvv.protocol.tables import Part, SelfTestResult

    with remote(spec) as found:
        reply = found.client.selftest()
        simulated = found.info().simulated
    values = struct.unpack("<8h", reply.values)
    parts = [
        {
            "part": part.name.lower(),
            "verdict": SelfTestResult(reply.verdicts[part]).name.lower(),
            "value": values[part],
        }
        for part in Part
    ]
    if as_json:
        ui.print_json({"parts": parts, "simulated": simulated})
    else:
        ui.print_table(["part", "verdict", "value"], [list(row.values()) for row in parts], left=2)
    failed = [str(row["part"]) for row in parts if row["verdict"] == "failed"]
    if failed:
        raise ui.failed(f"{spec}: failed: {', '.join(failed)}")


@device.command()
@device_option
def clear(spec: str) -> None:
    """Clear the latched fault of a device, once its cause is gone; say what it was."""
    from fdvv.protocol.tables import Fault

    with remote(spec) as found:
        report = found.fault()
        if report.fault is not Fault.NONE:
            found.clear_fault()
        click.echo(f"{spec}: {'cleared ' if report.fault is not Fault.NONE else ''}{report}")


@device.command()
@device_option
@ui.option(
    "--seconds",
    "duration_s",
    type=ui.Finite(min=0.05, max=86400),
    default=10.0,
    help="By the device's clock.",
)
@ui.option("--every", type=click.IntRange(1, 255), default=1, help="Ticks per record.")
@ui.option("-o", "--output", type=ui.PATH, help="Write the records to this .csv or .jsonl, a line each.")
@ui.json_option
def monitor(spec: str, duration_s: float, every: int, output: Path | None, as_json: bool) -> None:
    """Show what a device tells of its ticks.

    A live line on the terminal; records into a file if asked. Ticks that did not arrive are counted, never
    made up. Nothing is rendered that was not before.
    """
    ui.check_output(output, ".csv", ".jsonl")
    with remote(spec) as found:
        summary = follow(found, duration_s, every, output)
    if as_json:
        ui.print_json(summary)
        return
    source = f"{summary['device']}{ui.simulated(summary['simulated'])}"
    click.echo(f"{source}: {summary['records']} records, {summary['missing_ticks']} ticks missing")
    ui.print_written(output)
