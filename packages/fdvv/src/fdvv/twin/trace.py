"""The record of one simulated press."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from fdvv.firmware.core import RecordArray
from fdvv.model.press import Press
from fdvv.protocol.messages import CN64_PER_cN, UM16_PER_mm
from fdvv.protocol.tables import TickFlag
from fdvv.twin.rig_kernel import Rows
from fdvv.units import FloatArray, cN_from_N, mm_from_m

BoolArray = npt.NDArray[np.bool_]
ByteArray = npt.NDArray[np.uint8]
CUT = TickFlag.LIMITED | TickFlag.SLEWED | TickFlag.DERATED


def controller_columns(outputs: RecordArray) -> dict[str, Any]:
    """Return what the controller did, (n,) each in record units: what Trace and InteractiveTicks share."""
    return {
        "sensed_mm": outputs["displacement_um16"] / UM16_PER_mm,
        "commanded_cN": outputs["commanded_cN64"] / CN64_PER_cN,
        **{name: outputs[name] for name in ("state", "key", "slot", "mode", "flags")},
    }


@dataclass(frozen=True, eq=False)
class Trace:
    """All that the twin knows of one press, simulated; every column (n,) on one clock of 10 kHz or more.

    Attributes
    ----------
    t_s : from 0.
    displacement_mm, cap_velocity_mm_s, cap_acceleration_m_s2 : of the cap, true.
    force_cN : between cap and sensor cone, true.
    sensed_mm, commanded_cN, saturated, release, state, key, slot, mode, flags : the controller's, held
        between ticks; flags are bits of fdvv.protocol.tables.TickFlag, slot the waveform started in that
        tick or NONE.
    sensed_cN : reading of the finger's force sensor at the tick.
    tick : rows at which the controller ran.
    duty_ratio : of the supply, as the controller set it at the tick.
    current_A : in the coil. warm_K : of the coil. stop_mm : position of the bottom stop.
    finger_mm : of the finger. magnet_um : of the exciter's magnet, from its rest in the cap.
    energy_J : energy that the balance cannot account for, 0 if integration were exact; None if not asked.
    """

    t_s: FloatArray
    displacement_mm: FloatArray
    cap_velocity_mm_s: FloatArray
    cap_acceleration_m_s2: FloatArray
    force_cN: FloatArray
    sensed_mm: FloatArray
    sensed_cN: FloatArray
    commanded_cN: FloatArray
    saturated: BoolArray
    release: BoolArray
    state: ByteArray
    key: ByteArray
    slot: ByteArray
    mode: ByteArray
    flags: ByteArray
    tick: BoolArray
    duty_ratio: FloatArray
    current_A: FloatArray
    warm_K: FloatArray
    stop_mm: FloatArray
    finger_mm: FloatArray
    magnet_um: FloatArray
    energy_J: FloatArray | None

    @classmethod
    def of_rows(
        cls, rows: Rows, audit: bool = False, lowest_ratio: float = -1.0, has_cell: bool = False
    ) -> Trace:
        """Convert the kernel's rows to record units; a duty below lowest_ratio is one the bridge cuts."""
        t, x, v, a, force, _, amps, finger, magnet, energy = rows.physics.T.copy()
        per_tick = t.size // len(rows.outputs)
        sensed_N, warm, stop = (np.repeat(column, per_tick) for column in rows.sensed.T)
        out = np.repeat(rows.outputs, per_tick)
        flags, duty_ratio = out["flags"], out["duty_q15"] / 32768
        return cls(
            t_s=t,
            displacement_mm=mm_from_m(x),
            cap_velocity_mm_s=mm_from_m(v),
            cap_acceleration_m_s2=a,
            force_cN=cN_from_N(force),
            sensed_cN=out["force_cN64"] / CN64_PER_cN if has_cell else cN_from_N(sensed_N),
            saturated=((flags & CUT) > 0) | (duty_ratio < lowest_ratio),
            release=(flags & TickFlag.RELEASE) > 0,
            tick=np.arange(t.size) % per_tick == 0,
            duty_ratio=duty_ratio,
            current_A=amps,
            warm_K=warm,
            stop_mm=mm_from_m(stop),
            finger_mm=mm_from_m(finger),
            magnet_um=1e6 * magnet,
            energy_J=energy if audit else None,
            **controller_columns(out),
        )

    def press(self, velocity_mm_s: float) -> Press:
        """Return the record that devices share, asked for at velocity_mm_s."""
        device = (self.sensed_mm, self.sensed_cN, self.commanded_cN, self.saturated, self.tick)
        return Press(self.t_s, self.displacement_mm, self.force_cN, velocity_mm_s, *device, simulated=True)
