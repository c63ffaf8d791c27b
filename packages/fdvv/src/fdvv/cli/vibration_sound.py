"""fdvv vibration of a sound: the ring of one key press, and how much of it its modes are."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click
import numpy as np

from fdvv.cli import ui
from fdvv.errors import FitError, InputError
from fdvv.recording.read import read_log
from fdvv.recording.sound import sound_kind
from fdvv.vibration.sound import SoundRing, sound_ring

LONGEST_s = 5.0


def is_sound(spec: str) -> bool:
    """Return whether a file's first bytes are those of a sound."""
    path = Path(spec)
    if not path.is_file():
        return False
    with path.open("rb") as stream:
        return sound_kind(stream.read(64)) is not None


def show_sound(spec: str, least_carried: float, as_json: bool) -> None:
    """Print the modes of a key press in a sound. InputError where they carry less than that of its energy."""
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
    about = _about(found)
    if found.carried_ratio < least_carried:
        place = f"ring from {1e3 * found.onset_s:.1f} to {1e3 * found.end_s:.1f} ms"
        part = f"{_percent(found.carried_ratio)} of its energy is in damped modes"
        reason = f"{part}, at least {_percent(least_carried)} is needed: it is no ring of a few modes"
        remedy = "give a cleaner sound of one press, or lower --least-carried and doubt the modes"
        raise InputError(spec, place, reason, remedy, about)
    if as_json:
        ui.print_json({"sound": spec, "rate_Hz": stream.rate_Hz, "duration_s": seconds, **about})
    else:
        _print(spec, found)


def _about(found: SoundRing) -> dict[str, Any]:
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


def _print(spec: str, found: SoundRing) -> None:
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
