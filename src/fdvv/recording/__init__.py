"""Streams as benches record them: their types, their files, readers of foreign logs."""

from fdvv.recording._check import check_recording
from fdvv.recording._facts import facts_of
from fdvv.recording._file import RECORDING_SUFFIX, load_recording, save_recording
from fdvv.recording._file_check import FileCheck, Problem, unusable
from fdvv.recording._join import join
from fdvv.recording._log import RecordingLog
from fdvv.recording._mend import Mend
from fdvv.recording._read import log_formats, read_log
from fdvv.recording._records import schema
from fdvv.recording._select import select
from fdvv.recording._serial import SerialCapture
from fdvv.recording._types import UNITS, Bench, Mark, Quantity, Recording, Source, Stage, Stream, Take

__all__ = [
    "RECORDING_SUFFIX",
    "UNITS",
    "Bench",
    "FileCheck",
    "Mark",
    "Mend",
    "Problem",
    "Quantity",
    "Recording",
    "RecordingLog",
    "SerialCapture",
    "Source",
    "Stage",
    "Stream",
    "Take",
    "check_recording",
    "facts_of",
    "join",
    "load_recording",
    "log_formats",
    "read_log",
    "save_recording",
    "schema",
    "select",
    "unusable",
]
