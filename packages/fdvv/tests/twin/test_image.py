"""Tables of force as programs of the firmware."""

from __future__ import annotations

import numpy as np
import pytest

from fdvv.errors import ModelError
from fdvv.model.surface import ForceSurface
from fdvv.protocol.tables import IMAGE_BYTES, ImageHeader, Slot, State, Surface, Waveform
from fdvv.twin.image import image_of
from fdvv.units import FloatArray


def held(image: bytes, at: int = 0) -> tuple[Surface, FloatArray]:
    """Read one surface of an image and its forces in cN."""
    start = ImageHeader.length_bytes() + State.length_bytes() + at * Surface.length_bytes()
    surface = Surface.unpack(image[start : start + Surface.length_bytes()])
    count = surface.rows * surface.columns
    forces = np.frombuffer(image, "<i2", count, surface.forces_at)
    return surface, forces.reshape(surface.rows, surface.columns) / 64


def fine(columns: int, wave_cN: float) -> ForceSurface:
    x = np.linspace(0.0, 4.0, columns)
    table = np.tile(50 + wave_cN * np.sin(np.arange(columns)), (16, 1))
    return ForceSurface(x, np.linspace(20, 300, 16), table, table)


def test_a_table_that_fits_is_held_to_half_a_sixty_fourth_of_a_centinewton(tactile: ForceSurface) -> None:
    made = image_of(tactile, 4.0)
    for at, table in enumerate((tactile.press_cN, tactile.release_cN)):
        surface, forces = held(made.image, at)
        assert (surface.start_um16, surface.step_um16, surface.columns) == (0, 800, 81)
        assert forces == pytest.approx(table, abs=1 / 128)
    assert made.error_cN <= 1 / 128 + 1e-12


def test_a_table_too_fine_for_a_device_is_sampled_to_fit_and_tells_its_error() -> None:
    made = image_of(fine(401, 0.01), 4.0)
    assert len(made.image) <= IMAGE_BYTES
    assert 1 / 128 < made.error_cN < 0.1


def test_a_table_that_sampling_would_spoil_is_refused() -> None:
    with pytest.raises(ModelError, match=r"would change by .* cN to fit a device; \d+ places at most"):
        image_of(fine(401, 5.0), 4.0)


def test_a_table_of_too_many_speeds_or_too_strong_is_refused() -> None:
    x, table = np.array([0.0, 1.0]), np.full((17, 2), 50.0)
    with pytest.raises(ModelError, match="16 velocities at most, got 17"):
        image_of(ForceSurface(x, np.arange(1.0, 18.0), table, table), 4.0)
    strong = np.full((1, 2), 501.0)
    with pytest.raises(ModelError, match="forces up to 500 cN"):
        image_of(ForceSurface(x, np.array([50.0]), strong, strong), 4.0)


def test_each_slot_gets_its_own_samples_behind_the_forces(tactile: ForceSurface) -> None:
    slots = [
        Slot(
            waveform=Waveform.SAMPLED,
            frequency_Hz16=65_535,
            duration_samples=10,
            amplitude_counts=100,
            decay_q16=0,
            wave_at=0,
            wave_samples=0,
        )
        for _ in range(2)
    ]
    waves = [(1, -128, 127), (7, 8, 9, 10)]
    image = image_of(tactile, 4.0, (), slots, waves=waves).image
    at = ImageHeader.length_bytes() + State.length_bytes() + 2 * Surface.length_bytes()
    for wave in waves:
        slot = Slot.unpack(image[at : at + Slot.length_bytes()])
        samples = np.frombuffer(image[slot.wave_at : slot.wave_at + slot.wave_samples], "i1")
        assert samples.tolist() == list(wave)
        at += Slot.length_bytes()
    assert held(image)[1] == pytest.approx(tactile.press_cN, abs=1 / 128)
