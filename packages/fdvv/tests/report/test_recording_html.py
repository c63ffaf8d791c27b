"""A recording in a notebook: its takes as a table and one of them drawn, whatever it holds."""

import xml.etree.ElementTree as ET

import numpy as np
import pytest
from hypothesis import given, settings

from fdvv.recording.types import Quantity, Recording, Stage, Stream, Take
from fdvv.report.notebook import to_html
from tests.recording.strategies import recordings


def test_a_press_is_drawn_before_a_rest() -> None:
    def stream(name: str) -> Stream:
        return Stream(name, Quantity.FORCE, "c", np.arange(9.0), np.arange(9.0))

    rest, press = (
        Take(1, (stream("still"),), stage=Stage.REST),
        Take(2, (stream("pushed"),), stage=Stage.PRESS),
    )
    html = to_html(Recording("<b>", (rest, press), simulated=True))
    assert "take 2: pushed" in html
    assert "&lt;b&gt;" in html
    assert "simulated" in html
    assert "2 takes" in html


def test_many_takes_are_counted_not_listed() -> None:
    takes = tuple(Take(n, ()) for n in range(1, 31))
    html = to_html(Recording("r", takes))
    assert "… 10 more" in html
    assert "<svg" not in html


@pytest.mark.filterwarnings("ignore:overflow|invalid value")
@settings(max_examples=20, deadline=None)
@given(recording=recordings())
def test_any_recording_can_be_shown(recording: Recording) -> None:
    shown = to_html(recording)
    assert shown.count("<table") == 1
    if recording.name.isprintable():
        ET.fromstring(shown.encode(errors="replace"))
