"""How the device's clock runs beside the host's."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fdvv.errors import DeviceError

WRAP_us = 2**32


@dataclass(frozen=True)
class Exchange:
    """One ping: when it left, what the device's clock said when it was there, when the answer was back.

    Attributes
    ----------
    sent_us, received_us : on the host's clock.
    device_us : on the device's, unwrapped.
    """

    sent_us: float
    received_us: float
    device_us: float


@dataclass(frozen=True)
class ClockRelation:
    """host = offset + (1 + drift) * device, from the quickest exchanges.

    Attributes
    ----------
    offset_us : host's clock at the device's zero.
    drift_ppm : how much faster the host's clock runs; 0 unless the exchanges span a second.
    residual_us : rms distance of the exchanges used from the line.
    shortest_us : shortest round trip; half of it bounds the error of the offset.
    exchanges : used.
    """

    offset_us: float
    drift_ppm: float
    residual_us: float
    shortest_us: float
    exchanges: int

    def host_us(self, device_us: float) -> float:
        """Turn the device's time into the host's."""
        return self.offset_us + (1 + self.drift_ppm * 1e-6) * device_us


def unwrap_us(time_us: int, near_us: float) -> float:
    """Give the time nearest to near_us that a 32-bit microsecond clock shows as time_us."""
    return time_us + WRAP_us * round((near_us - time_us) / WRAP_us)


def relate(exchanges: Sequence[Exchange]) -> ClockRelation:
    """Relate the clocks by least squares over the quicker half of the exchanges.

    A slow exchange was held up on one of its ways, nobody knows which; its middle is no good estimate.
    Raises DeviceError without any.
    """
    if not exchanges:
        raise DeviceError("clocks cannot be related without a ping; ping the device first")
    trips = np.array([e.received_us - e.sent_us for e in exchanges])
    quick = np.argsort(trips, kind="stable")[: max(1, (trips.size + 1) // 2)]
    device = np.array([exchanges[i].device_us for i in quick])
    host = np.array([(exchanges[i].sent_us + exchanges[i].received_us) / 2 for i in quick])
    span = device - device.mean()
    steady = np.ptp(device) < 1e6
    drift = 0.0 if steady else float(span @ (host - host.mean() - span) / (span @ span))
    offset = float(host.mean() - (1 + drift) * device.mean())
    residual = host - offset - (1 + drift) * device
    return ClockRelation(
        offset, drift * 1e6, float(np.sqrt(np.mean(residual**2))), float(trips.min()), quick.size
    )
