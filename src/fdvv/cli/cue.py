"""Beeps that tell a person of contact and bottom: the terminal's bell, or a player of sound files."""

from __future__ import annotations

import shlex
import subprocess
import tempfile
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

    from fdvv.vibration import to_wav

    part = np.arange(round(LENGTH_s * RATE_Hz), dtype=np.float64)
    fade = np.sin(np.pi * part / part.size)
    return to_wav(LOUDNESS * fade * np.sin(2 * np.pi * frequency_Hz * part / RATE_Hz), RATE_Hz, 1.0).data


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
