"""Tiny files of every format, written as their benches write them."""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from fdvv.formats.force.types import ForceFile
from fdvv.model.curve import MeasuredCurve
from fdvv.units import GRAM_FORCE_cN

Array = npt.NDArray[np.float64]

STEP_mm = 0.02
TRAVEL_mm = 3.0


def press_gf(x_mm: Array) -> Array:
    """A linear switch: air, a contact step, a spring and a stop."""
    return np.round(np.where(x_mm < 0.04, 0.0, 30.0 + 10.0 * x_mm) + 800.0 * np.maximum(x_mm - 2.8, 0.0), 1)


def stroke() -> tuple[Array, Array]:
    """Displacement (mm) and force (gf) of the press."""
    x = np.round(np.arange(0.0, TRAVEL_mm + 1e-9, STEP_mm), 4)
    return x, press_gf(x)


def run() -> tuple[Array, Array]:
    """Press, then release 3 gf lighter."""
    x, force = stroke()
    back = np.round(np.maximum(force[::-1] - 3.0, 0.0), 1)
    return np.concatenate((x, x[::-1])), np.concatenate((force, back))


def closed() -> npt.NDArray[Any]:
    """Contact closed below 1.5 mm going down, 1.4 mm coming back."""
    x, _ = stroke()
    return np.concatenate((x >= 1.5, x[::-1] > 1.4)).astype(int)


def _lines(header: str, rows: Sequence[Sequence[object]], end: str = "\n") -> str:
    body = [",".join(str(cell) for cell in row) for row in rows]
    return end.join([header, *body] if header else body) + end


def tidy() -> str:
    x, force = run()
    rows = [(f, d, int(f > 200), "Oak") for f, d in zip(force, x, strict=True)]
    return _lines("force,displacement,judge,name", rows)


def goat_raw() -> str:
    x, force = run()
    head = ["Maximum,193.9,@,No.1047,,,,,,", "Minimum,-0.5,@,No.1998,,,,,,", "Average,56.18,,,,,,,,"]
    head += [f"Data Quantity,{x.size},,,,,,,,", "Number of NG,0,,,,,,,,"]
    head.append("No.,Force,Unit,Displacement,Unit,Judge,Position,Time,Date,")
    rows = [
        (i + 1, f, "gf", f"{d:.3f}", "mm", "OK", "--", "10:30:52 AM", "12/26/2024", "")
        for i, (f, d) in enumerate(zip(force, x, strict=True))
    ]
    return _lines("\n".join(head), rows)


def goat_highres() -> str:
    x, force = run()
    head = ["MAX FORCE = 195.5,3.965", "UNIT = gf,mm", f"DATA COUNT = {x.size},", "RECORDING RATE = 0.0005,"]
    head += ["COMMENT = ,", "2ND PEAK FORCE = ---,---"]
    return _lines("\n".join(head), list(zip(force, x, strict=True)))


def downstroke() -> str:
    x, force = stroke()
    return _lines("", [(f"{d:.4f}", f"{f:.4f}") for d, f in zip(x, force, strict=True)], "\r\n")


def upstroke() -> str:
    x, force = stroke()
    return _lines("", [(f"{d:.4f}", f"{max(f - 3, 0):.4f}") for d, f in zip(x, force, strict=True)], "\r\n")


def haata(shifts: Sequence[float] = (0.0, 0.01, 0.0, 0.01)) -> str:
    x, force = stroke()
    columns: list[tuple[str, list[float]]] = []
    for i, shift in enumerate(shifts):
        keep = x.size - i  # later columns are shorter, so all but one are padded
        down = np.round(x + shift, 6)[-keep:]
        felt = force[-keep:]
        columns += [(f"Press {i + 1}, x", list(down)), (f"Press {i + 1}, y", list(felt))]
        back = np.maximum(felt[::-1] - 3.0, 0.0)
        columns += [(f"Release {i + 1}, x", list(down[::-1])), (f"Release {i + 1}, y", list(back))]
    header = ",".join(f'"{title}"' for title, _ in columns)
    rows = [[f'"{values[i]}"' if i < len(values) else '""' for _, values in columns] for i in range(x.size)]
    return _lines(header, rows, "\r\n")


def bluepylons_csv() -> str:
    x, force = run()
    rows = [(round(d * 1000), f, c) for d, f, c in zip(x, force, closed(), strict=True)]
    return _lines("x_um,force_gf,actuated", rows)


def buddyog() -> str:
    x, force = run()
    rows = [
        (7000 + 136 * i, 8 * i, f"{d:.4f}", f"{f * 3000:.2f}", f"{f:.4f}")
        for i, (d, f) in enumerate(zip(x, force, strict=True))
    ]
    return _lines("Millis,Steps,Travel (mm),Scale raw,Scale (grams)", rows)


def tester_json() -> str:
    """The release's displacement is a copy of the press's; sample 81 is where the contact opened."""
    x, force = stroke()
    back = np.round(np.maximum(force[::-1] - 3.0, 0.0), 1)
    record = {
        "down_x": list(x),
        "down_y": list(force),
        "up_x": list(x),
        "up_y": list(back),
        "pressPoint": [float(x[75]), float(force[75])],
        "releasePoint": [float(x[::-1][80] - STEP_mm), float(back[80])],
    }
    return json.dumps(record)


def plain() -> str:
    x, force = run()
    return _lines("Force (N),Travel (mm)", [(f"{f / 100:.5f}", d) for d, f in zip(x, force, strict=True)])


def velocities() -> str:
    x, force = stroke()
    rows = [(d, f, round(f * 1.1, 3)) for d, f in zip(x, force, strict=True)]
    return _lines("displacement_mm,force_cN_0.5mm_s,force_cN_50mm_s", rows)


class Sample(NamedTuple):
    """A file of the strokes above.

    name, text : of the file.
    scale_cN : force in the file for 1 gf of the strokes; 1 where it holds their figures over 100 as newtons.
    """

    name: str
    text: Callable[[], str]
    scale_cN: float = GRAM_FORCE_cN


TEXTS: dict[str, Sample] = {
    "thereminGoat-tidy": Sample("oak.csv", tidy),
    "thereminGoat-raw": Sample("Oak Raw Data CSV.csv", goat_raw),
    "thereminGoat-highres": Sample("Oak_HighResolutionRaw.csv", goat_highres),
    "stroke-pair": Sample("Oak.downstroke.csv", downstroke),
    "haata": Sample("Oak.csv", haata),
    "bluepylons-csv": Sample("Oak.csv", bluepylons_csv),
    "buddyog": Sample("DataLog_1.csv", buddyog),
    "tester-json": Sample("Oak.json", tester_json),
    "plain-csv": Sample("Oak.csv", plain, 1.0),
}
"""A sample of each text format."""


def ods(rows: Sequence[Sequence[object]]) -> bytes:
    """A spreadsheet of one sheet."""
    lines = []
    for row in rows:
        made = "".join(_cell(value) for value in row)
        lines.append(f"<table:table-row>{made}</table:table-row>")
    return ods_from_xml("".join(lines))


def _cell(value: object) -> str:
    if value == "":
        return "<table:table-cell/>"
    if isinstance(value, str):
        return f'<table:table-cell office:value-type="string"><text:p>{value}</text:p></table:table-cell>'
    return f'<table:table-cell office:value-type="float" office:value="{value}"/>'


def ods_from_xml(rows: str) -> bytes:
    """A spreadsheet around ready-made rows."""
    spaces = " ".join(
        f'xmlns:{name}="urn:oasis:names:tc:opendocument:xmlns:{name}:1.0"'
        for name in ("office", "table", "text")
    )
    xml = (
        f'<?xml version="1.0" encoding="UTF-8"?><office:document-content {spaces}><office:body>'
        f'<office:spreadsheet><table:table table:name="Sheet1">{rows}</table:table>'
        "</office:spreadsheet></office:body></office:document-content>"
    )
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("mimetype", "application/vnd.oasis.opendocument.spreadsheet")
        archive.writestr("content.xml", xml)
        archive.writestr(
            "META-INF/manifest.xml",
            '<?xml version="1.0"?><manifest:manifest '
            'xmlns:manifest="urn:oasis:names:tc:opendocument:xmlns:manifest:1.0"/>',
        )
    return packed.getvalue()


def raw_rows(layout: str) -> list[list[object]]:
    """The rows of a bluepylons sheet in layout A, B or C."""
    x, force = run()
    numbers = list(zip((x * 1000).round().tolist(), force.tolist(), closed().tolist(), strict=True))
    if layout == "A":
        head: list[list[object]] = [["", "Raw X (microns)", "Raw Force (gf)", "Actuated?"]]
        return head + [[float(i), *row] for i, row in enumerate(numbers)]
    if layout == "B":
        head = [["Raw data", "", "", "Corrected"], ["X (microns)", "Force (gf)", "Actuated? ", "X (mm)"]]
        return head + [[*row, ""] for row in numbers]
    head = [["Raw data", "", ""], ["X (microns)", "Force (gf)", ""]]
    return head + [[row[0], row[1], ""] for row in numbers]


def write(folder: Path, name: str, content: str | bytes) -> Path:
    """Write one file and return its path."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / name
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    return path


def press(file: ForceFile, cycle: int = 0) -> MeasuredCurve:
    """Return the press of a cycle, which there must be."""
    found = file.cycles[cycle].press
    assert found is not None
    return found
