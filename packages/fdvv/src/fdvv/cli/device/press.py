"""fdvv device upload and press."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import Any

import click

from fdvv.cli import ui
from fdvv.cli.options import (
    device_option,
    exciter_option,
    opened,
    opened_exciter,
    record_option,
    velocity_option,
)
from fdvv.errors import InputError
from fdvv.force_text import ForceTitle


@click.command()
@device_option
@ui.option("--rig", type=ui.RIG, help="Of a simulated device: recommended, light ..., or a TOML file.")
@ui.option("--rig-known", type=ui.FILE, help="*.rig.json of this rig; its sensor's lag sharpens the gain.")
@ui.option("--tone-s", type=ui.Finite(min=0.3, max=4), default=3.0, help="Length of each of 14 tones or so.")
@ui.option("--seed", type=ui.COUNT, default=0, help="Of a simulated device.")
@ui.option("-o", "--output", type=ui.PATH, help="The *.exciter.json to write.")
@ui.json_option
def exciter(rig_known: Path | None, tone_s: float, output: Path | None, as_json: bool, **device: Any) -> None:
    """Know the exciter of a rig from tones that its position sensor sees; nobody touches the button.

    The motor holds the cap in the middle while tones of 260 to 860 Hz sound. Gain, resonance and quality are
    printed with their standard errors; --exciter of other commands plays vibrations through the inverse.
    """  # fmt: skip
    from fdvv.compensation.identification.rig_file import load_rig
    from fdvv.rendering.exciter import identify_exciter
    from fdvv.vibration.exciter import EXCITER_SUFFIX, save_exciter

    ui.check_output(output, EXCITER_SUFFIX)
    known = load_rig(rig_known) if rig_known else None
    with opened(**device) as found, ui.progress("tones", 14) as advance:
        result = identify_exciter(found, known, tone_s, advance, ui.print_stderr)
        name = found.info().name
    if output:
        save_exciter(result, output)
    if as_json:
        ui.print_json({"device": name, **asdict(result)})
        return
    click.echo(
        f"{name}{ui.simulated(result.simulated)}, {result.tones} tones, "
        f"{100 * result.residual_ratio:.0f} % rms off the fit"
    )
    units = {"gain_m_s2_V": "gain, m/s2/V", "resonance_Hz": "resonance, Hz", "quality": "quality"}
    rows = [[label, getattr(result, key), f"{100 * result.error[key]:.0f} %"] for key, label in units.items()]
    ui.print_table(["of the exciter on its cap", "found", "standard error"], rows)
    ui.print_written(output)


@contextmanager
def _uploaded(
    button: str, spec: str, velocities_mm_s: tuple[float, ...], exciter: Path | None, recording: Path | None
) -> Iterator[tuple[Any, bytes]]:
    """Open a device with a button as its program; give it and the image. InputError if it runs none."""
    from fdvv.rendering.exciter import prepare_exciter
    from fdvv.rendering.tuning import program_image

    known = opened_exciter(exciter)
    image = program_image(button, velocities_mm_s, known)
    with opened(spec, recording) as found:
        if not hasattr(found, "upload_program"):
            raise InputError("--device", spec, "it runs tables of force only", "use host or serial:PORT")
        if known:
            prepare_exciter(found, known)
        found.upload_program(image)
        yield found, image


@click.command()
@click.argument("button")
@device_option
@velocity_option
@exciter_option
@record_option
@ui.json_option
def upload(as_json: bool, **options: Any) -> None:
    """Make BUTTON the program of a device: a program image, a built-in, a *.fdvv.json or a measured file.

    A model is rendered by its own force, not compensated for the rig.
    """
    from fdvv.protocol.messages import head_of, travel_mm_of

    with _uploaded(**options) as (found, image):
        name = found.info().name
    travel_mm = travel_mm_of(image)
    document = {"device": name, "bytes": len(image), "states": head_of(image).states, "travel_mm": travel_mm}
    if as_json:
        ui.print_json(document)
        return
    click.echo(f"{name}: {len(image)} bytes, checked and active, travel {travel_mm:.3f} mm")


@click.command()
@click.argument("button")
@device_option
@velocity_option
@exciter_option
@ui.option("--speed", "speed_mm_s", type=ui.SPEED, default=100.0, help="Of the presses, mm/s.")
@ui.option("--presses", type=click.IntRange(1, 1000), default=3, help="How many.")
@record_option
@ui.json_option
def press(speed_mm_s: float, presses: int, as_json: bool, **options: Any) -> None:
    """Upload BUTTON and have it pressed.

    On a simulated device the presses are simulated; on a serial one a person presses. Ctrl-C stops the
    device and keeps what was recorded.
    """
    rows = []
    with _uploaded(**options) as (found, _image):
        info = found.info()
        for count in range(presses):
            if not info.simulated:
                ui.print_stderr(f"press {count + 1} of {presses}: press fully and let go")
            rows.append(_summary(found.press(speed_mm_s)))
    if as_json:
        ui.print_json({"device": info.name, "simulated": info.simulated, "presses": rows})
        return
    click.echo(f"{info.name}{ui.simulated(info.simulated)}, asked at {speed_mm_s:g} mm/s")
    columns = ["press", "duration s", "deepest mm", ForceTitle("largest {}", 3), "ticks"]
    numbered = [[i, *row.values()] for i, row in enumerate(rows, 1)]
    ui.print_table(columns, numbered, digits=dict.fromkeys(columns, 3))


def _summary(found: Any) -> dict[str, Any]:
    return {
        "duration_s": float(found.t_s[-1] - found.t_s[0]),
        "deepest_mm": float(found.displacement_mm.max()),
        "largest_cN": float(found.force_cN.max()),
        "ticks": int(found.tick.sum()),
    }
