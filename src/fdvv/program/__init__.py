"""What a device runs: programs, their files, images and checks; slots of the vibration board."""

from fdvv.program._button import button_program, compile_button
from fdvv.program._check import Finding, Report, Severity, check_program, require_accepted
from fdvv.program._compile import Compiled, compile_program
from fdvv.program._condition import Condition, Transition, When
from fdvv.program._describe import Description, describe
from fdvv.program._file import SUFFIX, load_program, program_from_json, program_to_json, save_program
from fdvv.program._library import Parameter, Recipe, load_shipped, make, programs
from fdvv.program._limits import Limits
from fdvv.program._program import During, Program, Signal, State, Velocity, VibrationEvent
from fdvv.program._ranges import ranges
from fdvv.program._records import VERSION, schema
from fdvv.program._surface import Surface, flat, line, of_model, of_surface, raised, scaled
from fdvv.program._synth import (
    RATE_HZ,
    SINE_Q12,
    SILENCE_counts,
    Slot,
    Waveform,
    render,
)
from fdvv.program._vibration_slot import ConvertedVibration, slot_of_vibration
from fdvv.program._vibration_wire import (
    BoardStatus,
    bank_messages,
    checksum,
    load_messages,
    play_message,
    read_status,
    set_message,
)

__all__ = [
    "RATE_HZ",
    "SINE_Q12",
    "SUFFIX",
    "VERSION",
    "BoardStatus",
    "Compiled",
    "Condition",
    "ConvertedVibration",
    "Description",
    "During",
    "Finding",
    "Limits",
    "Parameter",
    "Program",
    "Recipe",
    "Report",
    "SILENCE_counts",
    "Severity",
    "Signal",
    "Slot",
    "State",
    "Surface",
    "Transition",
    "Velocity",
    "VibrationEvent",
    "Waveform",
    "When",
    "bank_messages",
    "button_program",
    "check_program",
    "checksum",
    "compile_button",
    "compile_program",
    "describe",
    "flat",
    "line",
    "load_messages",
    "load_program",
    "load_shipped",
    "make",
    "of_model",
    "of_surface",
    "play_message",
    "program_from_json",
    "program_to_json",
    "programs",
    "raised",
    "ranges",
    "read_status",
    "render",
    "require_accepted",
    "save_program",
    "scaled",
    "schema",
    "set_message",
    "slot_of_vibration",
]
