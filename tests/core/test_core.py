"""The core as Python sees it: modes, zero force, images and settings that cannot be used."""

from __future__ import annotations

import struct
import zlib
from dataclasses import replace

import numpy as np
import pytest

from fdvv.core import Core, inputs_at
from fdvv.errors import ModelError
from fdvv.protocol import IMAGE_MAGIC, Fault, ImageHeader, Mode, Settings, State, Surface

HEADER_BYTES, STATE_BYTES, SURFACE_BYTES = 32, 20, 12


def ramp(force_cN64: int = 6400) -> bytes:
    """A program of one state: force rises evenly over 4 mm."""
    state = State(
        press_surface=0,
        release_surface=0,
        velocity_source=1,
        key=0,
        first_transition=0,
        transitions=0,
        enter_slot=255,
        repeat_slot=255,
        repeat_ms=0,
        fade_ms=0,
        bias_cN64=0,
        bias_end_cN64=0,
        bias_ms=0,
    )
    at = HEADER_BYTES + STATE_BYTES + SURFACE_BYTES
    surface = Surface(start_um16=0, step_um16=16000, columns=5, rows=1, velocities_at=at, forces_at=at + 2)
    forces = np.linspace(0, force_cN64, 5).astype("<i2")
    body = state.pack() + surface.pack() + struct.pack("<H", 1600) + forces.tobytes()
    header = ImageHeader(
        magic=IMAGE_MAGIC,
        crc32=0,
        travel_um16=64000,
        size_bytes=HEADER_BYTES + len(body),
        version=1,
        start_state=0,
        states=1,
        transitions=0,
        surfaces=1,
        vibrations=0,
        slots=0,
        name=b"ramp",
    )
    crc = zlib.crc32((header.pack() + body)[8:])
    return replace(header, crc32=crc).pack() + body


def test_an_armed_core_renders_the_force_of_its_surface() -> None:
    core = Core(Settings(), ramp())
    core.arm()
    settled = core.run(inputs_at(Settings(), np.full(10, 2.0)))[-1]
    assert settled["commanded_cN64"] == pytest.approx(3200, abs=1)
    assert settled["enable"] == 1


def test_a_core_that_was_not_armed_gives_no_force_but_a_record() -> None:
    core = Core(Settings(), ramp())
    outputs = core.run(inputs_at(Settings(), np.full(10, 2.0)))
    assert not outputs["duty_q15"].any()
    assert not outputs["enable"].any()
    assert outputs["displacement_um16"] == pytest.approx(32000, abs=1)


def test_an_armed_core_without_a_program_gives_no_force() -> None:
    core = Core()
    core.arm()
    outputs = core.run(inputs_at(Settings(), np.full(10, 2.0)))
    assert not outputs["duty_q15"].any()
    assert not outputs["enable"].any()


def test_tick_and_run_agree() -> None:
    inputs = inputs_at(Settings(), np.linspace(0, 3, 50))
    one, many = Core(Settings(), ramp()), Core(Settings(), ramp())
    one.arm()
    many.arm()
    assert [one.tick(record).tobytes() for record in inputs] == [r.tobytes() for r in many.run(inputs)]


def test_an_image_of_another_length_is_refused() -> None:
    with pytest.raises(ModelError, match="the image says it has 76 bytes, got 80"):
        Core(Settings(), ramp() + bytes(4))


def test_a_fault_ends_the_force_at_once_whatever_the_slew() -> None:
    core = Core(replace(Settings(), slew_cN64_tick=16), ramp())
    core.arm()
    inputs = inputs_at(Settings(), np.full(300, 3.0))
    assert core.run(inputs)["duty_q15"][-1] > 300
    core.fail(Fault.OUTPUT)
    after = core.tick(inputs[0])
    assert (core.mode, core.fault) == (Mode.FAULT, Fault.OUTPUT)
    assert (after["duty_q15"], after["enable"], after["commanded_cN64"]) == (0, 0, 0)
