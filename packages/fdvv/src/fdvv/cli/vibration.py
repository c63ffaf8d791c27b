"""fdvv vibration: a button's vibrations, as they are meant and as a rig plays them."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fdvv.cli import ui
from fdvv.cli.options import exciter_option, opened_exciter
from fdvv.errors import InputError

if TYPE_CHECKING:
    from fdvv.model.vibration import Vibration
    from fdvv.vibration.exciter import KnownExciter


@click.command()
@click.argument("button")
@ui.option("--stroke", type=ui.STROKE, default="press", help="Of the sound that is written.")
@ui.velocity_option(default=100.0, help="Of the sound, mm/s: the nearest one.")
@exciter_option
@ui.option("--wav", type=ui.PATH, help="The *.wav to write: acceleration, 48 kHz.")
@ui.option("--board", is_flag=True, help="Write the vibration board's own samples, 16 kHz, bit for bit.")
@ui.option(
    "--least-carried",
    type=ui.Finite(min=0, max=1),
    default=0.5,
    help="Refuse a sound whose modes carry less of its energy.",
)
@ui.json_option
def vibration(
    button: str,
    exciter: Path | None,
    wav: Path | None,
    board: bool,
    least_carried: float,
    as_json: bool,
    **of: Any,
) -> None:
    """Show a button's vibrations, or the modes in the sound of a key press.

    BUTTON is a built-in, a *.fdvv.json file or a measured file. With a known exciter the output predicts
    from its response how alike and how strong each is rendered; it is not a measurement. A sound of
    acceleration is as loud as 16 bits allow; its full scale is printed. Of a WAV, FLAC, OGG or MP3 file of
    one key press the onset, the modes and their part of the energy are shown.
    """  # fmt: skip
    from fdvv.button.export_file import vibration_of
    from fdvv.button.open import open_button
    from fdvv.cli.vibration_sound import is_sound, show_sound
    from fdvv.program.render_vibration import vibration_wav

    if is_sound(button):
        if exciter or wav or board:
            raise click.UsageError("--exciter, --wav and --board are of a button, not of a sound")
        show_sound(button, least_carried, as_json)
        return
    ui.check_output(wav, ".wav")
    model, known = open_button(button), opened_exciter(exciter)
    if not model.vibrations:
        raise InputError(button, "vibrations", "it has none", "measure them, or tune from a model that has")
    rows = [_about(found, known) for found in model.vibrations]
    document: dict[str, Any] = {"name": model.name, "vibrations": rows, "wav": None}
    if wav:
        made = vibration_wav(vibration_of(button, model, **of), known, board)
        made.save(wav)
        unit = "count" if board else "m/s2"
        document["wav"] = {"path": str(wav), "full_scale": made.full_scale, "unit": unit}
    if as_json:
        ui.print_json(document)
        return
    _print(document)


def _about(found: Vibration, exciter: KnownExciter | None) -> dict[str, Any]:
    from fdvv.program.render_vibration import render_vibration

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
    head = ["vibration", "onset mm", "ms", "Hz", "m/s2"]
    head += ["played", "likeness", "strength"] if known else []
    rows = []
    for v in document["vibrations"]:
        speed = "any speed" if v["velocity_mm_s"] is None else f"{v['velocity_mm_s']:g} mm/s"
        figures = (v["onset_mm"], 1e3 * v["duration_s"], v["frequency_Hz"], v["amplitude_m_s2"])
        row: list[Any] = [f"{v['stroke']}, {speed}", *figures]
        if known:
            e = v["expected"]
            row += [e["way"], e["likeness"], e["strength_ratio"]]
        rows.append(row)
    click.echo(document["name"])
    ui.print_table(head, rows)
    if document["wav"]:
        scale = f"full scale is {document['wav']['full_scale']:.4g} {document['wav']['unit']}"
        click.echo(f"written to {document['wav']['path']}; {scale}")
