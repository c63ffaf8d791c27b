"""fdvv device upload and press."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fdvv.cli._device_options import device_option, opened, record_option, velocity_option
from fdvv.cli._exciter_options import exciter_option, opened_exciter
from fdvv.cli._output import Finite, json_option, number, print_json, print_table

if TYPE_CHECKING:
    from fdvv.vibration import KnownExciter


@click.command()
@click.argument("button")
@device_option
@velocity_option
@exciter_option
@record_option
@json_option
def upload(
    button: str,
    spec: str,
    velocities_mm_s: tuple[float, ...],
    exciter: Path | None,
    recording: Path | None,
    as_json: bool,
) -> None:
    """Make BUTTON the program of a device: a program image, a built-in, a *.fdvv.json or a measured file.

    A model is rendered by its own force, not compensated for the rig.
    """
    from fdvv.protocol import head_of, travel_mm_of
    from fdvv.workflow import program_image

    known = opened_exciter(exciter)
    image = program_image(button, velocities_mm_s, known)
    with opened(spec, recording) as found:
        _upload(_programs(found, spec), image, known)
        name = found.info().name
    travel_mm = travel_mm_of(image)
    document = {"device": name, "bytes": len(image), "states": head_of(image).states, "travel_mm": travel_mm}
    if as_json:
        print_json(document)
        return
    click.echo(f"{name}: {len(image)} bytes, checked and active, travel {travel_mm:.3f} mm")


def _upload(found: Any, image: bytes, exciter: KnownExciter | None) -> None:
    """Upload a program; with a known exciter the board is told first how early its vibrations must begin."""
    from fdvv.workflow import prepare_exciter

    if exciter:
        prepare_exciter(found, exciter)
    found.upload_program(image)


def _programs(found: Any, spec: str) -> Any:
    from fdvv.errors import InputError

    if not hasattr(found, "upload_program"):
        raise InputError("--device", spec, "it runs tables of force only", "use host or serial:PORT")
    return found


@click.command()
@click.argument("button")
@device_option
@velocity_option
@exciter_option
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
    exciter: Path | None,
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

    known = opened_exciter(exciter)
    image = program_image(button, velocities_mm_s, known)
    rows = []
    with opened(spec, recording) as found:
        _upload(_programs(found, spec), image, known)
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
