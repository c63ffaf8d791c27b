"""fdvv device: list, info, selftest, monitor, upload and press."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from fdvv.cli._output import (
    Finite,
    check_output,
    json_option,
    number,
    print_json,
    print_table,
    print_warnings,
)

if TYPE_CHECKING:
    from fdvv.device import Device, Remote

Command = TypeVar("Command", bound=Callable[..., Any])


@click.group()
def device() -> None:
    """Work with a device: list, info, selftest, monitor, upload, press.

    --device is 'host' (the firmware as a program of this machine), 'twin', 'serial:PORT' or 'replay:FILE'.
    What is simulated says so.
    """


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
def opened(spec: str, recording: Path | None = None) -> Iterator[Device]:
    """Open a device and close it again, whatever happens."""
    from fdvv.device import Recorder
    from fdvv.workflow import open_device

    found = open_device(spec)
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
@click.argument("button")
@device_option
@velocity_option
@record_option
@json_option
def upload(
    button: str, spec: str, velocities_mm_s: tuple[float, ...], recording: Path | None, as_json: bool
) -> None:
    """Make BUTTON the program of a device: a program image, a built-in, a *.fdvv.json or a measured file.

    A model is rendered by its own force, not compensated for the rig.
    """
    from fdvv.protocol import ImageHeader
    from fdvv.workflow import program_image

    image = program_image(button, velocities_mm_s)
    with opened(spec, recording) as found:
        _programs(found, spec).upload_program(image)
        name = found.info().name
    head = ImageHeader.unpack(image[: ImageHeader.length_bytes()])
    travel_mm = head.travel_um16 / 16000
    document = {"device": name, "bytes": len(image), "states": head.states, "travel_mm": travel_mm}
    if as_json:
        print_json(document)
        return
    click.echo(f"{name}: {len(image)} bytes, checked and active, travel {travel_mm:.3f} mm")


def _programs(found: Any, spec: str) -> Any:
    from fdvv.errors import InputError

    if not hasattr(found, "upload_program"):
        raise InputError("--device", spec, "it runs tables of force only", "use host or serial:PORT")
    return found


@device.command()
@click.argument("button")
@device_option
@velocity_option
@click.option(
    "--speed",
    "speed_mm_s",
    type=Finite(min=5, max=500),
    default=100.0,
    show_default=True,
    help="Of the presses, mm/s.",
)
@click.option("--presses", type=click.IntRange(1, 1000), default=3, show_default=True, help="How many.")
@record_option
@json_option
def press(
    button: str,
    spec: str,
    velocities_mm_s: tuple[float, ...],
    speed_mm_s: float,
    presses: int,
    recording: Path | None,
    as_json: bool,
) -> None:
    """Upload BUTTON and have it pressed.

    On a simulated device the presses are simulated; on a serial one a person presses. Ctrl-C stops the
    device and keeps what was recorded.
    """
    from fdvv.workflow import program_image

    image = program_image(button, velocities_mm_s)
    rows = []
    with opened(spec, recording) as found:
        _programs(found, spec).upload_program(image)
        info = found.info()
        for count in range(presses):
            if not info.simulated:
                click.echo(f"press {count + 1} of {presses}: press fully and let go", err=True)
            rows.append(_summary(found.press(speed_mm_s)))
    if as_json:
        print_json({"device": info.name, "simulated": info.simulated, "presses": rows})
        return
    click.echo(f"{info.name}{' (simulated)' if info.simulated else ''}, asked at {speed_mm_s:g} mm/s")
    print_table(
        ["press", "duration s", "deepest mm", "largest cN", "ticks"],
        [[str(i + 1), *(number(float(v), 3) for v in list(row.values())[:3]), str(row["ticks"])]
         for i, row in enumerate(rows)],
    )  # fmt: skip


def _summary(found: Any) -> dict[str, Any]:
    return {
        "duration_s": float(found.t_s[-1] - found.t_s[0]),
        "deepest_mm": float(found.displacement_mm.max()),
        "largest_cN": float(found.force_cN.max()),
        "ticks": int(found.tick.sum()),
    }


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
