"""How fast to press, shown: a count-in, then a bar that goes down and up as the cap should."""

from __future__ import annotations

import shlex
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

RATE_Hz = 22050
LENGTH_s = 0.06
LOUDNESS = 20000 / 32767
TONES_Hz = {"cue contact": 880.0, "cue bottom": 440.0}
"""High at contact, low at the bottom."""


def tone(frequency_Hz: float) -> bytes:
    """Make a short WAV: a sine that fades in and out."""
    import numpy as np

    from fdvv.vibration.wave import to_wav

    part = np.arange(round(LENGTH_s * RATE_Hz), dtype=np.float64)
    fade = np.sin(np.pi * part / part.size)
    return to_wav(LOUDNESS * fade * np.sin(2 * np.pi * frequency_Hz * part / RATE_Hz), RATE_Hz, 1.0).data


@contextmanager
def beeper(player: str | None, bell: Callable[[], None]) -> Iterator[Callable[[str], None]]:
    """Yield a function that beeps for an event: player, a command that is given a WAV file, or else the bell.

    Raises InputError if the player cannot be started.
    """
    if player is None:
        yield lambda _event: bell()
        return
    with tempfile.TemporaryDirectory(prefix="fdvv-") as folder:
        files = {event: Path(folder) / f"{event.replace(' ', '-')}.wav" for event in TONES_Hz}
        for event, file in files.items():
            file.write_bytes(tone(TONES_Hz[event]))
        command, running = shlex.split(player), list[subprocess.Popen[bytes]]()
        yield lambda event: running.append(_started(command, files[event]))
        for process in running:
            process.wait()


def _started(command: list[str], file: Path) -> subprocess.Popen[bytes]:
    from fdvv.errors import InputError

    quiet = subprocess.DEVNULL
    try:
        return subprocess.Popen([*command, str(file)], stdin=quiet, stdout=quiet, stderr=quiet)
    except OSError as error:
        reason = f"cannot be started ({error.strerror})"
        raise InputError("--player", shlex.join(command), reason, "name another, as aplay -q") from error


BEATS = ("3", "2", "1")
BEAT_s = 0.5
DWELL_s = 0.05
"""At the stop, between down and up."""
FRAME_s = 1 / 60  # of a usual display of 60 Hz; more pictures are not shown
WIDTH = 40  # half of a terminal of 80 columns; a block is 0.1 mm of 4 mm


def minimum_jerk(part: float) -> float:
    """Return the distance covered, 0 to 1, of a minimum-jerk movement (Flash and Hogan 1985)."""
    return part**3 * (10 - 15 * part + 6 * part**2)


def depth_at(t_s: float, stroke_s: float) -> float:
    """Return the depth, 0 to 1, of a press that takes stroke_s down, rests, and takes as long up."""
    down = min(max(t_s / stroke_s, 0.0), 1.0)
    up = min(max((t_s - stroke_s - DWELL_s) / stroke_s, 0.0), 1.0)
    return minimum_jerk(down) - minimum_jerk(up)


def bar(depth: float) -> str:
    filled = round(depth * WIDTH)
    return "█" * filled + "·" * (WIDTH - filled)


def show_cue(
    stroke_s: float,
    draw: Callable[[str], None],
    now_s: Callable[[], float] = time.monotonic,
    sleep: Callable[[float], None] = time.sleep,
) -> None:
    """Count in, then let the bar go down and up in the time of the strokes; draw is given each picture."""
    for beat in BEATS:
        draw(f"{beat}  {bar(0.0)}")
        sleep(BEAT_s)
    begun_s = now_s()
    while (t_s := now_s() - begun_s) < 2 * stroke_s + DWELL_s:
        draw(f"   {bar(depth_at(t_s, stroke_s))}")
        sleep(FRAME_s)
    draw(f"   {bar(0.0)}")
