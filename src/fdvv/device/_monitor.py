"""Watch a device's telemetry for a while."""

from __future__ import annotations

from collections.abc import Iterator

from fdvv.device._remote import Remote
from fdvv.device._telemetry import TickColumns

GLANCE_s = 0.05


def watch(device: Remote, duration_s: float, every: int = 1) -> Iterator[TickColumns]:
    """Give what a device tells, a piece every 50 ms of its time, for so long; telemetry ends with it.

    every : ticks between two records. Nothing is rendered that was not before. Raises DeviceError.
    """
    client = device.client
    client.telemetry.clear()
    client.stream(every)
    try:
        until_s = client.port.now_s() + duration_s
        while client.port.now_s() < until_s:
            client.listen(min(until_s, client.port.now_s() + GLANCE_s))
            yield client.telemetry.take()
    finally:
        client.stream(0)
