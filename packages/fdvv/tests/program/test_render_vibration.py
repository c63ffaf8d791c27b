"""From a vibration to a slot, plain or through the inverse; what programs are made of."""

from dataclasses import replace

import numpy as np
import pytest

from fdvv.errors import InputError
from fdvv.model.curve import Stroke
from fdvv.model.file import load_builtin
from fdvv.model.vibration import Mode, Vibration
from fdvv.program.button import button_program
from fdvv.program.compile import compile_program
from fdvv.program.render_vibration import (
    SynthesisMethod,
    converter,
    render_vibration,
    slot_volts,
    vibration_wav,
)
from fdvv.program.synth import Waveform, render
from fdvv.protocol.messages import head_of
from fdvv.rendering.tuning import program_image
from fdvv.vibration.exciter import KnownExciter
from fdvv.vibration.inverse import InverseSettings, acceleration_m_s2, correlation, drive_for
from fdvv.vibration.wave import read_wav

EXCITER = KnownExciter(24.0, 670.0, 2.0, latency_s=0.0002)
SNAP = Vibration(Stroke.PRESS, None, 2.0, 0.016, (Mode(239.0, 4.0, 100.0),))


def test_the_inverse_is_chosen_where_the_plain_waveform_rings() -> None:
    made = render_vibration(SNAP, EXCITER)
    assert made.way is SynthesisMethod.INVERSE
    assert made.slot.waveform is Waveform.SAMPLED
    assert made.likeness > 0.93
    assert 0.8 < made.strength_ratio < 1.1
    assert made.lead_s == InverseSettings().lead_s


def test_the_plain_slot_is_kept_where_the_exciter_hardly_shapes_it() -> None:
    flat = KnownExciter(24.0, 20.0, 0.7)
    made = render_vibration(SNAP, flat)
    assert made.way is SynthesisMethod.PLAIN
    assert made.slot.waveform is Waveform.SINE
    assert made.lead_s == 0.0
    assert made.strength_ratio == pytest.approx(1.0, abs=0.1)


def test_what_is_expected_is_that_of_the_boards_very_samples() -> None:
    made = render_vibration(SNAP, EXCITER)
    rendered = acceleration_m_s2(EXCITER, slot_volts(made.slot, 1000))
    wanted = SNAP.acceleration_m_s2((np.arange(1000) + 0.5) / 16_000 - made.lead_s)
    assert correlation(rendered, wanted) == pytest.approx(made.likeness, abs=1e-3)
    error = np.linalg.norm(rendered - wanted) / np.linalg.norm(wanted)
    assert error == pytest.approx(made.error_ratio, abs=1e-3)


def test_eight_bits_cost_hardly_any_likeness() -> None:

    assert render_vibration(SNAP, EXCITER).likeness == pytest.approx(
        drive_for(EXCITER, SNAP).likeness, abs=0.01
    )


def test_volts_stay_within_the_boards_limit() -> None:
    strong = Vibration(Stroke.PRESS, None, 2.0, 0.016, (Mode(239.0, 90.0, 100.0),))
    made = render_vibration(strong, EXCITER)
    assert np.abs(slot_volts(made.slot)).max() <= 2.43 + 2.5 / 2048
    assert made.strength_ratio < 0.5


def test_a_program_is_the_same_as_ever_without_an_exciter_and_another_with_one() -> None:
    before, after = program_image("mx-clear", [100.0]), program_image("mx-clear", [100.0], EXCITER)
    assert program_image("mx-clear", [100.0], None) == before
    assert head_of(after).slots == head_of(before).slots
    assert len(after) > len(before)  # the wave's samples


def test_a_program_whose_vibration_the_board_cannot_play_is_refused_in_one_line() -> None:
    long = Vibration(Stroke.PRESS, None, 2.0, 1.0, (Mode(900.0, 1.0, 1.0),))
    program = button_program(replace(load_builtin("mx-clear"), vibrations=(long,)))
    with pytest.raises(InputError, match="signal 'snap 1': a drive of") as caught:
        compile_program(program, convert=converter(EXCITER))
    assert "\n" not in str(caught.value)


def test_a_sound_of_the_board_is_what_it_plays() -> None:
    slot = render_vibration(SNAP, EXCITER).slot
    sound = read_wav(vibration_wav(SNAP, EXCITER, board=True).data)
    assert np.array_equal(sound.samples // 16 + 2048, render(slot, slot.duration_samples))
    assert sound.rate_Hz == 16_000
    assert read_wav(vibration_wav(SNAP).data).rate_Hz == 48_000
