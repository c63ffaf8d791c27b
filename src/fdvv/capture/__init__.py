"""Readers of foreign force curves: found by looking inside, repaired with a word or refused with one."""

from fdvv.capture._average import Averaged, average_by_velocity, average_cycles
from fdvv.capture._find import find_force_files, is_force_file
from fdvv.capture._pairs import companion
from fdvv.capture._read import read_force_file, reader_names
from fdvv.capture._types import Cycle, ForceFile

__all__ = [
    "Averaged",
    "Cycle",
    "ForceFile",
    "average_by_velocity",
    "average_cycles",
    "companion",
    "find_force_files",
    "is_force_file",
    "read_force_file",
    "reader_names",
]
