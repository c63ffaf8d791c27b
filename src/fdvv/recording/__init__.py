"""Streams as benches record them: their types, their files, readers of foreign logs."""

from fdvv.recording._file import RECORDING_SUFFIX, load_recording, save_recording
from fdvv.recording._join import join
from fdvv.recording._log import RecordingLog
from fdvv.recording._mend import Mend
from fdvv.recording._read import log_formats, read_log
from fdvv.recording._reading import Reading
from fdvv.recording._serial import read_serial
from fdvv.recording._types import UNITS, Bench, Mark, Quantity, Recording, Source, Stage, Stream, Take

__all__ = [
    "RECORDING_SUFFIX",
    "UNITS",
    "Bench",
    "Mark",
    "Mend",
    "Quantity",
    "Reading",
    "Recording",
    "RecordingLog",
    "Source",
    "Stage",
    "Stream",
    "Take",
    "join",
    "load_recording",
    "log_formats",
    "read_log",
    "read_serial",
    "save_recording",
]
