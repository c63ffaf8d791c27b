"""The receipt of a self-test that every part passed, and the calibration that follows from it."""

from __future__ import annotations

import math
from dataclasses import asdict, fields, replace
from pathlib import Path
from typing import Any, Literal

import msgspec

from fdvv.errors import DeviceError, InputError
from fdvv.io.documents import Kind, finite, pretty, read_document
from fdvv.io.files import read_limited, write_atomic
from fdvv.protocol.messages import CN64_PER_cN, UM16_PER_mm
from fdvv.protocol.tables import Settings
from fdvv_rig.selftest.diagnosis import Diagnosis, diagnose
from fdvv_rig.selftest.evidence import Evidence, Latched, Lift

KIND = Kind("fdvv-selftest", 1, "a receipt of a self-test", "run fdvv hardware selftest again")
LARGEST_bytes = 1_000_000


class SelftestReceipt(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What was measured as every part passed.

    Attributes
    ----------
    device, serial, simulated : what was tested. tested : UTC.
    evidence : the fields of Evidence; the verdict is drawn from it again on reading.
    settings : fields of the firmware's settings that the measurement changes, as they ought to be.
    """

    format: Literal["fdvv-selftest"]
    version: Literal[1]
    device: str
    serial: int
    simulated: bool
    tested: str
    evidence: dict[str, Any]
    settings: dict[str, int]


def calibrated(settings: Settings, evidence: Evidence) -> Settings:
    """Return settings with the scales and zeros that gauges and weight have shown.

    A part that is absent keeps its own. The travel stop is left as it is: its play is larger than the gain.
    """
    slope, zero_mm = evidence.gauge_line
    found = replace(
        settings,
        position_gain_q14=round(settings.position_gain_q14 / slope),
        position_offset_um16=round((settings.position_offset_um16 - zero_mm * UM16_PER_mm) / slope),
        duty_gain_q16=round(settings.duty_gain_q16 / (evidence.gain or 1.0)),
    )
    if not settings.force_gain_q14:
        return found
    per_cN = 2**14 * CN64_PER_cN / settings.force_gain_q14
    gain = (evidence.sensor_weight_cN - evidence.sensor_zero_cN) / evidence.weight_cN
    return replace(
        found,
        force_gain_q14=round(settings.force_gain_q14 / gain),
        force_offset_counts=round(settings.force_offset_counts + evidence.sensor_zero_cN * per_cN),
    )


def changed(before: Settings, after: Settings) -> dict[str, int]:
    """Return the fields in which settings differ, as they are afterwards."""
    names = [f.name for f in fields(before)]
    return {name: getattr(after, name) for name in names if getattr(after, name) != getattr(before, name)}


def write_selftest(path: Path, found: Diagnosis, evidence: Evidence, head: dict[str, Any]) -> None:
    """Write the receipt; DeviceError, and no file, unless every part passed.

    head : device, serial, simulated, tested and settings, as SelftestReceipt has them.
    """
    if not found.passed or not diagnose(evidence).passed:
        raise DeviceError(f"{path}: no receipt is written, not every part passed; mend it and test again")
    receipt = SelftestReceipt(format="fdvv-selftest", version=1, evidence=finite(asdict(evidence)), **head)
    write_atomic(path, pretty(msgspec.to_builtins(receipt)))


def read_selftest(path: Path) -> tuple[SelftestReceipt, Evidence]:
    """Read a receipt and judge its evidence again; InputError if it is none or does not pass."""
    data = read_limited(path, LARGEST_bytes, KIND.remedy)
    receipt = read_document(
        data, path, KIND, lambda raw: msgspec.json.decode(raw, type=SelftestReceipt), lambda _place: None
    )
    evidence = _evidence(receipt.evidence, path)
    wrong = diagnose(evidence)
    if not wrong.passed:
        part = next(f for f in wrong.findings if f.verdict not in ("passed", "absent"))
        raise InputError(path, "$.evidence", f"{part.part}: {part.evidence}", KIND.remedy)
    return receipt, evidence


def _evidence(raw: dict[str, Any], path: Path) -> Evidence:
    try:
        known: dict[str, Any] = {
            name: math.nan if value is None and name != "vibration_answers" else value
            for name, value in raw.items()
        }
        for name in ("empty", "loaded"):
            known[name] = Lift(**known[name])
        known["faults"] = tuple(Latched(**one) for one in known["faults"])
        known["notes"] = tuple(known["notes"])
        known["gauge_mm"] = tuple(known["gauge_mm"])
        known["stops_mm"] = tuple((a, b) for a, b in known["stops_mm"])
        return Evidence(**known)
    except (KeyError, TypeError, ValueError) as error:
        raise InputError(path, "$.evidence", f"is not whole ({error})", KIND.remedy) from None
