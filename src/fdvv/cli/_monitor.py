"""Telemetry as a live line and as lines of a file."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from dataclasses import fields
from pathlib import Path
from typing import IO, Any

from fdvv.device import Remote, TickColumns, watch


def follow(device: Remote, duration_s: float, every: int, output: Path | None) -> dict[str, Any]:
    """Watch a device, show and write what it tells; give the counts. DeviceError if it goes away."""
    records = 0
    telemetry, info = device.client.telemetry, device.info()
    target = output.open("w", encoding="ascii") if output else nullcontext()
    with target as stream, live_line() as show:
        write = writer(stream, output) if output and stream else None
        for told in watch(device, duration_s, every):
            records += told.tick.size
            if write:
                write(told)
            if told.tick.size:
                show(line_of(told, telemetry.missing_ticks))
    return {
        "device": info.name,
        "simulated": info.simulated,
        "records": records,
        "missing_ticks": telemetry.missing_ticks,
        "missing_frames": telemetry.missing_frames,
        "lost_records": telemetry.lost_records,
        "late_ticks": telemetry.late_ticks,
    }


def line_of(told: TickColumns, missing: int) -> str:
    """Tell the newest tick in a line."""
    return (
        f"tick {told.tick[-1]}  {told.displacement_mm[-1]:7.3f} mm  {told.velocity_mm_s[-1]:7.1f} mm/s  "
        f"{told.commanded_cN[-1]:7.1f} cN  state {told.state[-1]}  missing {missing}"
    )


@contextmanager
def live_line() -> Iterator[Callable[[str], None]]:
    """Show a line that is written over, on a terminal; elsewhere nothing."""
    if not sys.stderr.isatty():
        yield lambda _line: None
        return
    from rich.console import Console
    from rich.live import Live
    from rich.text import Text

    with Live(console=Console(stderr=True), transient=True, refresh_per_second=20) as live:
        yield lambda line: live.update(Text(line))


def writer(stream: IO[str], output: Path) -> Callable[[TickColumns], None]:
    """Give what writes ticks to an open file: comma-separated values, or a JSON document per line."""
    names = [field.name for field in fields(TickColumns)]
    as_json = output.suffix.lower() == ".jsonl"
    if not as_json:
        stream.write(",".join(names) + "\n")

    def write(told: TickColumns) -> None:
        columns = (getattr(told, name).tolist() for name in names)
        for row in zip(*columns, strict=True):
            line = json.dumps(dict(zip(names, row, strict=True))) if as_json else ",".join(map(str, row))
            stream.write(line + "\n")

    return write
