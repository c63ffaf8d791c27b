"""The steps of a rig's self-test: what is done, and what is measured."""

from __future__ import annotations

import math
import struct
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from fdvv.device.remote import Remote
from fdvv.device.telemetry import TickColumns
from fdvv.device.wire import RefusedError
from fdvv.errors import DeviceError
from fdvv.program.force_ramp import force_ramp_image
from fdvv.protocol.messages import CN64_PER_cN
from fdvv.protocol.tables import Fault, Part, SelfTestResult, Settings
from fdvv.units import FloatArray
from fdvv_rig.selftest.evidence import Evidence, GAUGES_mm, Latched, Lift, WEIGHT_g
from fdvv_rig.selftest.faults import SLOW_PWM_Hz
from fdvv_rig.selftest.operator import G_cN, Operator
from fdvv_rig.selftest.programs import TONE_s, TONES_Hz, tone_image

DEEP_mm, STOPS_mm = 5.0, (3.5, 2.0)
"""A stop that is a millimetre off must not leave the range of the position sensor."""
REST_s, SETTLE_s, LOOK_s = 0.5, 0.5, 0.15
LOW_cN, HIGH_cN, RAMP_s = -100.0, 240.0, 1.7
HARD_s = 0.6
SAG_ratio = 0.94
"""While the coil pushes hard, the firmware stops at this part of the nominal supply."""
LEFT_mm = 0.3
"""A cap has moved once it is so far from where it lay."""
BESIDE_Hz = (-45.0, -37.0, -29.0, -21.0, -14.0, 14.0, 21.0, 29.0, 37.0, 45.0)
CLOCK_ratio, LEAST_um = 0.005, 1e-3
TONE_START_s = 0.03

Say = Callable[[str, int, int], None]


def measure_rig(
    device: Remote, hands: Operator, say: Say = lambda _text, _done, _total: None, exciter: bool = True
) -> Evidence:
    """Measure every part of a rig that nobody presses.

    Fdvv.hardware.diagnosis.diagnose tells what follows from it.

    hands : lays gauges and the weight. say : called with every step, its number and how many there are.
    exciter : one is expected. A fault that the firmware latches is evidence: it is kept, cleared and gone on
    from; one whose cause lasts ends the test. The device is left without force, its settings as they were.
    Raises DeviceError if the device is gone.
    """
    return _Measuring(device, hands, say, exciter).run()


class _Measuring:
    """One self-test on one device; every step adds to the evidence."""

    def __init__(self, device: Remote, hands: Operator, say: Say, exciter: bool) -> None:
        self._device, self._hands, self._say = device, hands, say
        self._settings: Settings = device.settings()
        self._faults: list[Latched] = []
        self._notes: list[str] = []
        self.evidence = Evidence(
            nominal_mV=float(self._settings.nominal_supply_mV),
            has_sensor=self._settings.force_gain_q14 != 0,
            has_exciter=exciter,
        )

    def run(self) -> Evidence:
        """Go through all steps."""
        steps = (
            ("link and firmware", self._firmware),
            ("rest and gauges", self._gauges),
            ("travel stop", self._stop),
            ("coil without the weight", self._lift_empty),
            ("coil and force sensor with the weight", self._lift_loaded),
            ("supply and PWM", self._hard),
            ("exciter", self._tones),
        )
        try:
            for done, (text, step) in enumerate(steps):
                self._say(text, done, len(steps))
                try:
                    step()
                except RefusedError as refused:
                    self._notes.append(str(refused))
                self._say(text, done + 1, len(steps))
                if not self._cleared():
                    break  # a fault whose cause lasts: nothing more can be tried
        finally:
            self._device.stop()
        self._add(faults=tuple(self._faults), notes=tuple(self._notes))
        return self.evidence

    # -- steps ----------------------------------------------------------------------------------------------

    def _firmware(self) -> None:
        if not self._cleared():
            return
        try:
            reply = self._device.client.selftest()
        except DeviceError as error:
            self._notes.append(str(error))
            return
        values = struct.unpack("<8h", reply.values)
        board = SelfTestResult(reply.verdicts[Part.VIBRATION_BOARD])
        asked = board not in (SelfTestResult.NOT_TESTED, SelfTestResult.ABSENT)
        position = SelfTestResult(reply.verdicts[Part.POSITION_SENSOR])
        self._add(
            supply_mV=float(values[Part.SUPPLY]),
            position_ok=position is not SelfTestResult.FAILED,
            vibration_answers=board is SelfTestResult.PASSED if asked else None,
        )

    def _gauges(self) -> None:
        self._load(force_ramp_image(self._settings, DEEP_mm, 0.0, 0.0, 0.0))
        found = []
        for size_mm in GAUGES_mm:
            self._hands.gauge(size_mm)
            self._settled()
            self._hands.let_go()
            found.append(self._settled())
        rest = self._listened(REST_s)
        self._add(rest_sd_um=_spread_um(rest), link_missing=self._missing(rest, REST_s))
        self._add(late_ticks=self._device.client.telemetry.late_ticks)
        self._hands.gauge(None)
        self._add(gauge_mm=tuple(found), free_stop_mm=DEEP_mm, fallen_mm=self._settled())

    def _stop(self) -> None:
        found = []
        for travel_mm in STOPS_mm:
            self._load(force_ramp_image(self._settings, travel_mm, 0.0, 0.0, 0.0))
            found.append((travel_mm, self._settled()))
        self._add(stops_mm=tuple(found))
        self._load(force_ramp_image(self._settings, DEEP_mm, 0.0, 0.0, 0.0))
        self._settled()

    def _lift_empty(self) -> None:
        self._add(sensor_zero_cN=self._force_cN(), empty=self._lifted())

    def _lift_loaded(self) -> None:
        self._hands.weight(WEIGHT_g)
        self._settled()
        self._add(weight_cN=G_cN * WEIGHT_g, sensor_weight_cN=self._force_cN(), loaded=self._lifted())
        self._hands.weight(None)
        self._settled()

    def _hard(self) -> None:
        low_mV = round(SAG_ratio * self._settings.nominal_supply_mV)
        self._device.configure(replace(self._settings, supply_low_mV=low_mV))
        try:
            hard_cN = self._settings.force_limit_cN64 / CN64_PER_cN
            columns = self._armed(force_ramp_image(self._settings, DEEP_mm, 0.0, hard_cN, 0.3), 0.3 + HARD_s)
            found = self._device.fault()
            sag = float(found.value) if found.fault is Fault.SUPPLY_LOW else math.nan
            self._add(sag_mV=sag)
            late = columns
            if columns.tick.size:
                late = columns.part(columns.tick > columns.tick[-1] - round(HARD_s / self._tick_s))
            line, beside = _line_and_floor(late, self._tick_s, SLOW_PWM_Hz)
            self._add(pwm_um=line, pwm_floor_um=beside)
            self._add(hard_mm=_mean(late.displacement_mm[-50:]))
        finally:
            self._cleared()
            self._device.configure(self._settings)

    def _tones(self) -> None:
        self._load(tone_image(self._settings, DEEP_mm))
        client, port = self._device.client, self._device.client.port
        if not self._arm():
            return
        played = []
        try:
            client.listen(port.now_s() + SETTLE_s)
            for slot in range(len(TONES_Hz)):
                client.vibrate(slot)
                client.listen(port.now_s() + TONE_START_s)
                played.append(self._listened(TONE_s - 2 * TONE_START_s))
                client.listen(port.now_s() + 2 * TONE_START_s)
        finally:
            self._device.stop()
        heard = heard_tones(played, self._tick_s)
        self._add(tone_um=heard[0], tone_floor_um=heard[1], tone_ratio=heard[2])

    # -- how ------------------------------------------------------------------------------------------------

    @property
    def _tick_s(self) -> float:
        return self._settings.tick_us * 1e-6

    def _add(self, **found: object) -> None:
        self.evidence = replace(self.evidence, **found)  # type: ignore[arg-type]

    def _load(self, image: bytes) -> None:
        self._cleared()
        self._device.upload_program(image)

    def _cleared(self) -> bool:
        """Keep a latched fault as evidence and clear it; tell whether nothing hinders the next step.

        A silent vibration board is only a warning: the rig goes on with it.
        """
        report = self._device.fault()
        if report.fault is Fault.NONE:
            return True
        found = Latched(report.fault.name.lower(), report.value, report.bound)
        if found not in self._faults:
            self._faults.append(found)
        try:
            self._device.clear_fault()
        except DeviceError as error:
            if report.fault is not Fault.VIBRATION_BOARD:
                self._notes.append(str(error))
            return report.fault is Fault.VIBRATION_BOARD
        return True

    def _arm(self) -> bool:
        self._cleared()
        try:
            self._device.client.arm()
        except DeviceError as error:
            self._notes.append(str(error))
            return False
        return True

    def _listened(self, span_s: float) -> TickColumns:
        client, port = self._device.client, self._device.client.port
        client.telemetry.clear()
        client.stream(1)
        client.listen(port.now_s() + span_s)
        columns = client.telemetry.columns()
        client.stream(0)
        return columns

    def _missing(self, columns: TickColumns, span_s: float) -> float:
        due = span_s / self._tick_s
        return max(0.0, 1 - columns.tick.size / due)

    def _settled(self) -> float:
        port = self._device.client.port
        self._device.client.listen(port.now_s() + SETTLE_s)
        return _mean(self._listened(LOOK_s).displacement_mm)

    def _force_cN(self) -> float:
        return _mean(self._listened(LOOK_s).force_cN)

    def _armed(self, image: bytes, span_s: float) -> TickColumns:
        self._load(image)
        if not self._arm():
            return self._listened(LOOK_s)
        try:
            return self._listened(span_s)
        finally:
            self._device.stop()

    def _lifted(self) -> Lift:
        up = self._armed(force_ramp_image(self._settings, DEEP_mm, LOW_cN, HIGH_cN, RAMP_s), RAMP_s)
        self._device.stop()
        down = self._armed(force_ramp_image(self._settings, DEEP_mm, HIGH_cN, LOW_cN, RAMP_s), RAMP_s)
        self._settled()
        return lift_of(up, down)


def lift_of(up: TickColumns, down: TickColumns) -> Lift:
    """Find the commands at which the cap leaves its place as the force grows, and as it falls."""
    grown, fallen = _left(up), _left(down)
    if grown is None or fallen is None:
        return Lift(grown[0] if grown else math.nan, fallen[0] if fallen else math.nan)
    return Lift(grown[0], fallen[0], reversed=grown[1] > 0 and fallen[1] < 0)


def _left(columns: TickColumns) -> tuple[float, float] | None:
    """Return the command at which the cap left its place for good, and the way it went, mm."""
    command, place = columns.commanded_cN, columns.displacement_mm
    if place.size < 200:
        return None
    skip = place.size // 17  # it comes to where the first command wants it
    command, place = command[skip:], place[skip:]
    start, end = float(np.median(place[:30])), float(np.median(place[-30:]))
    if abs(end - start) < 4 * LEFT_mm:
        return None
    away = np.flatnonzero(np.abs(place - start) > LEFT_mm)
    first = away[np.concatenate([[True], np.diff(away) > 1])][-1]  # the last time that it left
    return float(command[max(0, first - 1)]), end - start


def _mean(values: FloatArray) -> float:
    return float(np.mean(values)) if values.size else math.nan


def _spread_um(columns: TickColumns) -> float:
    place = columns.displacement_mm
    return 1e3 * float(np.std(np.diff(place)) / np.sqrt(2)) if place.size > 20 else math.nan


def heard_tones(played: Sequence[TickColumns], tick_s: float) -> tuple[float, float, float]:
    """Return the cap's motion at the tones, um, that beside them, and how far their power stands out of it.

    The board that plays has a clock of its own, up to CLOCK_ratio off: the one at which they stand out most
    counts. Without an exciter the last number, a mean of power over power beside, is about 1.
    """
    found = []
    for off in np.linspace(-CLOCK_ratio, CLOCK_ratio, 11):
        tones = zip(played, TONES_Hz, strict=True)
        lines = [_line_and_floor(tone, tick_s, f * (1 + off)) for tone, f in tones]
        loud, quiet = np.array(lines).T
        ratio = float(np.mean(np.square(loud / np.maximum(quiet, LEAST_um))))
        found.append((_rms(loud), _rms(quiet), ratio))
    return max(found, key=lambda one: one[2])


def _line_and_floor(columns: TickColumns, tick_s: float, frequency_Hz: float) -> tuple[float, float]:
    beside = [line_um(columns, tick_s, frequency_Hz + by) for by in BESIDE_Hz]
    return line_um(columns, tick_s, frequency_Hz), _rms(np.array(beside))


def _rms(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(np.square(values))))


def line_um(columns: TickColumns, tick_s: float, frequency_Hz: float) -> float:
    """Return the amplitude of the displacement at a frequency, as ticks fold it, without its slow trend."""
    place = columns.displacement_mm
    if place.size < 100:
        return float("nan")
    t_s = (columns.tick - columns.tick[0]) * tick_s
    free = place - np.polyval(np.polyfit(t_s, place, 3), t_s)
    window = np.hanning(place.size)
    line = np.sum(window * free * np.exp(-2j * np.pi * frequency_Hz * t_s))
    return 1e3 * float(2 * abs(line) / window.sum())
