"""fdvv vibration: a button's vibrations as they are meant and as a rig plays them, and those of a sound."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fdvv.cli import ui
from fdvv.cli.options import exciter_option, opened_exciter
from fdvv.errors import FitError, InputError

if TYPE_CHECKING:
    from fdvv.model.vibration import Vibration
    from fdvv.vibration.exciter import KnownExciter
    from fdvv.vibration.sound import SoundRing


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


LONGEST_s = 5.0  # assumed: a press lasts under a second; a longer sound likely holds several


def is_sound(spec: str) -> bool:
    """Return whether a file's first bytes are those of a sound."""
    from fdvv.recording.sound import sound_kind

    path = Path(spec)
    if not path.is_file():
        return False
    with path.open("rb") as stream:
        return sound_kind(stream.read(64)) is not None


def show_sound(spec: str, least_carried: float, as_json: bool) -> None:
    """Print the modes of a key press in a sound. InputError where they carry less than that of its energy."""
    import numpy as np

    from fdvv.recording.read import read_log
    from fdvv.vibration.sound import sound_ring

    stream = read_log(Path(spec)).takes[0].streams[0]
    seconds = stream.t_s.size / stream.rate_Hz
    if seconds > LONGEST_s:
        reason = f"it lasts {seconds:.1f} s, and one key press at most {LONGEST_s:g}"
        raise InputError(spec, "samples", reason, "cut one press out of it")
    values = np.asarray(stream.values, dtype=np.float64)
    try:
        found = sound_ring(values / np.abs(values).max() if np.any(values) else values, stream.rate_Hz)
    except FitError as error:
        raise InputError(spec, "samples", str(error), "give the sound of one key press") from error
    about = _about_sound(found)
    if found.carried_ratio < least_carried:
        place = f"ring from {1e3 * found.onset_s:.1f} to {1e3 * found.end_s:.1f} ms"
        part = f"{_percent(found.carried_ratio)} of its energy is in damped modes"
        reason = f"{part}, at least {_percent(least_carried)} is needed: it is no ring of a few modes"
        remedy = "give a cleaner sound of one press, or lower --least-carried and doubt the modes"
        raise InputError(spec, place, reason, remedy, about)
    if as_json:
        ui.print_json({"sound": spec, "rate_Hz": stream.rate_Hz, "duration_s": seconds, **about})
    else:
        _print_sound(spec, found)


def _about_sound(found: SoundRing) -> dict[str, Any]:
    names = ("frequency_Hz", "decay_1_s", "amplitude", "duration_s", "frequency_sd_Hz", "decay_sd_1_s")
    return {
        "onset_s": found.onset_s,
        "end_s": found.end_s,
        "cut": found.cut,
        "carried_ratio": found.carried_ratio,
        "felt_ratio": found.felt_ratio,
        "modes": [{name: getattr(mode, name) for name in names} for mode in found.modes],
    }


def _percent(ratio: float) -> str:
    return f"{100 * ratio:.0f} %"


def _print_sound(spec: str, found: SoundRing) -> None:
    onset = "the file begins inside the sound" if found.cut else f"onset at {1e3 * found.onset_s:.2f} ms"
    length = f"ring of {1e3 * (found.end_s - found.onset_s):.1f} ms"
    click.echo(f"{ui.one_line(Path(spec).name)}: {onset}, {length}")
    rows = [
        [m.frequency_Hz, m.frequency_sd_Hz, m.decay_1_s, 1e3 * m.duration_s, m.amplitude] for m in found.modes
    ]
    digits = {"Hz": 1, "sd": 1, "decay 1/s": 0, "ms to a tenth": 2, "of the peak": 3}
    ui.print_table(list(digits), rows, left=0, digits=digits)
    carried = f"the modes carry {_percent(found.carried_ratio)} of the ring's energy"
    felt = f"{_percent(found.felt_ratio)} of it lies below 1 kHz, where fingers feel"
    click.echo(f"{carried}; {felt}")
