"""Slots of the vibration board and strengths to play them with."""

from __future__ import annotations

from hypothesis import strategies as st

from fdvv.program.synth import Slot, Waveform

# seldom more than a second, so that a thousand of them stay quick
SINES = st.builds(
    Slot,
    waveform=st.just(Waveform.SINE),
    frequency_Hz16=st.integers(0, 65_535),
    duration_samples=st.integers(1, 2_000) | st.integers(1, 65_535),
    amplitude_counts=st.integers(0, 2047) | st.just(2047),
    decay_q16=st.integers(0, 65_535) | st.just(65_535),
)
WAVES = st.builds(
    Slot,
    waveform=st.just(Waveform.SAMPLED),
    frequency_Hz16=st.integers(0, 65_535),
    duration_samples=st.integers(1, 2_000) | st.integers(1, 65_535),
    amplitude_counts=st.integers(0, 2047) | st.just(2047),
    decay_q16=st.integers(0, 65_535) | st.just(65_535),
    wave=st.lists(st.integers(-128, 127) | st.sampled_from([-128, 127]), min_size=1, max_size=512).map(tuple),
)
SLOTS = SINES | WAVES
STRENGTHS = st.integers(0, 255) | st.sampled_from([0, 1, 127, 128, 255])
