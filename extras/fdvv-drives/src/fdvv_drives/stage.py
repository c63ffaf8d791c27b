"""The TOML file of a stage: where its drive is, what moves, and what must never be exceeded."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, Literal, TypeVar

import msgspec

from fdvv.errors import InputError
from fdvv.firmware.limits import limits_like
from fdvv.io.documents import read_toml
from fdvv.io.files import read_limited
from fdvv.protocol.messages import CN64_PER_cN, UM16_PER_mm
from fdvv.protocol.tables import BoardLimits, Settings

LARGEST_BYTES = 100_000
REMEDY = "see docs/how-to/use-a-drive.md"
LARGEST_N = 5.0
"""The firmware's core can command no more."""
FULL_DUTY_N = 5.12
"""The core's duty at this force is 1: here duty is only what its model of the coil's heat goes by."""
SPAN_mm = 16.0
"""The core's arithmetic holds no longer range of positions."""
COUNTS_READING = 4
"""Positions are handed to the core in 1/16 µm, as the sum of this many readings."""
LONGEST_TICK_us, SHORTEST_TICK_us = 1000, 100
"""Of the core; a slower loop counts several of its ticks per cycle."""

Part = TypeVar("Part", bound=msgspec.Struct)
PositionUnit = Literal["rev", "rad"]
TorqueUnit = Literal["Nm", "A", "V"]


class Mechanics(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What moves.

    Attributes
    ----------
    travel_mm : from the cap's top to the stage's own bottom stop.
    lead_mm_rev, radius_mm : one of both: of a screw, or of a pinion, pulley or capstan.
    force_N_Nm, force_N_A, force_N_V : force at the cap per unit of the drive's torque command; may be left
        out for a command in Nm, then it follows from lead or radius without friction.
    direction : 1 if the drive's position rises as the cap goes down, else -1.
    zero_rev, zero_rad : the drive's position with the cap at the top; left out, the cap is at the top, and
        nobody touches it, when the device is opened.
    """

    travel_mm: float
    lead_mm_rev: float | None = None
    radius_mm: float | None = None
    force_N_Nm: float | None = None
    force_N_A: float | None = None
    force_N_V: float | None = None
    direction: Literal[1, -1] = 1
    zero_rev: float | None = None
    zero_rad: float | None = None
    name: str = "stage"
    simulated: bool = False


class Limits(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What ends a press in zero force.

    Attributes
    ----------
    force_N : largest command, both signs; larger ones are cut.
    velocity_mm_s : of the cap. overtravel_mm : beyond the top or the travel.
    answer_ms : time for an answer of the drive. lost_answers : so many in a row are passed over.
    late_ms : since the last answer.
    """

    force_N: float
    velocity_mm_s: float = 1000.0
    overtravel_mm: float = 1.0
    answer_ms: float = 5.0
    lost_answers: int = 2
    late_ms: float = 20.0


class Coil(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """How warm the motor gets: rise_K in the end at a force at_N held for ever; no force beyond limit_K."""

    rise_K: float
    at_N: float
    time_s: float
    limit_K: int = 80


class Loop(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """rate_Hz : how often the drive is asked; patience_s : how long to wait for a person to press."""

    rate_Hz: float = 500.0
    patience_s: float = 30.0


RANGES = {
    "stage.travel_mm": (1.0, 14.0),
    "stage.lead_mm_rev": (0.1, 1000.0),
    "stage.radius_mm": (0.1, 200.0),
    "stage.force_N_Nm": (0.1, 1e5),
    "stage.force_N_A": (1e-3, 1e4),
    "stage.force_N_V": (1e-3, 1e4),
    "limits.force_N": (0.1, LARGEST_N),
    "limits.velocity_mm_s": (10.0, 4000.0),
    "limits.overtravel_mm": (0.1, 3.0),
    "limits.answer_ms": (0.5, 1000.0),
    "limits.lost_answers": (0, 20),
    "limits.late_ms": (2.0, 1000.0),
    "coil.rise_K": (1.0, 500.0),
    "coil.at_N": (0.05, LARGEST_N),
    "coil.time_s": (0.1, 600.0),
    "coil.limit_K": (10, 600),
    "loop.rate_Hz": (100.0, 5000.0),
    "loop.patience_s": (0.1, 3600.0),
}


class Stage:
    """A stage in the units of its drive.

    Attributes
    ----------
    mechanics, limits, coil, loop : tables of the file; coil is None where the motor's heat is not known.
    mm_unit : travel per unit of the drive's position. N_unit : force per unit of its torque command.
    tick_us, ticks : the core's tick, and how many make a cycle of the loop.
    """

    def __init__(
        self,
        mechanics: Mechanics,
        limits: Limits,
        coil: Coil | None = None,
        loop: Loop = Loop(),  # noqa: B008 - it is frozen
        position_unit: PositionUnit = "rev",
        torque_unit: TorqueUnit = "Nm",
        source: object = "stage",
    ) -> None:
        self.mechanics, self.limits, self.coil, self.loop = mechanics, limits, coil, loop
        self.source = source
        self._check_ranges()
        mm_rev = self._mm_rev()
        self.mm_unit = mm_rev if position_unit == "rev" else mm_rev / (2 * math.pi)
        self.N_unit = self._force_of(torque_unit, 2000 * math.pi / mm_rev)
        period_us = 1e6 / loop.rate_Hz
        self.ticks = math.ceil(period_us / LONGEST_TICK_us - 1e-9)
        self.tick_us = max(SHORTEST_TICK_us, round(period_us / self.ticks))
        self.zero = mechanics.zero_rev if position_unit == "rev" else mechanics.zero_rad
        other = mechanics.zero_rad if position_unit == "rev" else mechanics.zero_rev
        if other is not None:
            raise self._wrong(
                "stage", f"the drive's position is in {position_unit}", f"use zero_{position_unit}"
            )
        self.own_settings()  # a mistake is found while the file is read

    @property
    def period_s(self) -> float:
        return self.ticks * self.tick_us * 1e-6

    def displacement_mm(self, position: float, zero: float) -> float:
        return self.mechanics.direction * (position - zero) * self.mm_unit

    def torque(self, force_N: float) -> float:
        """Return the drive's command for a force against the finger, never beyond the limit of force."""
        if not math.isfinite(force_N):
            return 0.0
        largest_N = self.limits.force_N
        # against the finger is up, where the position falls if direction is 1
        return -self.mechanics.direction * min(largest_N, max(-largest_N, force_N)) / self.N_unit

    def force_N(self, torque: float) -> float:
        """Return the force against the finger of a torque that the drive reports."""
        return -self.mechanics.direction * torque * self.N_unit

    @property
    def torque_limit(self) -> float:
        return self.limits.force_N / self.N_unit

    def counts(self, displacement_mm: float) -> int:
        """Return what the core reads at a displacement: a sum that own_settings maps to 1/16 µm."""
        um16 = round(UM16_PER_mm * displacement_mm) - self._lowest_um16
        return min(COUNTS_READING * 65535, max(0, um16))

    @property
    def _lowest_um16(self) -> int:
        return -round(UM16_PER_mm * (self.limits.overtravel_mm + 0.5))

    def own_settings(self) -> Settings:
        """Return the core's settings: limits of the file as its guards."""
        limits, low_mm = self.limits, -self.limits.overtravel_mm
        high_mm = self.mechanics.travel_mm + limits.overtravel_mm
        if high_mm - low_mm + 1.0 > SPAN_mm:
            reason = f"travel and overtravel span {high_mm - low_mm:g} mm"
            raise self._wrong("stage.travel_mm", reason, f"stay below {SPAN_mm - 1:g} mm")
        return Settings(
            position_gain_q14=2**14,
            position_offset_um16=self._lowest_um16,
            duty_gain_q16=Settings.LIMITS["duty_gain_q16"][1],
            tick_us=self.tick_us,
            force_limit_cN64=round(100 * CN64_PER_cN * limits.force_N),
            reading_low=self.counts(low_mm) // COUNTS_READING,
            reading_high=self.counts(high_mm) // COUNTS_READING,
            jump_um16=65535,  # how long ago the last position was is known here, not there
            stuck_ticks=65535,  # an encoder at rest reads the same for long
            late_ticks=max(self.ticks, min(1000, round(1000 * limits.late_ms / self.tick_us))),
            reads=COUNTS_READING,
            **self._heat(),
        )

    def board_limits(self) -> BoardLimits:
        """Return what no settings may loosen."""
        return limits_like(self.own_settings())

    def _heat(self) -> dict[str, int]:
        if self.coil is None:
            return {"full_duty_rise_K": 1}
        rise_K = self.coil.rise_K * (FULL_DUTY_N / self.coil.at_N) ** 2
        limit_K = self.coil.limit_K
        return {
            "full_duty_rise_K": min(20000, math.ceil(rise_K)),
            "heat_time_ms": round(1000 * self.coil.time_s),
            "heat_limit_K": limit_K,
            "derate_start_K": max(1, round(0.75 * limit_K)),
        }

    def _mm_rev(self) -> float:
        lead_mm, radius_mm = self.mechanics.lead_mm_rev, self.mechanics.radius_mm
        if lead_mm is not None and radius_mm is None:
            return lead_mm
        if radius_mm is not None and lead_mm is None:
            return 2 * math.pi * radius_mm
        raise self._wrong(
            "stage", "needs lead_mm_rev or radius_mm, one of both", "write what the motor turns"
        )

    def _force_of(self, unit: TorqueUnit, ideal_N_Nm: float) -> float:
        given = {u: getattr(self.mechanics, f"force_N_{u}") for u in ("Nm", "A", "V")}
        wrong = [u for u, value in given.items() if value is not None and u != unit]
        if wrong:
            reason = f"force_N_{wrong[0]}, but this drive is commanded in {unit}"
            raise self._wrong("stage", reason, f"write force_N_{unit}")
        found: float | None = given[unit]
        if found is None and unit == "Nm":
            return ideal_N_Nm
        if found is None:
            raise self._wrong("stage", f"needs force_N_{unit}", "measure the force at a small command")
        return found

    def _check_ranges(self) -> None:
        tables = {"stage": self.mechanics, "limits": self.limits, "coil": self.coil, "loop": self.loop}
        for place, (low, high) in RANGES.items():
            table, _, field = place.partition(".")
            value = getattr(tables[table], field, None)
            if value is not None and not low <= value <= high:
                raise self._wrong(place, f"is {value:g}", f"write {low:g} to {high:g}")

    def _wrong(self, place: str, reason: str, remedy: str) -> InputError:
        return InputError(self.source, place, reason, f"{remedy}; {REMEDY}")


def read_tables(path: Path, kind: str, part: type[Part]) -> tuple[Part, dict[str, Any]]:
    """Read a stage file: the drive's table [kind], and the others unread. Raises InputError."""
    text = read_limited(path, LARGEST_BYTES, REMEDY)
    tables = read_toml(text, path, REMEDY)
    unknown = sorted(set(tables) - {kind, "stage", "limits", "coil", "loop"})
    if unknown:
        raise InputError(path, unknown[0], "is no table of a stage file", f"remove it; {REMEDY}")
    for needed in (kind, "stage", "limits"):
        if needed not in tables:
            raise InputError(path, needed, "is missing", f"write the table [{needed}]; {REMEDY}")
    return _table(path, tables, kind, part), tables


def stage_of(
    path: Path, tables: dict[str, Any], position_unit: PositionUnit, torque_unit: TorqueUnit
) -> Stage:
    """Return the stage of a file whose tables were read. Raises InputError."""
    mechanics, limits = _table(path, tables, "stage", Mechanics), _table(path, tables, "limits", Limits)
    coil = _table(path, tables, "coil", Coil) if "coil" in tables else None
    loop = _table(path, tables, "loop", Loop) if "loop" in tables else Loop()
    return Stage(mechanics, limits, coil, loop, position_unit, torque_unit, path)


def _table(path: Path, tables: dict[str, Any], name: str, record: type[Part]) -> Part:
    try:
        return msgspec.convert(tables[name], record)
    except msgspec.ValidationError as error:
        reason, _, where = str(error).partition(" - at ")
        place = f"{name}{where.strip('`').removeprefix('$')}"
        raise InputError(path, place, reason[:1].lower() + reason[1:], REMEDY) from error
