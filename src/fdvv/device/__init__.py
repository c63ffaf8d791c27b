"""Anything that accepts a table of force or a program and yields presses."""

from fdvv.device._bench import BenchInfo, CaptureDevice, Cue, show_nothing
from fdvv.device._bench_open import BENCHES, open_bench
from fdvv.device._bench_serial import SerialBench
from fdvv.device._bench_twin import Pacing, TwinBench
from fdvv.device._boards import HostBoard, LibraryBoard
from fdvv.device._client import Client
from fdvv.device._clocks import ClockRelation, Exchange, relate
from fdvv.device._contract import Device, DeviceInfo, FaultReport, ProgramDevice
from fdvv.device._emulated import EmulatedBoard
from fdvv.device._image import surface_image
from fdvv.device._linked import LinkedDevice
from fdvv.device._lockstep import Board, LockstepPort
from fdvv.device._monitor import watch
from fdvv.device._open import BUILT_ELF, KINDS, open_device, pressed_by_person
from fdvv.device._plant import Inputs, Outputs, Person, Plant, PressedPlant, Truth
from fdvv.device._port import Port
from fdvv.device._pressed import PressedDevice
from fdvv.device._recording import Recorder, pack_record, read_session, unpack_press, unpack_surface
from fdvv.device._remote import Remote
from fdvv.device._replay import ReplayDevice
from fdvv.device._script import ScriptedPerson, ScriptedPlant
from fdvv.device._serial import SerialPort, serial_ports
from fdvv.device._simulated import SimulatedPerson
from fdvv.device._strip import KeyLine, StripResult, StripRound, StripStart, StripTask
from fdvv.device._strip_library import LibraryStrip
from fdvv.device._strip_open import STRIPS, open_strip, strip_port
from fdvv.device._telemetry import Telemetry, TickColumns
from fdvv.device._twin import TwinDevice
from fdvv.device._wire import RefusedError, Wire

__all__ = [
    "BENCHES",
    "BUILT_ELF",
    "KINDS",
    "STRIPS",
    "BenchInfo",
    "Board",
    "CaptureDevice",
    "Client",
    "ClockRelation",
    "Cue",
    "Device",
    "DeviceInfo",
    "EmulatedBoard",
    "Exchange",
    "FaultReport",
    "HostBoard",
    "Inputs",
    "KeyLine",
    "LibraryBoard",
    "LibraryStrip",
    "LinkedDevice",
    "LockstepPort",
    "Outputs",
    "Pacing",
    "Person",
    "Plant",
    "Port",
    "PressedDevice",
    "PressedPlant",
    "ProgramDevice",
    "Recorder",
    "RefusedError",
    "Remote",
    "ReplayDevice",
    "ScriptedPerson",
    "ScriptedPlant",
    "SerialBench",
    "SerialPort",
    "SimulatedPerson",
    "StripResult",
    "StripRound",
    "StripStart",
    "StripTask",
    "Telemetry",
    "TickColumns",
    "Truth",
    "TwinBench",
    "TwinDevice",
    "Wire",
    "open_bench",
    "open_device",
    "open_strip",
    "pack_record",
    "pressed_by_person",
    "read_session",
    "relate",
    "serial_ports",
    "show_nothing",
    "strip_port",
    "surface_image",
    "unpack_press",
    "unpack_surface",
    "watch",
]
