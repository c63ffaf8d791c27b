"""Made-up logs of every variant, written as their programs write them."""

from __future__ import annotations

import io
import wave
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

ID = '"4CF0B31A900811F1794CD665D3A07481"'


def motive(
    version: str = "1.23",
    blocks: Sequence[tuple[str, str]] = (("Marker", "left"), ("Marker", "right")),
    rate: float = 256.0,
    frames: int = 40,
    unit: str = "Millimeters",
    start: str = "2026-01-02 03.04.05.678 PM",
    end: str = "\n",
    digits: int = 6,
    rigid_body: bool = False,
) -> str:
    """Write an export: marker i stands at 100 i + (0, 1, 2), moves 0.5 a frame in y, is gone in frame 3.

    1.21 does not label its rows, 1.24 has a column of time code, 1.25 one more row.
    """
    code = ["TimeCode"] if version == "1.24" else []
    columns = [
        (kind, name, "Position", axis) for kind, name in blocks for axis in "XYZ" + "Q" * (kind != "Marker")
    ]
    columns = [(k, n, c, a) if a != "Q" else (k, n, "Marker Quality", "") for k, n, c, a in columns]
    body = [("Rigid Body", "cap", "Rotation", a) for a in "XYZW"]
    body += [("Rigid Body", "cap", "Position", a) for a in "XYZ"]
    error = "Error Per Marker" if version == "1.21" else "Mean Marker Error"
    columns = [*body, ("Rigid Body", "cap", error, ""), *columns] if rigid_body else columns
    blank, bare = ["" for _ in code], version == "1.21"
    header = [
        *("Format Version", version, "Take Name", "made up", "Take Notes", ""),
        *("Capture Frame Rate", f"{rate:.6f}", "Export Frame Rate", f"{rate:.6f}"),
        *("Capture Start Time", start, "Capture Start Frame", "78593", "Total Frames in Take", f"{frames}"),
        *("Total Exported Frames", f"{frames}", "Rotation Type", "Quaternion", "Length Units", unit),
        *("Coordinate Space", "Global"),
    ]
    rows = [
        ["", "" if bare else "Type", *blank, *(k for k, _, _, _ in columns)],
        ["", "" if bare else "Name", *blank, *(f'"{n}"' if "," in n else n for _, n, _, _ in columns)],
        ["", "" if bare else "ID", *blank, *(ID for _ in columns)],
        *([["", "Parent", *("" for _ in columns)]] if version == "1.25" else []),
        ["", "", *blank, *(c for _, _, c, _ in columns)],
        ["Frame", "Time" if bare else "Time (Seconds)", *code, *(a for _, _, _, a in columns)],
    ]
    for frame in range(frames):
        time = f"{round(frame / rate, digits):.6f}"
        clock = [f"15:26:46:{frame // 4:02}.{frame % 4:02}" for _ in code]
        rows.append([f"{frame}", time, *clock, *_cells(columns, frame)])
    return end.join([",".join(header), "", *(",".join(row) for row in rows), ""])


def _cells(columns: Sequence[tuple[str, str, str, str]], frame: int) -> list[str]:
    names = list(dict.fromkeys(name for _, name, _, _ in columns))
    found = []
    for _, name, component, axis in columns:
        place = 100.0 * names.index(name) + "XYZ".find(axis) + 0.5 * frame * (axis == "Y")
        whole = f"{place:.6f}" if component == "Position" else "0.500000"
        found.append("" if frame == 3 else whole)
    return found


def serial(samples: int = 50, first_us: int = 1_000_000, head: bool = True, checked: bool = False) -> str:
    """Write what a capture board writes: force and sound at 1 kHz, an event in between."""
    lines = [
        "# fdvv-capture 1",
        "# board made up, 12-bit converter",
        "# channel F force_cN scale=0.05 zero=512",
        "# channel M sound_V scale=0.0008 zero=2048",
        "# bench force_filter_ms=1 tip_mass_g=2.5",
    ]
    lines = [_summed(line, checked) for line in lines] if head else []
    for i in range(samples):
        us = (first_us + 1000 * i) % 2**32
        lines.append(_summed(f"FM {us} {512 + i} {2048 - i}", checked))
        if i == samples // 2:
            lines.append(_summed(f"! {(us + 250) % 2**32} light on", checked))
    return "\r\n".join([*lines, ""])


def _summed(line: str, checked: bool) -> str:
    total = 0
    for byte in line.encode():
        total ^= byte
    return f"{line}*{total:02X}" if checked else line


def forcepeaks(taps: Sequence[int] = (900, 1350, 2180, 2700, 3100), beats: int = 9) -> str:
    """Write a log: beats every 444 ms from 10 s on, taps so many ms behind, force as the board samples it."""
    begin, step = 10_000, 444
    sixth = begin + 5 * step
    end = begin + (beats - 1) * step + step // 2
    values: list[int] = []
    for tap in taps:
        first, last = max(begin + tap, sixth), min(begin + tap + 100, end)
        count = round((last - first) / 1.024) if last > first else 0
        values += [400 - i for i in range(count)] + [0] * (begin + tap + 100 <= end)
    lines = [(begin + step * n, f"S {n} {begin + step * n}") for n in range(beats)]
    lines += [(begin + tap, f"R {n} {begin + tap}") for n, tap in enumerate(taps)]
    log_lines = [line for _, line in sorted(lines)] + [f"V {i} {value}" for i, value in enumerate(values)]
    return "\n".join([*log_lines, ""])


def counts(samples: int = 100) -> str:
    """Write the log of a converter: whole numbers alone."""
    return "".join(f"{3_586_019 + 7 * i}\n" for i in range(samples))


def table(separator: str = ",") -> str:
    """Write a table with a force, a marker whose depth is in micrometres, a light, and a gap."""
    head = ["time_ms", "force_gf", "left_x_mm", "left_y_mm", "left_z_um", "light", "remark"]
    rows = [[f"{i}", f"{10 * i}", f"{i}.5", "2", "3000", f"{i % 2}", "no"] for i in range(20)]
    rows[4][1] = ""
    text = "\n".join(separator.join(row) for row in [head, *rows])
    return text.replace(".", ",") if separator == ";" else text


def wav(samples: npt.NDArray[np.int64], width: int = 2, channels: int = 1) -> bytes:
    """Write whole numbers as a WAV; eight bits count from 128."""
    wide = (samples + (128 if width == 1 else 0)).astype("<i8").view(np.uint8).reshape(-1, 8)
    stream = io.BytesIO()
    with wave.open(stream, "wb") as file:
        file.setparams((channels, width, 44100, 0, "NONE", ""))
        file.writeframes(wide[:, :width].tobytes())
    return stream.getvalue()


TEXTS = {
    "motive-1.21": motive(
        "1.21", [("Rigid Body Marker", "cap_1"), ("Marker", "Unlabeled:108")], rigid_body=True
    ),
    "motive-1.22": motive("1.22", unit="Meters", start="2018-10-05 12.05.03.445 P.M."),
    "motive-1.23": motive("1.23", rigid_body=True, end="\r\n"),
    "motive-1.24": motive("1.24", unit="Centimeters", start="2026-08-04 03.25.40.230 "),
    "motive-1.25": motive("1.25"),
    "fdvv-capture": serial(),
    "forcepeaks": forcepeaks(),
    "counts": counts(),
    "table": table(),
}
NAMES = {"counts": "key_2K_24b_slow.txt"}
