"""fdvv device: list, info, selftest and monitor; upload, press, exciter and strip are beside."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fdvv.cli._device_exciter import exciter
from fdvv.cli._device_options import device_option, opened, remote
from fdvv.cli._device_press import press, upload
from fdvv.cli._device_strip import strip
from fdvv.cli._output import Finite, check_output, json_option, print_json, print_table, print_warnings

if TYPE_CHECKING:
    from fdvv.device import Remote


@click.group()
def device() -> None:
    """Work with a device: list, info, selftest, monitor, upload, press, exciter, strip.

    --device is 'host' (the firmware as a program of this machine), 'emulated' (the program of the board in an
    emulator), 'twin', 'serial:PORT' or 'replay:FILE'.
    What is simulated says so.
    """


device.add_command(upload)
device.add_command(press)
device.add_command(exciter)
device.add_command(strip)


@device.command("list")
@json_option
def list_(as_json: bool) -> None:
    """List what --device may be, serial ports among it."""
    from fdvv.device import KINDS, serial_ports
    from fdvv.errors import BuildError

    rows = [{"device": name, "about": about} for name, about in KINDS.items()]
    note = []
    try:
        rows += [{"device": f"serial:{path}", "about": about} for path, about in serial_ports()]
    except BuildError as error:
        note.append(str(error))
    if as_json:
        print_json({"devices": rows})
        return
    print_table(["device", "what it is"], [[row["device"], row["about"]] for row in rows], left=2)
    print_warnings(note)


@device.command()
@device_option
@json_option
def info(spec: str, as_json: bool) -> None:
    """Tell who a device is: limits, firmware, mode, latched fault, counters."""
    import dataclasses

    from fdvv.device import Remote

    with opened(spec) as found:
        document: dict[str, Any] = dataclasses.asdict(found.info())
        if isinstance(found, Remote):
            document |= _firmware(found)
    if as_json:
        print_json(document)
        return
    flat = {k: v for k, v in document.items() if not isinstance(v, dict)}
    flat |= document.get("counters", {})
    print_table(["what", "value"], [[k, str(v)] for k, v in flat.items()], left=2)


def _firmware(found: Remote) -> dict[str, Any]:
    import dataclasses

    from fdvv.protocol import Mode

    hello, client = found.client.hello, found.client
    version = ".".join(str(hello.firmware >> shift & 255) for shift in (16, 8, 0))
    return {
        "firmware": version,
        "protocol": f"{hello.hash:08x}",
        "serial": hello.serial,
        "mode": Mode(client.ping().mode).name.lower(),
        "fault": str(found.fault()),
        "counters": dataclasses.asdict(client.counters()),
    }


@device.command()
@device_option
@json_option
def selftest(spec: str, as_json: bool) -> None:
    """Have a device test its parts; exit status 1 if one fails."""
    import struct

    from fdvv.protocol import Part, Verdict

    with remote(spec) as found:
        reply = found.client.selftest()
        simulated = found.info().simulated
    values = struct.unpack("<8h", reply.values)
    parts = [
        {
            "part": part.name.lower(),
            "verdict": Verdict(reply.verdicts[part]).name.lower(),
            "value": values[part],
        }
        for part in Part
    ]
    if as_json:
        print_json({"parts": parts, "simulated": simulated})
    else:
        print_table(["part", "verdict", "value"], [[str(v) for v in row.values()] for row in parts], left=2)
    failed = [str(row["part"]) for row in parts if row["verdict"] == "failed"]
    if failed:
        click.echo(f"fdvv: {spec}: failed: {', '.join(failed)}", err=True)
        raise click.exceptions.Exit(1)


@device.command()
@device_option
@click.option(
    "--seconds",
    "duration_s",
    type=Finite(min=0.05, max=86400),
    default=10.0,
    show_default=True,
    help="How long, on the device's clock.",
)
@click.option("--every", type=click.IntRange(1, 255), default=1, show_default=True, help="Ticks per record.")
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    help="Write the records to this .csv or .jsonl, a line each.",
)
@json_option
def monitor(spec: str, duration_s: float, every: int, output: Path | None, as_json: bool) -> None:
    """Show what a device tells of its ticks.

    A live line on the terminal; records into a file if asked. Ticks that were not told are counted, never
    made up. Nothing is rendered that was not before.
    """
    from fdvv.cli._monitor import follow

    check_output(output, ".csv", ".jsonl")
    with remote(spec) as found:
        told = follow(found, duration_s, every, output)
    if as_json:
        print_json(told)
        return
    source = f"{told['device']}{' (simulated)' if told['simulated'] else ''}"
    click.echo(f"{source}: {told['records']} records, {told['missing_ticks']} ticks missing")
    if output:
        click.echo(f"written to {output}")
