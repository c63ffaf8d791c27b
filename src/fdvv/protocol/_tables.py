"""Made by tools/make_protocol.py from protocol/fdvv.toml; do not edit."""

# ruff: noqa: E501
# fmt: off
from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum, IntFlag
from typing import ClassVar

from fdvv.protocol._record import Limits, Record

VERSION = 1
"""Of the definition."""
HASH = 0xEF2D1201
"""Of what the definition means; host and firmware compare it on connecting."""

FRAME_BYTES = 232
"""Largest frame before stuffing: id, sequence, payload, checksum; COBS adds one byte below 254."""
DATA_BYTES = 192
"""Image bytes in one data message, a multiple of 4."""
IMAGE_BYTES = 7168
"""Largest program; two banks of it leave the SAMD21 room for USB and stack."""
TELEMETRY_RECORDS = 16
"""Records in a full telemetry frame: 4 ms at 4 kHz."""
STATES = 16
"""Most states of a program; a vibration's mask of states has 16 bits."""
TRANSITIONS = 48
"""Most transitions of a program."""
SURFACES = 16
"""Most force surfaces of a program."""
SURFACE_VELOCITIES = 16
"""Most rows of a surface."""
SURFACE_DISPLACEMENTS = 255
"""Most columns of a surface."""
VIBRATIONS = 32
"""Most vibration events of a program."""
SLOTS = 16
"""Most waveforms that the vibration board holds for a program."""
NONE = 255
"""No state, slot or surface."""
IMAGE_MAGIC = 1347830854
"""FDVP, the first bytes of a program."""
IMAGE_VERSION = 1
"""Layout of a program."""


class Mode(IntEnum):
    """What the supervisor lets the device do."""

    BOOT = 0
    SELFTEST = 1
    IDLE = 2
    ARMED = 3
    DERATED = 4
    FAULT = 5


class Fault(IntEnum):
    """Why the device fell to zero force; latched until cleared by its number."""

    NONE = 0
    POSITION_LOW = 1
    POSITION_HIGH = 2
    POSITION_STUCK = 3
    POSITION_JUMP = 4
    OVER_FORCE = 5
    OVER_HEAT = 6
    SUPPLY_LOW = 7
    SUPPLY_HIGH = 8
    HOST_LOST = 9
    IMAGE_CORRUPT = 10
    WATCHDOG = 11
    BROWN_OUT = 12
    LATE = 13
    OUTPUT = 14
    SETTINGS_CORRUPT = 15
    VIBRATION_BOARD = 16
    INTERNAL = 17


class Refusal(IntEnum):
    """Why a request was not carried out."""

    NONE = 0
    UNKNOWN_MESSAGE = 1
    BAD_LENGTH = 2
    BAD_VALUE = 3
    WRONG_MODE = 4
    WRONG_ORDER = 5
    TOO_LARGE = 6
    CHECKSUM = 7
    IMAGE_LAYOUT = 8
    IMAGE_RANGE = 9
    NO_IMAGE = 10
    FAULT_LATCHED = 11
    BUSY = 12
    HASH_MISMATCH = 13


class Condition(IntEnum):
    """When a transition fires; value's unit in brackets."""

    ALWAYS = 0
    DEEPER_THAN = 1
    SHALLOWER_THAN = 2
    TURNED_TO_PRESS = 3
    TURNED_TO_RELEASE = 4
    FASTER_THAN = 5
    SLOWER_THAN = 6
    AFTER_MS = 7
    HOST_EVENT = 8
    RISEN_BY = 9
    FALLEN_BY = 10


class VelocitySource(IntEnum):
    """Which velocity chooses the row of a surface."""

    ANNOUNCED = 0
    DECIDED = 1
    CONTINUOUS = 2


class Stroke(IntEnum):
    """Direction of a vibration event."""

    PRESS = 0
    RELEASE = 1
    EITHER = 2


class Waveform(IntEnum):
    """What a slot plays."""

    DECAYING_SINE = 0
    SAMPLED = 1


class Part(IntEnum):
    """Parts of the self-test."""

    POSITION_SENSOR = 0
    SUPPLY = 1
    FORCE_SENSOR = 2
    VIBRATION_BOARD = 3
    COIL = 4
    MEMORY = 5
    CLOCK = 6


class Verdict(IntEnum):
    """Outcome of one part of the self-test."""

    NOT_TESTED = 0
    PASSED = 1
    FAILED = 2
    ABSENT = 3


class TickFlag(IntFlag):
    """Bits of a telemetry record's flags."""

    RELEASE = 1 << 0
    LIMITED = 1 << 1
    SLEWED = 1 << 2
    DERATED = 1 << 3
    KEY_DOWN = 1 << 4
    VIBRATED = 1 << 5
    LATE = 1 << 6
    VELOCITY_KNOWN = 1 << 7


class BoardFlag(IntFlag):
    """Bits of what a board has."""

    SIMULATED = 1 << 0
    EMULATED = 1 << 1
    FORCE_SENSOR = 1 << 2
    VIBRATION = 1 << 3
    SERVO = 1 << 4


class Message(IntEnum):
    """Numbers of the messages."""

    HELLO = 0x01
    """Who are you; must be the first request."""
    PING = 0x02
    """I am here; feeds the host watch and relates the clocks."""
    READ_SETTINGS = 0x03
    """Tell your settings."""
    WRITE_SETTINGS = 0x04
    """Use these; while idle or in fault, all or none."""
    BEGIN = 0x05
    """A program follows into the bank that is not active; forgets an unfinished one."""
    DATA = 0x06
    """The next bytes of the program; a repeated offset is accepted if the bytes are the same."""
    COMMIT = 0x07
    """Check what was received: checksum, layout, ranges; answers when done."""
    ACTIVATE = 0x08
    """Make the checked program the active one between two ticks."""
    ARM = 0x09
    """Render the active program."""
    DISARM = 0x0A
    """Zero force."""
    EVENT = 0x0B
    """Something happened that the program may wait for."""
    TELEMETRY = 0x0C
    """Send a record of every n-th tick."""
    READ_FAULT = 0x0D
    """Why are you in fault."""
    CLEAR_FAULT = 0x0E
    """The fault is understood; back to idle if its cause is gone."""
    SELFTEST = 0x0F
    """Test your parts; idle only."""
    READ_COUNTERS = 0x10
    """What went wrong so far."""
    ANNOUNCE = 0x11
    """The next press is meant to be this fast."""
    VIBRATE = 0x12
    """Play a waveform of the active program now."""
    REFUSED = 0x7F
    """Reply to a request that was not carried out (sent as id + 0x80)."""
    RECORDS = 0xC0
    """Telemetry; only count of the records are sent."""
    FAULTED = 0xC1
    """A fault was latched; read_fault has the evidence."""
    KEY = 0xC2
    """The reported key changed."""

REQUEST_BYTES = {
    Message.HELLO: 8,
    Message.PING: 4,
    Message.READ_SETTINGS: 0,
    Message.WRITE_SETTINGS: 96,
    Message.BEGIN: 8,
    Message.DATA: 196,
    Message.COMMIT: 0,
    Message.ACTIVATE: 0,
    Message.ARM: 0,
    Message.DISARM: 0,
    Message.EVENT: 2,
    Message.TELEMETRY: 2,
    Message.READ_FAULT: 0,
    Message.CLEAR_FAULT: 2,
    Message.SELFTEST: 0,
    Message.READ_COUNTERS: 0,
    Message.ANNOUNCE: 4,
    Message.VIBRATE: 2,
    Message.REFUSED: 0,
    Message.RECORDS: 20,
    Message.FAULTED: 8,
    Message.KEY: 12,
}
"""Bytes of every request."""

REPLY_BYTES = {
    Message.HELLO: 36,
    Message.PING: 16,
    Message.READ_SETTINGS: 96,
    Message.WRITE_SETTINGS: 0,
    Message.BEGIN: 0,
    Message.DATA: 4,
    Message.COMMIT: 0,
    Message.ACTIVATE: 0,
    Message.ARM: 0,
    Message.DISARM: 0,
    Message.EVENT: 0,
    Message.TELEMETRY: 0,
    Message.READ_FAULT: 28,
    Message.CLEAR_FAULT: 0,
    Message.SELFTEST: 24,
    Message.READ_COUNTERS: 32,
    Message.ANNOUNCE: 0,
    Message.VIBRATE: 0,
    Message.REFUSED: 4,
    Message.RECORDS: 0,
    Message.FAULTED: 0,
    Message.KEY: 0,
}
"""Bytes of every reply."""


@dataclass(frozen=True, kw_only=True)
class Settings(Record):
    """A rig's calibration and limits; written while idle or in fault, refused as a whole if one field is out of range.

    Attributes
    ----------
    position_gain_q14 : um16 per count of the sum; -65535 to 65535; scale of the summed readings; its size times the largest sum stays below 2^32
    position_offset_um16 : um16; -400000 to 400000; displacement at a sum of 0
    duty_gain_q16 : Q15 duty per cN64; 64 to 65535; force to duty at mid stroke, supply nominal
    force_gain_q14 : cN64 per count; -262144 to 262144; scale of the keycap force sensor; 0: there is none
    force_offset_counts : counts; 0 to 65535; its reading at no force
    heat_time_ms : ms; 100 to 600000; thermal time constant of the coil
    tick_us : us; 100 to 1000; period of the loop; the paper's is 1000
    window_start_um16 : um16; 800 to 48000; where the search for velocity begins; the paper's 0.5 mm
    window_end_um16 : um16; 1600 to 64000; where velocity is decided; the paper's 1.0 mm; beyond the start
    reversal_um16 : um16; 80 to 16000; way back that turns a press into a release
    rearm_um16 : um16; 80 to 16000; height above which a new press begins
    velocity_scale_q12 : 1024 to 16384; mean velocity of a stroke per velocity in the window
    announced_mm_s16 : mm_s16; 8 to 16000; velocity assumed until one is found
    force_limit_cN64 : cN64; 64 to 32000; largest command, both signs; the paper's coil gives 440 cN
    slew_cN64_tick : cN64 per tick; 16 to 32000; largest change of the command from tick to tick
    duty_limit_q15 : Q15; 1024 to 32767; largest duty, both signs
    nominal_supply_mV : mV; 3000 to 36000; supply at which duty_gain_q16 holds
    supply_low_mV : mV; 2000 to 36000; below it the device falls to zero force
    supply_high_mV : mV; 3000 to 40000; above it the device falls to zero force
    reading_low : counts; 0 to 65535; a single reading below it is a broken wire
    reading_high : counts; 0 to 65535; a single reading above it is a short
    jump_um16 : um16 per tick; 160 to 65535; no finger moves the cap further in a tick
    stuck_ticks : ticks; 20 to 65535; so many equal sums in a row are a dead sensor
    late_ticks : ticks; 1 to 1000; so many ticks missed at once are a fault
    over_force_cN64 : cN64; 64 to 32000; keycap force sensor above it is a fault; unused without one
    full_duty_rise_K : K; 1 to 20000; how much warmer the coil would end at full duty held for ever
    derate_start_K : K; 1 to 500; rise above which the force limit falls
    heat_limit_K : K; 2 to 600; rise at which the force limit has fallen to 0: a fault; above the start
    host_timeout_ms : ms; 20 to 5000; silence of the host that ends rendering
    vibration_latency_us : us; 0 to 30000; command to first motion of the exciter; the paper's 7000
    stop_us_mm : us/mm; -1000 to 1000; servo pulse per travel
    stop_zero_us : us; 400 to 2600; servo pulse at travel 0
    predictor_q16 : 0 to 65535; 1 - exp(-2 pi bandwidth tick) of the filter that looks ahead; 0: nothing looks ahead, and drag and friction are not taken off
    lead_us : us; 0 to 20000; the surface is read where the cap will be after so long
    brake_lead_us : us; 0 to 20000; the same for the speed that drag goes by
    drag_q13 : cN64 per mm_s16; 0 to 49152; taken off the command per speed; the largest is 15 N s/m
    friction_cN64 : cN64; 0 to 6400; taken off the command in the direction of motion
    friction_mm_s16 : mm_s16; 64 to 16000; speed from which on friction counts in full, below it in proportion
    spare : the settings are sixteen bytes times a whole number: their checksum takes four words at a time
    reads : 1 to 64; converter readings summed per tick; the paper's 25
    sliding_ticks : 1 to 32; ticks of an additional sliding mean; 25 is the paper's literal reading
    fewest_samples : 3 to 16; samples that a velocity needs; the paper's 3
    continuous_samples : 3 to 32; samples of the continuous estimate
    """

    FORMAT: ClassVar[str] = "<iiiiiIHHHHHHHhhHHHHHHHHHhHHHHHhHHHHHHHIBBBB"
    LIMITS: ClassVar[Limits] = {
        "position_gain_q14": (-65535, 65535),
        "position_offset_um16": (-400000, 400000),
        "duty_gain_q16": (64, 65535),
        "force_gain_q14": (-262144, 262144),
        "force_offset_counts": (0, 65535),
        "heat_time_ms": (100, 600000),
        "tick_us": (100, 1000),
        "window_start_um16": (800, 48000),
        "window_end_um16": (1600, 64000),
        "reversal_um16": (80, 16000),
        "rearm_um16": (80, 16000),
        "velocity_scale_q12": (1024, 16384),
        "announced_mm_s16": (8, 16000),
        "force_limit_cN64": (64, 32000),
        "slew_cN64_tick": (16, 32000),
        "duty_limit_q15": (1024, 32767),
        "nominal_supply_mV": (3000, 36000),
        "supply_low_mV": (2000, 36000),
        "supply_high_mV": (3000, 40000),
        "reading_low": (0, 65535),
        "reading_high": (0, 65535),
        "jump_um16": (160, 65535),
        "stuck_ticks": (20, 65535),
        "late_ticks": (1, 1000),
        "over_force_cN64": (64, 32000),
        "full_duty_rise_K": (1, 20000),
        "derate_start_K": (1, 500),
        "heat_limit_K": (2, 600),
        "host_timeout_ms": (20, 5000),
        "vibration_latency_us": (0, 30000),
        "stop_us_mm": (-1000, 1000),
        "stop_zero_us": (400, 2600),
        "predictor_q16": (0, 65535),
        "lead_us": (0, 20000),
        "brake_lead_us": (0, 20000),
        "drag_q13": (0, 49152),
        "friction_cN64": (0, 6400),
        "friction_mm_s16": (64, 16000),
        "spare": (0, 0),
        "reads": (1, 64),
        "sliding_ticks": (1, 32),
        "fewest_samples": (3, 16),
        "continuous_samples": (3, 32),
    }

    position_gain_q14: int = 32512
    position_offset_um16: int = -101600
    duty_gain_q16: int = 20793
    force_gain_q14: int = 0
    force_offset_counts: int = 0
    heat_time_ms: int = 60000
    tick_us: int = 250
    window_start_um16: int = 8000
    window_end_um16: int = 16000
    reversal_um16: int = 1600
    rearm_um16: int = 1600
    velocity_scale_q12: int = 4915
    announced_mm_s16: int = 1600
    force_limit_cN64: int = 28160
    slew_cN64_tick: int = 4000
    duty_limit_q15: int = 32767
    nominal_supply_mV: int = 12000
    supply_low_mV: int = 9000
    supply_high_mV: int = 14000
    reading_low: int = 20
    reading_high: int = 4075
    jump_um16: int = 8000
    stuck_ticks: int = 2000
    late_ticks: int = 4
    over_force_cN64: int = 32000
    full_duty_rise_K: int = 596
    derate_start_K: int = 60
    heat_limit_K: int = 90
    host_timeout_ms: int = 250
    vibration_latency_us: int = 1000
    stop_us_mm: int = 150
    stop_zero_us: int = 1000
    predictor_q16: int = 0
    lead_us: int = 0
    brake_lead_us: int = 0
    drag_q13: int = 0
    friction_cN64: int = 0
    friction_mm_s16: int = 160
    spare: int = 0
    reads: int = 25
    sliding_ticks: int = 1
    fewest_samples: int = 3
    continuous_samples: int = 8


@dataclass(frozen=True, kw_only=True)
class ImageHeader(Record):
    """First bytes of a program; the checksum covers everything after itself.

    Attributes
    ----------
    magic : 0 to 4294967295; FDVP
    crc32 : 0 to 4294967295; of all that follows, zlib's polynomial
    travel_um16 : um16; 1600 to 102400; where the bottom stop is set
    size_bytes : bytes; 32 to 7168; whole image, a multiple of 4
    version : 1 to 1; layout
    start_state : 0 to 15; entered on activation and on arming
    states : 1 to 16; how many follow the header
    transitions : 0 to 48; how many follow the states
    surfaces : 1 to 16; how many follow the transitions
    vibrations : 0 to 32; how many follow the surfaces
    slots : 0 to 16; how many follow the vibrations; velocities, forces and waves follow in any order
    spare : zero
    name : ASCII; 0 to 126; for people, padded with zeros
    """

    FORMAT: ClassVar[str] = "<IIiHBBBBBBBB10s"
    LIMITS: ClassVar[Limits] = {
        "magic": (0, 4294967295),
        "crc32": (0, 4294967295),
        "travel_um16": (1600, 102400),
        "size_bytes": (32, 7168),
        "version": (1, 1),
        "start_state": (0, 15),
        "states": (1, 16),
        "transitions": (0, 48),
        "surfaces": (1, 16),
        "vibrations": (0, 32),
        "slots": (0, 16),
        "spare": (0, 0),
    }

    magic: int
    crc32: int
    travel_um16: int
    size_bytes: int
    version: int
    start_state: int
    states: int
    transitions: int
    surfaces: int
    vibrations: int
    slots: int
    spare: int = 0
    name: bytes


@dataclass(frozen=True, kw_only=True)
class State(Record):
    """A force surface per stroke, an optional change over time, and what to report.

    Attributes
    ----------
    press_surface : 0 to 15; looked up while pressing
    release_surface : 0 to 15; looked up while releasing
    velocity_source : 0 to 2; which velocity chooses the row
    key : 0 to 255; reported to the host: 0 up, else the level that is down
    first_transition : 0 to 48; of this state's run of transitions; the first that holds fires
    transitions : 0 to 48; how many
    enter_slot : 0 to 255; waveform played on entering, or none
    repeat_slot : 0 to 255; waveform played again and again while in this state, or none
    repeat_ms : ms; 0 to 65535; its period; 0 with none
    fade_ms : ms; 0 to 2000; the command moves from the last state's to this one's in this time
    bias_cN64 : cN64; -32000 to 32000; added to the surface's force
    bias_end_cN64 : cN64; -32000 to 32000; what the bias has become after bias_ms
    bias_ms : ms; 0 to 65535; time over which the bias changes; 0: it is bias_cN64
    spare : zero
    """

    FORMAT: ClassVar[str] = "<BBBBBBBBHHhhHH"
    LIMITS: ClassVar[Limits] = {
        "press_surface": (0, 15),
        "release_surface": (0, 15),
        "velocity_source": (0, 2),
        "key": (0, 255),
        "first_transition": (0, 48),
        "transitions": (0, 48),
        "enter_slot": (0, 255),
        "repeat_slot": (0, 255),
        "repeat_ms": (0, 65535),
        "fade_ms": (0, 2000),
        "bias_cN64": (-32000, 32000),
        "bias_end_cN64": (-32000, 32000),
        "bias_ms": (0, 65535),
        "spare": (0, 0),
    }

    press_surface: int
    release_surface: int
    velocity_source: int
    key: int
    first_transition: int
    transitions: int
    enter_slot: int
    repeat_slot: int
    repeat_ms: int
    fade_ms: int
    bias_cN64: int
    bias_end_cN64: int
    bias_ms: int
    spare: int = 0


@dataclass(frozen=True, kw_only=True)
class Transition(Record):
    """Leads to another state when condition and guard both hold; at most one fires per tick.

    Attributes
    ----------
    condition : 0 to 10; when
    guard : 0 to 10; and only if (always: no guard)
    target : 0 to 15; state to enter
    slot : 0 to 255; waveform played on the way, or none
    value : as the condition says; -2147483648 to 2147483647
    guard_value : as the guard says; -2147483648 to 2147483647
    """

    FORMAT: ClassVar[str] = "<BBBBii"
    LIMITS: ClassVar[Limits] = {
        "condition": (0, 10),
        "guard": (0, 10),
        "target": (0, 15),
        "slot": (0, 255),
        "value": (-2147483648, 2147483647),
        "guard_value": (-2147483648, 2147483647),
    }

    condition: int
    guard: int
    target: int
    slot: int
    value: int
    guard_value: int


@dataclass(frozen=True, kw_only=True)
class Surface(Record):
    """Force on displacement and velocity, bilinear, held beyond its edges.

    Attributes
    ----------
    start_um16 : um16; -32000 to 102400; displacement of the first column
    step_um16 : um16; 16 to 16000; between two columns
    columns : 2 to 255; displacements
    rows : 1 to 16; velocities, rising
    velocities_at : bytes; 32 to 7168; offset in the image of u16 mm_s16 per row, a multiple of 2
    forces_at : bytes; 32 to 7168; offset in the image of i16 cN64, row after row, a multiple of 2
    """

    FORMAT: ClassVar[str] = "<iHBBHH"
    LIMITS: ClassVar[Limits] = {
        "start_um16": (-32000, 102400),
        "step_um16": (16, 16000),
        "columns": (2, 255),
        "rows": (1, 16),
        "velocities_at": (32, 7168),
        "forces_at": (32, 7168),
    }

    start_um16: int
    step_um16: int
    columns: int
    rows: int
    velocities_at: int
    forces_at: int


@dataclass(frozen=True, kw_only=True)
class Vibration(Record):
    """A waveform started at a displacement, led by the board's latency at the current velocity; once per stroke.

    Attributes
    ----------
    at_um16 : um16; -32000 to 102400; displacement of the onset
    slowest_mm_s16 : mm_s16; 0 to 65535; fires only at or above this velocity
    fastest_mm_s16 : mm_s16; 0 to 65535; and below this one
    states : 0 to 65535; a bit for every state in which it fires
    stroke : 0 to 2; in which direction
    slot : 0 to 15; waveform
    """

    FORMAT: ClassVar[str] = "<iHHHBB"
    LIMITS: ClassVar[Limits] = {
        "at_um16": (-32000, 102400),
        "slowest_mm_s16": (0, 65535),
        "fastest_mm_s16": (0, 65535),
        "states": (0, 65535),
        "stroke": (0, 2),
        "slot": (0, 15),
    }

    at_um16: int
    slowest_mm_s16: int
    fastest_mm_s16: int
    states: int
    stroke: int
    slot: int


@dataclass(frozen=True, kw_only=True)
class Slot(Record):
    """A waveform of the vibration board, forwarded to it when the program is activated.

    Attributes
    ----------
    waveform : 0 to 1; decaying sine or sampled
    spare : zero
    frequency_Hz16 : 1/16 Hz; 0 to 65535; of the sine; playback rate of a sampled wave
    duration_samples : 1/16000 s; 1 to 65535; after it, silence
    amplitude_counts : counts of a 12-bit converter; 0 to 2047; at the start
    decay_q16 : per 32 samples; 0 to 65535; amplitude after 32 samples over amplitude before
    wave_at : bytes; 0 to 7168; offset in the image of i8 samples; 0 for a sine
    wave_samples : 0 to 512; how many; 0 for a sine
    spare2 : zero
    """

    FORMAT: ClassVar[str] = "<BBHHHHHHH"
    LIMITS: ClassVar[Limits] = {
        "waveform": (0, 1),
        "spare": (0, 0),
        "frequency_Hz16": (0, 65535),
        "duration_samples": (1, 65535),
        "amplitude_counts": (0, 2047),
        "decay_q16": (0, 65535),
        "wave_at": (0, 7168),
        "wave_samples": (0, 512),
        "spare2": (0, 0),
    }

    waveform: int
    spare: int = 0
    frequency_Hz16: int
    duration_samples: int
    amplitude_counts: int
    decay_q16: int
    wave_at: int
    wave_samples: int
    spare2: int = 0


@dataclass(frozen=True, kw_only=True)
class TickRecord(Record):
    """One tick as telemetry tells it.

    Attributes
    ----------
    displacement_um16 : um16; -2147483648 to 2147483647; as sensed
    velocity_mm_s16 : mm_s16; -32768 to 32767; of the continuous estimate, positive downward
    commanded_cN64 : cN64; -32768 to 32767; after all limits
    force_cN64 : cN64; -32768 to 32767; of the keycap force sensor; 0 without one
    state : 0 to 15; of the program
    flags : 0 to 255; bits of flags.tick
    """

    FORMAT: ClassVar[str] = "<ihhhBB"
    LIMITS: ClassVar[Limits] = {
        "displacement_um16": (-2147483648, 2147483647),
        "velocity_mm_s16": (-32768, 32767),
        "commanded_cN64": (-32768, 32767),
        "force_cN64": (-32768, 32767),
        "state": (0, 15),
        "flags": (0, 255),
    }

    displacement_um16: int
    velocity_mm_s16: int
    commanded_cN64: int
    force_cN64: int
    state: int
    flags: int


@dataclass(frozen=True, kw_only=True)
class Evidence(Record):
    """What was so when a fault was latched.

    Attributes
    ----------
    time_us : us; 0 to 4294967295; device clock
    tick : ticks; 0 to 4294967295; since boot
    value : as the fault says; -2147483648 to 2147483647; what was found
    bound : as the fault says; -2147483648 to 2147483647; what was allowed
    displacement_um16 : um16; -2147483648 to 2147483647
    commanded_cN64 : cN64; -32768 to 32767; before it fell to zero
    state : 0 to 255; of the program
    mode : 0 to 5; before the fault
    """

    FORMAT: ClassVar[str] = "<IIiiihBB"
    LIMITS: ClassVar[Limits] = {
        "time_us": (0, 4294967295),
        "tick": (0, 4294967295),
        "value": (-2147483648, 2147483647),
        "bound": (-2147483648, 2147483647),
        "displacement_um16": (-2147483648, 2147483647),
        "commanded_cN64": (-32768, 32767),
        "state": (0, 255),
        "mode": (0, 5),
    }

    time_us: int
    tick: int
    value: int
    bound: int
    displacement_um16: int
    commanded_cN64: int
    state: int
    mode: int


@dataclass(frozen=True, kw_only=True)
class HelloRequest(Record):
    """Who are you; must be the first request (request).

    Attributes
    ----------
    version : 0 to 65535
    spare : zero
    hash : 0 to 4294967295; of this definition
    """

    FORMAT: ClassVar[str] = "<HHI"
    LIMITS: ClassVar[Limits] = {
        "version": (0, 65535),
        "spare": (0, 0),
        "hash": (0, 4294967295),
    }

    version: int
    spare: int = 0
    hash: int


@dataclass(frozen=True, kw_only=True)
class HelloReply(Record):
    """Who are you; must be the first request (reply).

    Attributes
    ----------
    hash : 0 to 4294967295; of the definition the device was built from
    firmware : 0 to 4294967295; version, major.minor.patch in bytes 2, 1, 0
    serial : 0 to 4294967295; of the board
    image_bytes : bytes; 0 to 65535; largest program
    travel_um16_256 : 256 um16; 0 to 65535; deepest stop
    tick_us : us; 0 to 65535
    board_flags : 0 to 255; bits of flags.board
    mode : 0 to 5
    name : ASCII; 0 to 126; kind of board
    """

    FORMAT: ClassVar[str] = "<IIIHHHBB16s"
    LIMITS: ClassVar[Limits] = {
        "hash": (0, 4294967295),
        "firmware": (0, 4294967295),
        "serial": (0, 4294967295),
        "image_bytes": (0, 65535),
        "travel_um16_256": (0, 65535),
        "tick_us": (0, 65535),
        "board_flags": (0, 255),
        "mode": (0, 5),
    }

    hash: int
    firmware: int
    serial: int
    image_bytes: int
    travel_um16_256: int
    tick_us: int
    board_flags: int
    mode: int
    name: bytes


@dataclass(frozen=True, kw_only=True)
class PingRequest(Record):
    """I am here; feeds the host watch and relates the clocks (request).

    Attributes
    ----------
    host_us : us; 0 to 4294967295; echoed
    """

    FORMAT: ClassVar[str] = "<I"
    LIMITS: ClassVar[Limits] = {
        "host_us": (0, 4294967295),
    }

    host_us: int


@dataclass(frozen=True, kw_only=True)
class PingReply(Record):
    """I am here; feeds the host watch and relates the clocks (reply).

    Attributes
    ----------
    host_us : us; 0 to 4294967295
    device_us : us; 0 to 4294967295; when the request had arrived
    tick : ticks; 0 to 4294967295
    mode : 0 to 5
    fault : 0 to 255
    heat_K : K; 0 to 65535; modelled rise of the coil
    """

    FORMAT: ClassVar[str] = "<IIIBBH"
    LIMITS: ClassVar[Limits] = {
        "host_us": (0, 4294967295),
        "device_us": (0, 4294967295),
        "tick": (0, 4294967295),
        "mode": (0, 5),
        "fault": (0, 255),
        "heat_K": (0, 65535),
    }

    host_us: int
    device_us: int
    tick: int
    mode: int
    fault: int
    heat_K: int


@dataclass(frozen=True, kw_only=True)
class BeginRequest(Record):
    """A program follows into the bank that is not active; forgets an unfinished one (request).

    Attributes
    ----------
    size_bytes : bytes; 0 to 65535
    spare : zero
    crc32 : 0 to 4294967295; as in the image
    """

    FORMAT: ClassVar[str] = "<HHI"
    LIMITS: ClassVar[Limits] = {
        "size_bytes": (0, 65535),
        "spare": (0, 0),
        "crc32": (0, 4294967295),
    }

    size_bytes: int
    spare: int = 0
    crc32: int


@dataclass(frozen=True, kw_only=True)
class DataRequest(Record):
    """The next bytes of the program; a repeated offset is accepted if the bytes are the same (request).

    Attributes
    ----------
    offset : bytes; 0 to 65535; must be where the last one ended
    count : bytes; 1 to 192
    bytes : 0 to 255; only count of them are sent
    """

    FORMAT: ClassVar[str] = "<HH192s"
    LIMITS: ClassVar[Limits] = {
        "offset": (0, 65535),
        "count": (1, 192),
    }

    offset: int
    count: int
    bytes: bytes


@dataclass(frozen=True, kw_only=True)
class DataReply(Record):
    """The next bytes of the program; a repeated offset is accepted if the bytes are the same (reply).

    Attributes
    ----------
    received : bytes; 0 to 65535; so far
    spare : zero
    """

    FORMAT: ClassVar[str] = "<HH"
    LIMITS: ClassVar[Limits] = {
        "received": (0, 65535),
        "spare": (0, 0),
    }

    received: int
    spare: int = 0


@dataclass(frozen=True, kw_only=True)
class EventRequest(Record):
    """Something happened that the program may wait for (request).

    Attributes
    ----------
    event : 0 to 31
    spare : zero
    """

    FORMAT: ClassVar[str] = "<BB"
    LIMITS: ClassVar[Limits] = {
        "event": (0, 31),
        "spare": (0, 0),
    }

    event: int
    spare: int = 0


@dataclass(frozen=True, kw_only=True)
class TelemetryRequest(Record):
    """Send a record of every n-th tick (request).

    Attributes
    ----------
    every : ticks; 0 to 255; 0: none
    spare : zero
    """

    FORMAT: ClassVar[str] = "<BB"
    LIMITS: ClassVar[Limits] = {
        "every": (0, 255),
        "spare": (0, 0),
    }

    every: int
    spare: int = 0


@dataclass(frozen=True, kw_only=True)
class ReadFaultReply(Record):
    """Why are you in fault (reply).

    Attributes
    ----------
    fault : 0 to 255
    spare : zero
    count : 0 to 65535; faults since boot
    time_us : us; 0 to 4294967295; evidence from here
    tick : ticks; 0 to 4294967295
    value : -2147483648 to 2147483647
    bound : -2147483648 to 2147483647
    displacement_um16 : um16; -2147483648 to 2147483647
    commanded_cN64 : cN64; -32768 to 32767
    state : 0 to 255
    mode : 0 to 5
    """

    FORMAT: ClassVar[str] = "<BBHIIiiihBB"
    LIMITS: ClassVar[Limits] = {
        "fault": (0, 255),
        "spare": (0, 0),
        "count": (0, 65535),
        "time_us": (0, 4294967295),
        "tick": (0, 4294967295),
        "value": (-2147483648, 2147483647),
        "bound": (-2147483648, 2147483647),
        "displacement_um16": (-2147483648, 2147483647),
        "commanded_cN64": (-32768, 32767),
        "state": (0, 255),
        "mode": (0, 5),
    }

    fault: int
    spare: int = 0
    count: int
    time_us: int
    tick: int
    value: int
    bound: int
    displacement_um16: int
    commanded_cN64: int
    state: int
    mode: int


@dataclass(frozen=True, kw_only=True)
class ClearFaultRequest(Record):
    """The fault is understood; back to idle if its cause is gone (request).

    Attributes
    ----------
    fault : 0 to 255; must be the latched one
    spare : zero
    """

    FORMAT: ClassVar[str] = "<BB"
    LIMITS: ClassVar[Limits] = {
        "fault": (0, 255),
        "spare": (0, 0),
    }

    fault: int
    spare: int = 0


@dataclass(frozen=True, kw_only=True)
class SelftestReply(Record):
    """Test your parts; idle only (reply).

    Attributes
    ----------
    verdicts : 0 to 3; by part
    values : 0 to 255; eight i16, what was found, as the part says
    """

    FORMAT: ClassVar[str] = "<8s16s"
    LIMITS: ClassVar[Limits] = {
    }

    verdicts: bytes
    values: bytes


@dataclass(frozen=True, kw_only=True)
class ReadCountersReply(Record):
    """What went wrong so far (reply).

    Attributes
    ----------
    ticks : ticks; 0 to 4294967295
    late : ticks; 0 to 4294967295; missed or served too late
    frames : 0 to 4294967295; received whole
    bad_frames : 0 to 4294967295; checksum, stuffing or length wrong
    refused : 0 to 4294967295; requests
    lost_records : 0 to 4294967295; telemetry for which there was no room
    worst_tick_us : us; 0 to 4294967295; from the tick to the new duty
    vibration_errors : 0 to 4294967295; of the vibration board and its wire
    """

    FORMAT: ClassVar[str] = "<IIIIIIII"
    LIMITS: ClassVar[Limits] = {
        "ticks": (0, 4294967295),
        "late": (0, 4294967295),
        "frames": (0, 4294967295),
        "bad_frames": (0, 4294967295),
        "refused": (0, 4294967295),
        "lost_records": (0, 4294967295),
        "worst_tick_us": (0, 4294967295),
        "vibration_errors": (0, 4294967295),
    }

    ticks: int
    late: int
    frames: int
    bad_frames: int
    refused: int
    lost_records: int
    worst_tick_us: int
    vibration_errors: int


@dataclass(frozen=True, kw_only=True)
class AnnounceRequest(Record):
    """The next press is meant to be this fast (request).

    Attributes
    ----------
    velocity_mm_s16 : mm_s16; 8 to 16000
    spare : zero
    """

    FORMAT: ClassVar[str] = "<HH"
    LIMITS: ClassVar[Limits] = {
        "velocity_mm_s16": (8, 16000),
        "spare": (0, 0),
    }

    velocity_mm_s16: int
    spare: int = 0


@dataclass(frozen=True, kw_only=True)
class VibrateRequest(Record):
    """Play a waveform of the active program now (request).

    Attributes
    ----------
    slot : 0 to 15
    spare : zero
    """

    FORMAT: ClassVar[str] = "<BB"
    LIMITS: ClassVar[Limits] = {
        "slot": (0, 15),
        "spare": (0, 0),
    }

    slot: int
    spare: int = 0


@dataclass(frozen=True, kw_only=True)
class RefusedReply(Record):
    """Reply to a request that was not carried out (sent as id + 0x80) (reply).

    Attributes
    ----------
    request : 0 to 255; id
    refusal : 0 to 255
    detail : 0 to 65535; where: offset or number of the field
    """

    FORMAT: ClassVar[str] = "<BBH"
    LIMITS: ClassVar[Limits] = {
        "request": (0, 255),
        "refusal": (0, 255),
        "detail": (0, 65535),
    }

    request: int
    refusal: int
    detail: int


@dataclass(frozen=True, kw_only=True)
class RecordsRequest(Record):
    """Telemetry; only count of the records are sent (request).

    Attributes
    ----------
    first_tick : ticks; 0 to 4294967295; of the first record
    first_us : us; 0 to 4294967295; device clock of that tick
    late : ticks; 0 to 4294967295; since boot
    lost : 0 to 4294967295; records since boot for which there was no room
    every : ticks; 1 to 255; between two records
    count : 1 to 16; records
    mode : 0 to 5
    key : 0 to 255; reported by the current state
    """

    FORMAT: ClassVar[str] = "<IIIIBBBB"
    LIMITS: ClassVar[Limits] = {
        "first_tick": (0, 4294967295),
        "first_us": (0, 4294967295),
        "late": (0, 4294967295),
        "lost": (0, 4294967295),
        "every": (1, 255),
        "count": (1, 16),
        "mode": (0, 5),
        "key": (0, 255),
    }

    first_tick: int
    first_us: int
    late: int
    lost: int
    every: int
    count: int
    mode: int
    key: int


@dataclass(frozen=True, kw_only=True)
class FaultedRequest(Record):
    """A fault was latched; read_fault has the evidence (request).

    Attributes
    ----------
    fault : 0 to 255
    mode : 0 to 5; before
    spare : zero
    time_us : us; 0 to 4294967295
    """

    FORMAT: ClassVar[str] = "<BBHI"
    LIMITS: ClassVar[Limits] = {
        "fault": (0, 255),
        "mode": (0, 5),
        "spare": (0, 0),
        "time_us": (0, 4294967295),
    }

    fault: int
    mode: int
    spare: int = 0
    time_us: int


@dataclass(frozen=True, kw_only=True)
class KeyRequest(Record):
    """The reported key changed (request).

    Attributes
    ----------
    key : 0 to 255
    state : 0 to 15
    spare : zero
    tick : ticks; 0 to 4294967295
    time_us : us; 0 to 4294967295
    """

    FORMAT: ClassVar[str] = "<BBHII"
    LIMITS: ClassVar[Limits] = {
        "key": (0, 255),
        "state": (0, 15),
        "spare": (0, 0),
        "tick": (0, 4294967295),
        "time_us": (0, 4294967295),
    }

    key: int
    state: int
    spare: int = 0
    tick: int
    time_us: int
