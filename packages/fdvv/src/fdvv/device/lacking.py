"""What a rig lacks, and what still works: said before the first press."""

from __future__ import annotations

from fdvv.device.contract import Device
from fdvv.device.remote import Remote
from fdvv.protocol.tables import BoardFlag

NO_FORCE_SENSOR = (
    "no force sensor: presses are played, but not measured; fdvv compensate and probe need one, studies and "
    "programs do not"
)
NO_VIBRATION = "no vibration board: force is rendered, vibrations are not played"
NO_LIMITER = "no travel limiter: every button is as deep as the stop of the rig, whatever its travel is"


def lacking(device: Device, vibrating: bool = True) -> tuple[str, ...]:
    """Return a sentence for each part that a device lacks, with what works without it; most lack none.

    vibrating : vibrations are to be played. What knows no parts, as a recording, is taken to have them all.
    """
    sentences = []
    if isinstance(device, Remote):
        if not device.settings().force_gain_q14:
            sentences.append(NO_FORCE_SENSOR)
        if not device.parts & BoardFlag.SERVO:
            sentences.append(NO_LIMITER)
    if vibrating and not getattr(device, "has_exciter", True):
        sentences.append(NO_VIBRATION)
    return tuple(sentences)
