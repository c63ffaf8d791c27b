"""Which part of a rig is wrong, from what a self-test measured: each judged by its own evidence."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum

from fdvv.force_text import force_text
from fdvv_rig.selftest.evidence import Evidence, GAUGES_mm


class Verdict(StrEnum):
    """What became of a part."""

    PASSED = "passed"
    FAILED = "failed"
    NOT_TESTED = "not tested"
    ABSENT = "absent"


@dataclass(frozen=True)
class Bounds:
    """Between what a part is taken for right; set on other rigs than those that benchmarks report.

    Attributes
    ----------
    link_ratio : telemetry that may be missing. supply_ratio : supply off its nominal value.
    quiet_um, loud_um : noise of the position at rest; below the one nothing is alive behind the wire.
    scale_ratio, zero_mm : position on the gauges. stop_mm : travel stop off its command.
    friction_cN : of the slider. gain_low, gain_high : force of the coil over its command.
    force_ratio, force_zero_cN : force sensor with the weight and without.
    tone_ratio : power at the tones over that beside them. pwm_ratio, pwm_um : line of a slow PWM.
    """

    link_ratio: float = 0.02
    supply_ratio: float = 0.08
    quiet_um: float = 0.05
    loud_um: float = 40.0
    scale_ratio: float = 0.09
    zero_mm: float = 0.35
    stop_mm: float = 0.55
    friction_cN: float = 25.0
    gain_low: float = 0.72
    gain_high: float = 1.4
    force_ratio: float = 0.15
    force_zero_cN: float = 10.0
    tone_ratio: float = 4.4
    pwm_ratio: float = 3.5
    pwm_um: float = 1.5


@dataclass(frozen=True)
class Finding:
    """One part: its verdict, what was seen, and what to do about it."""

    part: str
    verdict: Verdict
    evidence: str
    remedy: str = ""


@dataclass(frozen=True)
class Diagnosis:
    """All parts, those first on which others rest."""

    findings: tuple[Finding, ...]

    @property
    def passed(self) -> bool:
        """Return whether every part that is there was tried and is right."""
        return all(f.verdict in (Verdict.PASSED, Verdict.ABSENT) for f in self.findings)

    @property
    def wrong(self) -> Finding | None:
        """Return the part to look at first; None if none failed."""
        return next((f for f in self.findings if f.verdict is Verdict.FAILED), None)


Judgement = tuple[Verdict, str, str]
"""A part's verdict, what was seen, and the remedy."""
Judge = Callable[[Evidence, Bounds], Judgement]


def diagnose(evidence: Evidence, bounds: Bounds | None = None) -> Diagnosis:
    """Judge every part. What rests on a part that failed is not tested: its evidence would be the other's."""
    bounds = bounds or Bounds()
    found: dict[str, Finding] = {}
    for part, judge, needs in JUDGES:
        broken = [name for name in needs if found[name].verdict in (Verdict.FAILED, Verdict.NOT_TESTED)]
        if broken:
            found[part] = Finding(part, Verdict.NOT_TESTED, f"rests on the {broken[0]}")
        else:
            found[part] = Finding(part, *judge(evidence, bounds))
    return Diagnosis(tuple(found.values()))


NO_READING: Judgement = (Verdict.NOT_TESTED, "no reading", "")


def _passed(seen: str) -> Judgement:
    return Verdict.PASSED, seen, ""


def _failed(seen: str, remedy: str) -> Judgement:
    return Verdict.FAILED, seen, remedy


def _latched(evidence: Evidence, *names: str) -> str:
    for one in evidence.faults:
        if one.fault in names:
            return f"the firmware stopped: {one.fault}, {one.value}, allowed {one.bound}"
    return ""


def _link(evidence: Evidence, bounds: Bounds) -> Judgement:
    seen = f"{100 * evidence.link_missing:.1f} % of the records missing, {evidence.late_ticks} late ticks"
    if evidence.link_missing > bounds.link_ratio or evidence.late_ticks > 0:
        return _failed(seen, "use a short USB cable without a hub; flash the firmware anew")
    return _passed(seen)


def _supply(evidence: Evidence, bounds: Bounds) -> Judgement:
    stopped = _latched(evidence, "supply_low", "supply_high", "brown_out")
    volts = f"{evidence.supply_mV / 1e3:.2f} V at rest, {evidence.nominal_mV / 1e3:g} V nominal"
    if math.isfinite(evidence.sag_mV):
        seen = f"falls to {evidence.sag_mV / 1e3:.2f} V while the coil pushes"
        return _failed(seen, "measure the 12 V at C4 under load; mend joints, fuse, stop; a 5 A supply")
    off = abs(evidence.supply_mV / evidence.nominal_mV - 1)
    if off > bounds.supply_ratio or (stopped and not off < bounds.supply_ratio):
        return _failed(stopped or volts, "measure the 12 V at C4, then the divider R3, R4")
    if stopped:
        return _failed(stopped, "measure the 12 V at C4 under load; mend joints and fuse")
    return _passed(volts) if math.isfinite(evidence.supply_mV) else NO_READING


def _position(evidence: Evidence, bounds: Bounds) -> Judgement:
    if stopped := _latched(evidence, "position_low", "position_high") if _wild(evidence, bounds) else "":
        return _failed(stopped, "measure A0: 0.1 to 3.2 V over the travel; look for a wire that is off")
    if len(evidence.gauge_mm) < len(GAUGES_mm):
        return NO_READING
    slope, zero_mm = evidence.gauge_line
    noise = evidence.rest_sd_um
    seen = f"scale {slope:.3f}, zero {zero_mm:+.2f} mm, noise {noise:.1f} µm"
    if noise < bounds.quiet_um:
        return _failed(
            f"no noise at all, {seen}", "its wire is off, or the conditioner is dead: measure U3.OUT"
        )
    if slope < -0.5:
        return _failed(f"runs backwards, {seen}", "exchange SEC1 and SEC2 of U2")
    if abs(slope - 1) > bounds.scale_ratio:
        return _failed(f"wrong scale, {seen}", "set the conditioner's gain; check R1, R2 and the settings")
    if abs(zero_mm) > bounds.zero_mm:
        return _failed(f"wrong zero, {seen}", "shift U2 in its mount, or the conditioner's zero")
    if noise > bounds.loud_um:
        return _failed(f"noisy, {seen}", "part its wires from the coil's; ground the screen at U3 only")
    return _passed(seen)


def _wild(evidence: Evidence, bounds: Bounds) -> bool:
    return not evidence.gauge_mm or evidence.rest_sd_um > bounds.loud_um or not evidence.position_ok


def _slider(evidence: Evidence, bounds: Bounds) -> Judgement:
    resting = evidence.gauge_mm[-1]
    hung = abs(evidence.fallen_mm - resting) < 0.3 and all(
        abs(d - resting) < 0.3 for _, d in evidence.stops_mm
    )
    remedy = "take the cap off and move the slider by hand; free the bushing, mind wires and magnet"
    friction = abs(evidence.empty.friction_cN) * min(1.0, evidence.gain or 1.0)
    if hung and not _moves(evidence):
        return _failed("it stays where it was put, and no force moves it", remedy)
    if evidence.empty.moved and friction > bounds.friction_cN:
        return _failed(f"friction {force_text(friction, '.0f')}", remedy)
    if hung and not evidence.empty.moved:
        return _failed("it stays where it was put", remedy)
    return _passed(
        f"friction {force_text(friction, '.1f')}" if evidence.empty.moved else "falls by its own weight"
    )


def _moves(evidence: Evidence) -> bool:
    return math.isfinite(evidence.empty.lift_cN) or math.isfinite(evidence.empty.drop_cN)


def _stop(evidence: Evidence, bounds: Bounds) -> Judgement:
    stops = [(evidence.free_stop_mm, evidence.fallen_mm), *evidence.stops_mm]
    if any(not math.isfinite(found) for _, found in stops):
        return NO_READING
    seen = ", ".join(f"{found:.2f} for {asked:g} mm" for asked, found in stops)
    found_mm = [found for _, found in stops]
    if max(found_mm) - min(found_mm) < 0.5:
        return _failed(
            f"does not move: {seen}", "measure 5 V at M1 and the pulse at U7.2Y; is the arm jammed?"
        )
    if max(abs(found - asked) for asked, found in stops) > bounds.stop_mm:
        remedy = "put the horn on the tooth that the drawing shows, then set stop_zero_us and stop_us_mm"
        return _failed(f"stands elsewhere: {seen}", remedy)
    return _passed(seen)


def _coil(evidence: Evidence, bounds: Bounds) -> Judgement:
    lift = evidence.empty
    if lift.reversed or (lift.moved and lift.weight_cN < -2):
        return _failed("pushes the other way", "exchange its two wires at U5")
    if not lift.moved:
        remedy = (
            "with the power off measure the coil, 2.9 ohm; then 12 V at U5.VM, the stop button, IN1 and IN2"
        )
        return _failed("no force moves the cap, which falls freely", remedy)
    if not evidence.loaded.moved:
        return _failed(
            "cannot lift the weight", "measure coil and driver; is the coil centred in its magnet?"
        )
    gain = evidence.gain or 0.0
    seen = f"force {gain:.2f} of the command, lifts {force_text(lift.weight_cN, '.1f')}"
    if not bounds.gain_low <= gain <= bounds.gain_high:
        remedy = "measure the coil's resistance and R8; centre the coil; then set duty_gain_q16"
        return _failed(f"wrong force: {seen}", remedy)
    return _passed(seen)


def _driver(evidence: Evidence, bounds: Bounds) -> Judgement:
    if stopped := _latched(evidence, "output"):
        return _failed(stopped, "look for a short of the coil's wires; feel whether U5 is hot")
    if not math.isfinite(evidence.pwm_um):
        return NO_READING
    seen = f"{evidence.pwm_um:.1f} µm at 732 Hz, {evidence.pwm_floor_um:.1f} µm beside it"
    if evidence.pwm_um > max(bounds.pwm_um, bounds.pwm_ratio * evidence.pwm_floor_um):
        return _failed(f"its PWM shakes the cap: {seen}", "flash fdvv's firmware, whose PWM is 23.4 kHz")
    return _passed(seen)


def _force(evidence: Evidence, bounds: Bounds) -> Judgement:
    if not evidence.has_sensor:
        return Verdict.ABSENT, "the settings have none", ""
    zero, loaded = evidence.sensor_zero_cN, evidence.sensor_weight_cN
    if not (math.isfinite(zero) and math.isfinite(loaded)):
        return NO_READING
    gain = (loaded - zero) / evidence.weight_cN
    seen = (
        f"{force_text(loaded, '.1f')} under {force_text(evidence.weight_cN, '.1f')}, "
        f"{force_text(zero, '+.1f')} without"
    )
    if gain < -0.2:
        return _failed(f"reads backwards: {seen}", "turn it round; is the plug reversed?")
    if gain < 0.2:
        return _failed(
            f"feels nothing: {seen}", "measure U4.OUT: it rises by 15 mV per 5 g; check plug and R5"
        )
    if abs(gain - 1) > bounds.force_ratio:
        return _failed(f"wrong scale: {seen}", "check the part number's range, then set force_gain_q14")
    if abs(zero) > bounds.force_zero_cN:
        return _failed(f"wrong zero: {seen}", "free its tip from preload, then set force_offset_counts")
    return _passed(seen)


def _board(evidence: Evidence, _bounds: Bounds) -> Judgement:
    if _latched(evidence, "vibration_board") or evidence.vibration_answers is False:
        remedy = (
            "is the Uno powered? SDA and SCL exchanged? measure both at 3.3 V and 5 V on either side of U8"
        )
        return _failed("does not answer on the wire", remedy)
    if not evidence.has_exciter:
        return Verdict.ABSENT, "none is expected", ""
    return _passed("answers" if evidence.vibration_answers else "no error on the wire")


def _exciter(evidence: Evidence, bounds: Bounds) -> Judgement:
    if not evidence.has_exciter:
        return Verdict.ABSENT, "none is expected", ""
    if not math.isfinite(evidence.tone_ratio):
        return NO_READING
    seen = f"tones move the cap by {evidence.tone_um:.2f} µm, noise by {evidence.tone_floor_um:.2f} µm"
    if evidence.tone_ratio < bounds.tone_ratio:
        remedy = "listen at the exciter; measure it, 7 to 8 ohm; turn up U11's trimmer; is its power there?"
        return _failed(f"silent: {seen}", remedy)
    return _passed(seen)


JUDGES: tuple[tuple[str, Judge, tuple[str, ...]], ...] = (
    ("supply", _supply, ()),
    ("link", _link, ()),
    ("position sensor", _position, ()),
    ("slider", _slider, ("position sensor",)),
    ("travel stop", _stop, ("position sensor", "slider")),
    ("coil", _coil, ("supply", "position sensor", "slider")),
    ("coil driver", _driver, ("position sensor", "coil")),
    ("force sensor", _force, ()),
    ("vibration board", _board, ()),
    ("exciter", _exciter, ("vibration board", "position sensor")),
)
"""Parts in the order in which they are looked at, and what each one's evidence rests on."""
