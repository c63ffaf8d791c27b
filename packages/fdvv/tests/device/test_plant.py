"""What passes between board and plant is laid out as the firmware's structures."""

from __future__ import annotations

import numpy as np

from fdvv.device.plant import INPUTS_BYTES, OUTPUTS_BYTES, Inputs, Outputs
from fdvv.firmware.core import INPUTS, OUTPUTS


def test_inputs_are_those_of_the_core() -> None:
    inputs = Inputs(7, 51200, 2000, 2100, 3, 12345, 99, 5)
    assert (INPUTS_BYTES, Inputs._fields) == (INPUTS.itemsize, INPUTS.names)
    assert np.frombuffer(inputs.pack(), INPUTS)[0].item() == tuple(inputs)


def test_outputs_are_those_of_the_core() -> None:
    record = np.zeros(1, OUTPUTS)
    for number, name in enumerate(Outputs._fields, 1):
        record[name] = number
    assert OUTPUTS.itemsize == OUTPUTS_BYTES
    assert Outputs.unpack(record.tobytes())._asdict() == {
        name: number for number, name in enumerate(Outputs._fields, 1)
    }
