"""Read a log of a bench, whatever wrote it."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

from fdvv.errors import InputError, ModelError
from fdvv.io.files import read_limited
from fdvv.io.text import decode_lines
from fdvv.recording.file import load_recording
from fdvv.recording.forcepeaks import is_forcepeaks, read_forcepeaks
from fdvv.recording.motive import is_motive, read_motive
from fdvv.recording.reading import REMEDY, Reading, refusal
from fdvv.recording.serial import is_serial, read_serial
from fdvv.recording.sound import read_sound, sound_kind
from fdvv.recording.table import find_header, is_counts, read_counts, read_table
from fdvv.recording.types import Recording, Source, Take

LARGEST_bytes = 512_000_000  # assumed; 1.5 hours of sound in 16 bits at 48 kHz, all of it in memory
JOURNAL = b'{"crc32": '
Lines = Sequence[str]

READERS: tuple[tuple[Callable[[Lines], bool], Callable[[Path, Lines], Reading]], ...] = (
    (is_motive, read_motive),
    (is_forcepeaks, read_forcepeaks),
    (is_serial, read_serial),
    (lambda head: find_header(head) is not None, read_table),
)
"""Text formats known by their first lines."""


def read_log(
    path: Path | str, name: str = "", rate_Hz: float | None = None, full_scale_V: float | None = None
) -> Recording:
    """Read one log as a recording of one take, its format found by looking inside.

    Parameters
    ----------
    path : the file; one that is a recording already is loaded as it is.
    name : of the button; that of the file if it is empty.
    rate_Hz : of a log of bare numbers whose name does not state it.
    full_scale_V : voltage at full scale of a sound file; without it sound stays counts.

    ``warnings`` say what was repaired or is unknown. Raises InputError, one line, if the file cannot
    be used; BuildError where soundfile is needed and is not installed.
    """
    path = Path(path)
    _check(path, rate_Hz, full_scale_V)
    content = read_limited(path, LARGEST_bytes, "cut it into parts")
    if content.startswith(JOURNAL):
        return load_recording(path)
    try:
        reading = _read(path, content, rate_Hz, full_scale_V)
        take = Take(1, tuple(reading.streams), tuple(reading.marks), made=reading.made, remark=reading.remark)
    except ModelError as error:
        raise refusal(path, "whole file", f"no valid recording: {error}") from None
    source = Source(path.name, hashlib.sha256(content).hexdigest(), reading.format)
    called = name or path.stem.strip() or "log"
    return Recording(called, (take,), reading.bench, (source,), warnings=tuple(reading.warnings))


def _check(path: Path, rate_Hz: float | None, full_scale_V: float | None) -> None:
    for option, value in (("rate_Hz", rate_Hz), ("full_scale_V", full_scale_V)):
        if value is not None and not 0 < value < 1e9:
            reason = f"must be finite and above 0, got {value}"
            raise InputError(path, option, reason, "leave it out or mend it")


def _read(path: Path, content: bytes, rate_Hz: float | None, full_scale_V: float | None) -> Reading:
    if sound_kind(content):
        return read_sound(path, content, full_scale_V)
    lines, repaired = decode_lines(path, content, REMEDY)
    while lines and not lines[0].strip():
        lines = lines[1:]
    head = [line.strip() for line in lines if line.strip()][:60]
    if not head:
        raise refusal(path, "whole file", "it is empty")
    read = next((read for recognise, read in READERS if recognise(head)), None)
    if read is None and not is_counts(head):
        raise refusal(path, "line 1", "none of the known formats of logs")
    reading = read(path, lines) if read else read_counts(path, lines, rate_Hz)
    return replace(reading, warnings=(*repaired, *reading.warnings))
