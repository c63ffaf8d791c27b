"""Beeps that tell a person of contact and bottom: the terminal's bell, or a player of sound files."""

from __future__ import annotations

import io
import math
import shlex
import subprocess
import tempfile
import wave
from array import array
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

RATE_Hz = 22050
LENGTH_s = 0.06
TONES_Hz = {"cue contact": 880.0, "cue bottom": 440.0}
"""High at contact, low at the bottom."""


def tone(frequency_Hz: float) -> bytes:
    """Make a short WAV: a sine that fades in and out."""
    count = round(LENGTH_s * RATE_Hz)
    loud = (math.sin(math.pi * i / count) for i in range(count))
    wave_ = (math.sin(2 * math.pi * frequency_Hz * i / RATE_Hz) for i in range(count))
    samples = array("h", (round(20000 * a * b) for a, b in zip(loud, wave_, strict=True)))
    written = io.BytesIO()
    with wave.open(written, "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(RATE_Hz)
        file.writeframes(samples.tobytes())
    return written.getvalue()


@contextmanager
def beeper(player: str | None, bell: Callable[[], None]) -> Iterator[Callable[[str], None]]:
    """Give what beeps for an event: player, a command that is given a WAV file, or else the bell.

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
