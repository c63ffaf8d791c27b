"""fdvv vibration: a button's vibrations, as they are meant and as a rig plays them."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fdvv.cli._exciter_options import exciter_option, opened_exciter
from fdvv.cli._output import Finite, check_output, json_option, number, print_json, print_table

if TYPE_CHECKING:
    from fdvv.model import FDVVModel, Vibration
    from fdvv.vibration import KnownExciter


@click.command()
@click.argument("button")
@click.option(
    "--stroke",
    type=click.Choice(["press", "release"]),
    default="press",
    show_default=True,
    help="Of the sound that is written.",
)
@click.option(
    "--velocity",
    "velocity_mm_s",
    type=Finite(min=0, min_open=True),
    default=100.0,
    show_default=True,
    help="Of the sound that is written: the nearest one, mm/s.",
)
@exciter_option
@click.option("--wav", type=click.Path(path_type=Path), help="The *.wav to write: acceleration, 48 kHz.")
@click.option("--board", is_flag=True, help="Write the vibration board's own samples, 16 kHz, bit for bit.")
@json_option
def vibration(
    button: str,
    stroke: str,
    velocity_mm_s: float,
    exciter: Path | None,
    wav: Path | None,
    board: bool,
    as_json: bool,
) -> None:
    """Show a button's vibrations, and write one as a sound.

    BUTTON is a built-in, a *.fdvv.json file or a measured file. With a known exciter it is told how alike and
    how strong each is rendered, as that exciter's response has it: an expectation, not a measurement. A sound
    of acceleration is as loud as 16 bits allow; what its full scale stands for is told.
    """  # fmt: skip
    from fdvv.errors import InputError
    from fdvv.workflow import open_model, vibration_wav

    check_output(wav, ".wav")
    model, known = open_model(button), opened_exciter(exciter)
    if not model.vibrations:
        raise InputError(button, "vibrations", "it has none", "measure them, or tune from a model that has")
    rows = [_about(found, known) for found in model.vibrations]
    document: dict[str, Any] = {"name": model.name, "vibrations": rows, "wav": None}
    if wav:
        made = vibration_wav(_chosen(model, button, stroke, velocity_mm_s), known, board)
        made.save(wav)
        document["wav"] = {
            "path": str(wav),
            "full_scale": made.full_scale,
            "unit": "count" if board else "m/s2",
        }
    if as_json:
        print_json(document)
        return
    _print(document)


def _chosen(model: FDVVModel, button: str, stroke: str, velocity_mm_s: float) -> Vibration:
    from fdvv.errors import InputError

    found = model.vibration(stroke, velocity_mm_s)
    if found is None:
        raise InputError(button, "vibrations", f"it has none of the {stroke}", "choose the other --stroke")
    return found


def _about(found: Vibration, exciter: KnownExciter | None) -> dict[str, Any]:
    from fdvv.workflow import render_vibration

    strongest = max(found.modes, key=lambda mode: abs(mode.amplitude_m_s2))
    about: dict[str, Any] = {
        "stroke": str(found.stroke),
        "velocity_mm_s": found.velocity_mm_s,
        "onset_mm": found.onset_mm,
        "duration_s": found.duration_s,
        "modes": len(found.modes),
        "frequency_Hz": strongest.frequency_Hz,
        "amplitude_m_s2": strongest.amplitude_m_s2,
    }
    if exciter:
        made = render_vibration(found, exciter)
        about["expected"] = {
            "way": str(made.way),
            "likeness": made.likeness,
            "strength_ratio": made.strength_ratio,
            "lead_s": made.lead_s,
        }
    return about


def _print(document: dict[str, Any]) -> None:
    known = "expected" in document["vibrations"][0]
    head = [
        "vibration",
        "onset mm",
        "ms",
        "Hz",
        "m/s2",
        *(["played", "likeness", "strength"] if known else []),
    ]
    rows = []
    for v in document["vibrations"]:
        speed = "any speed" if v["velocity_mm_s"] is None else f"{v['velocity_mm_s']:g} mm/s"
        figures = (v["onset_mm"], 1e3 * v["duration_s"], v["frequency_Hz"], v["amplitude_m_s2"])
        row = [f"{v['stroke']}, {speed}", *(number(figure) for figure in figures)]
        if known:
            e = v["expected"]
            row += [e["way"], number(e["likeness"]), number(e["strength_ratio"])]
        rows.append(row)
    click.echo(document["name"])
    print_table(head, rows)
    if document["wav"]:
        scale = f"full scale is {document['wav']['full_scale']:.4g} {document['wav']['unit']}"
        click.echo(f"written to {document['wav']['path']}; {scale}")
