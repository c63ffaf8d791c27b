"""Devices by the name of their drive and a stage file."""

from __future__ import annotations

from pathlib import Path

from fdvv.errors import InputError
from fdvv_drives.device import DriveDevice
from fdvv_drives.moteus_drive import MoteusDrive, MoteusPart
from fdvv_drives.odrive_drive import ODriveDrive, ODrivePart
from fdvv_drives.simplefoc_drive import SimpleFOCDrive, SimpleFOCPart
from fdvv_drives.stage import REMEDY, read_tables, stage_of


def open_moteus(where: str) -> DriveDevice:
    """Open the device of a stage file with a table [moteus]. InputError, BuildError, DeviceError."""
    part, tables = read_tables(_file("moteus", where), "moteus", MoteusPart)
    stage = stage_of(Path(where), tables, "rev", "Nm")
    return DriveDevice(stage, MoteusDrive(part, stage.torque_limit, stage.limits.answer_ms / 1000))


def open_odrive(where: str) -> DriveDevice:
    """Open the device of a stage file with a table [odrive]. InputError, BuildError, DeviceError."""
    part, tables = read_tables(_file("odrive", where), "odrive", ODrivePart)
    stage = stage_of(Path(where), tables, "rev", "Nm")
    return DriveDevice(stage, ODriveDrive(part, stage.limits.answer_ms / 1000))


def open_simplefoc(where: str) -> DriveDevice:
    """Open the device of a stage file with a table [simplefoc]. InputError, DeviceError."""
    part, tables = read_tables(_file("simplefoc", where), "simplefoc", SimpleFOCPart)
    stage = stage_of(Path(where), tables, "rad", part.torque_unit)
    return DriveDevice(stage, SimpleFOCDrive(part, stage.torque_limit, stage.limits.answer_ms / 1000))


def _file(kind: str, where: str) -> Path:
    if not where:
        raise InputError("--device", kind, "names no stage file", f"write {kind}:FILE.toml; {REMEDY}")
    return Path(where)
