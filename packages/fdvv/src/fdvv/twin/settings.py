"""The firmware's settings for a rig, in the integers of the protocol."""

from __future__ import annotations

import math
from dataclasses import replace

from fdvv.errors import ModelError
from fdvv.firmware.limits import limits_like
from fdvv.protocol.messages import CN64_PER_cN, UM16_PER_mm
from fdvv.protocol.tables import BoardLimits, CellSpec, Settings
from fdvv.twin.rig import Rig

UM16_m = 1000 * UM16_PER_mm
"""Sixteenths of a micrometre in a metre."""
CN64_N = 100 * CN64_PER_cN
"""Sixty-fourths of a centinewton in a newton."""
FASTEST_m_s = 4.0
"""No cap moves faster; beyond it a reading is a fault."""
HOTTEST_K = 65_000
"""The firmware's thermal model holds 16 bits of a kelvin."""
RISE_K = BoardLimits.LIMITS["full_duty_rise_K"][1]
SUPPLY_mV = Settings.LIMITS["supply_high_mV"][1]
STUCK_s = 10.0
"""Equal readings for so long are a dead sensor; without noise a resting cap gives equal readings for long."""


def settings_of(rig: Rig) -> Settings:
    """Return the calibration and limits of a rig; ModelError names what its firmware cannot hold.

    A held force equals the table where the coil is at its best: the duty gain counts coil and bridge when
    cold, at the nominal supply.
    """
    try:
        return Settings(**_position(rig), **_loop(rig), **_output(rig), **_extras(rig))
    except ModelError as error:
        raise ModelError(f"the firmware cannot hold the settings of this rig: {error}") from error


LAG_RATIO, SHARE_RATIO = 1.5, 0.9
"""A thermistor may lag so much longer than the rig's, and warm so much less: beads are bedded by hand."""


def limits_of(rig: Rig) -> BoardLimits:
    """Return the limits of a board that is built for this rig; ModelError as for settings_of."""
    limits = replace(limits_like(settings_of(rig)), **thermistor_limits(rig))
    hottest_K = limits.full_duty_rise_K * (limits.supply_high_mV / limits.nominal_supply_mV) ** 2
    if hottest_K > HOTTEST_K or limits.full_duty_rise_K == RISE_K:
        raise ModelError(
            f"a coil that would end {hottest_K:.0f} K warmer is beyond the thermal model's {RISE_K} K"
        )
    return limits


def thermistor_limits(rig: Rig) -> dict[str, int]:
    """Return the fields of BoardLimits that say which thermistor a rig has; none without one."""
    bead = rig.thermistor
    if bead.fitted != "yes":
        return {}
    return {
        "thermistor_lag_ms": math.ceil(1000 * LAG_RATIO * bead.lag_s),
        "thermistor_share_q8": max(64, math.floor(256 * SHARE_RATIO * bead.share_ratio)),
    }


def cell_of(rig: Rig) -> CellSpec | None:
    """Return the data sheet of a rig's load cell, None if it has none."""
    cell = rig.load_cell
    if not rig.has_cell:
        return None
    return CellSpec(
        plate_kg=cell.plate_kg,
        stiffness_N_m=cell.stiffness_N_m,
        damping_N_s_m=cell.damping_N_s_m,
        filter_s=1 / (2 * math.pi * cell.bandwidth_Hz),
    )


def _position(rig: Rig) -> dict[str, int]:
    sensor = rig.position_sensor
    steps, reads = 2**sensor.converter_bits, sensor.reads
    range_um16 = UM16_m * sensor.range_m
    return {
        "position_gain_q14": round(range_um16 * 2**14 / (steps * reads)),
        "position_offset_um16": round(-range_um16 / 2),
        "reads": reads,
        # half a percent at either end: an open or shorted wire reads there
        "reading_low": steps // 200,
        "reading_high": steps - 1 - steps // 200,
        "jump_um16": min(65535, round(UM16_m * FASTEST_m_s * rig.controller.tick_s)),
        "stuck_ticks": min(65535, round(STUCK_s / rig.controller.tick_s)),
    }


def _loop(rig: Rig) -> dict[str, int]:
    loop = rig.controller
    return {
        "tick_us": round(1e6 * loop.tick_s),
        "window_start_um16": round(UM16_m * loop.window_start_m),
        "window_end_um16": round(UM16_m * loop.window_end_m),
        "reversal_um16": round(UM16_m * loop.reversal_m),
        "rearm_um16": round(UM16_m * loop.rearm_m),
        "velocity_scale_q12": round(4096 * loop.velocity_scale),
        "sliding_ticks": loop.average_ticks if loop.averaging == "sliding" else 1,
        "fewest_samples": loop.fewest_samples,
        "late_ticks": 4,
    }


def _output(rig: Rig) -> dict[str, int]:
    coil, loop = rig.coil, rig.controller
    # a current loop's full scale is what the coil alone would draw
    ohm = coil.resistance_ohm + (coil.bridge_ohm if coil.drive == "voltage" else 0.0)
    full_A = coil.supply_V / coil.resistance_ohm
    # a held current heats hot copper more; a held voltage, less
    hot = 1 + coil.copper_1_K * Settings().heat_limit_K if coil.drive == "current" else 1.0
    duty_N = ohm / (coil.force_constant_N_A * coil.supply_V) * (1 + loop.gain_error_ratio)
    return {
        # Q15 duty per cN64, in Q16
        "duty_gain_q16": round(duty_N / CN64_N * 2**31),
        "duty_limit_q15": 32767,
        "force_limit_cN64": round(CN64_N * loop.force_limit_N),
        "slew_cN64_tick": round(CN64_N * loop.slew_N),
        "nominal_supply_mV": round(1000 * coil.supply_V),
        "supply_low_mV": round(750 * coil.supply_V),
        "supply_high_mV": min(SUPPLY_mV, round(1167 * coil.supply_V)),
        "heat_time_ms": min(600000, max(100, round(1000 * coil.heat_s))),
        "full_duty_rise_K": min(RISE_K, math.ceil(hot * coil.heat_K_W * coil.resistance_ohm * full_A**2)),
        "over_force_cN64": 32000,
    }


def _extras(rig: Rig) -> dict[str, int]:
    servo, exciter = rig.servo, rig.exciter
    cap = rig.load_cell if rig.has_cell else rig.keycap_sensor
    steps, force = 2**cap.converter_bits, rig.has_cell or rig.keycap_sensor.kind == "force"
    return {
        # the firmware knows a force; an acceleration is for the host alone
        "force_gain_q14": round(CN64_N * 2 * cap.full_scale_N / steps * 2**14) if force else 0,
        "force_offset_counts": steps // 2,
        "vibration_latency_us": round(1e6 * exciter.latency_s),
        "stop_us_mm": round(servo.pulse_us_mm),
        "stop_zero_us": round(servo.pulse_zero_us),
    }
