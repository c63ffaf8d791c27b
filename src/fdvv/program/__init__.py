"""What a rig plays, as its firmware takes it: slots of the vibration board and their messages."""

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
    "BoardStatus",
    "ConvertedVibration",
    "SILENCE_counts",
    "Slot",
    "Waveform",
    "bank_messages",
    "checksum",
    "load_messages",
    "play_message",
    "read_status",
    "render",
    "set_message",
    "slot_of_vibration",
]
