"""The report of a recording: every step with its picture."""

from __future__ import annotations

import functools
import re
from dataclasses import replace

import pytest

from fdvv.bench.html import capture_html
from fdvv.bench.model import model_of_recording
from fdvv.recording.types import Stage
from tests.support.captures import SHORT_STROKE, capture, recorded

STEPS = [
    "Raw streams",
    "Clocks",
    "Force",
    "Displacement",
    "Presses",
    "Registration",
    "Averaged curves",
    "Vibration",
    "Model",
]


@functools.cache
def report() -> str:
    return capture_html(recorded())


def headings(html: str) -> list[str]:
    return re.findall(r"<h2[^>]*>([^<]*)</h2>", html)


def test_every_step_has_its_section_and_a_picture() -> None:
    html = report()
    assert headings(html) == STEPS
    for title, section in zip(STEPS, html.split("<section")[1:], strict=True):
        assert "<svg" in section or title == "Vibration"
    assert "Simulated:" in html
    assert "<script" not in html
    assert 'src="http' not in html


def test_the_report_tells_the_press_left_out_and_the_errors_of_landmarks() -> None:
    html = report()
    assert f"take {SHORT_STROKE}" in html
    assert "did not reach the bottom" in html
    assert re.search(r"\d ± \d", html)
    assert "moves 3 g" in html


@pytest.mark.slow
def test_a_recording_whose_presses_had_no_pace_is_reported_too() -> None:
    presses = [t for t in capture().takes if t.stage is Stage.PRESS and t.velocity_mm_s == 50.0]
    takes = tuple(replace(t, number=i, velocity_mm_s=None) for i, t in enumerate(presses, 1))
    html = capture_html(model_of_recording(replace(capture(), takes=takes, simulated=False)))
    assert headings(html) == STEPS
    assert "Simulated:" not in html
    assert "<td>–</td>" in html
