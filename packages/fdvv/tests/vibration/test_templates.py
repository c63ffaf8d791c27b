"""Templates: the paper's three, and those around a measured vibration."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from fdvv.errors import ModelError
from fdvv.model.curve import Stroke
from fdvv.model.spread import ModeSpread, VibrationSpread
from fdvv.model.vibration import Mode, Vibration
from fdvv.units import FloatArray
from fdvv.vibration.templates import Template, TemplateGrid, paper_templates, templates_around

SNAP = Vibration(Stroke.PRESS, 100.0, 2.0, 0.02, (Mode(300.0, 4.0, 50.0), Mode(700.0, 1.0, 90.0)))


def test_the_papers_templates_have_its_frequency_duration_and_volts() -> None:
    found = paper_templates()
    assert [(t.frequency_Hz, t.duration_s, t.start_V, t.end_V) for t in found] == [
        (239.0, 0.016, 2.43, 0.0),
        (239.0, 0.016, 2.43, 0.3),
        (239.0, 0.016, 2.43, 0.6),
    ]


@pytest.mark.parametrize("template", paper_templates()[1:])
def test_an_envelope_goes_from_the_first_voltage_to_the_last(template: Template) -> None:
    peaks: FloatArray = (np.arange(4, dtype=np.float64) + 0.25) / template.frequency_Hz
    envelope = template.start_V * (template.end_V / template.start_V) ** (peaks / template.duration_s)
    inside = peaks <= template.duration_s
    assert np.allclose(template.volts(peaks)[inside], envelope[inside])
    assert template.volts(np.array([-1e-6, template.duration_s + 1e-6])).tolist() == [0.0, 0.0]


def test_a_template_that_ends_at_nothing_ends_40_dB_down() -> None:
    assert np.exp(-paper_templates()[0].decay_1_s * 0.016) == pytest.approx(0.01)


def test_it_knows_nothing_of_how_the_measured_one_differs_between_presses() -> None:
    spread = VibrationSpread(5, modes=(ModeSpread(3.0), ModeSpread(9.0)))
    assert Template(250.0, 0.01, 2.0, 0.5).vibration(replace(SNAP, spread=spread), 3.0).spread is None


def test_as_a_vibration_it_keeps_stroke_velocity_and_onset() -> None:
    found = Template(250.0, 0.01, 2.0, 0.5).vibration(SNAP, 3.0)
    assert (found.stroke, found.velocity_mm_s, found.onset_mm) == (SNAP.stroke, 100.0, 2.0)
    assert found.duration_s == 0.01
    assert found.modes == (Mode(250.0, 6.0, np.log(4.0) / 0.01),)


def test_templates_around_a_vibration_share_its_duration_and_strongest_frequency() -> None:
    found = templates_around(SNAP, 8.0)
    assert {(t.frequency_Hz, t.duration_s) for t in found} == {(300.0, 0.02)}
    assert [t.start_V for t in found] == [0.5] * 3 + [1.0] * 3
    assert [t.end_V / t.start_V for t in found[:3]] == pytest.approx([0.0, 0.3 / 2.43, 0.6 / 2.43])


def test_templates_beyond_the_limit_are_weakened_to_it_and_counted_once() -> None:
    found = templates_around(SNAP, 1.0, TemplateGrid((1.0, 0.5), (1.0, 3.0, 9.0)))
    assert len(found) == len(set(found)) == 6
    assert {t.start_V for t in found} == {2.43}


@pytest.mark.parametrize(
    "bad",
    [{"gain_ratios": ()}, {"frequency_ratios": (0.0,)}, {"end_ratios": (1.5,)}, {"gain_ratios": (np.nan,)}],
)
def test_impossible_grids_are_refused(bad: dict[str, Any]) -> None:
    with pytest.raises(ModelError, match=next(iter(bad))):
        TemplateGrid(**bad)


@pytest.mark.parametrize(
    "bad", [(0.0, 0.01, 1.0, 0.5), (200.0, 0.01, 1.0, 2.0), (200.0, 0.0, 1.0, 0.5), (200.0, 0.01, 9.0, 0.5)]
)
def test_impossible_templates_are_refused(bad: tuple[float, float, float, float]) -> None:
    with pytest.raises(ModelError, match="a template"):
        Template(*bad)
