"""What notebooks show: well-formed, escaped, without script, and with the model's own numbers."""

import importlib
import re
import sys
import xml.etree.ElementTree as ET
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import fdvv
from fdvv.errors import ModelError
from fdvv.model.file import builtin_names, load_builtin
from fdvv.model.landmarks import landmarks
from fdvv.model.model import FDVVModel
from fdvv.model.press import Press
from fdvv.recording.types import Quantity, Recording, Stage, Stream, Take
from fdvv.report.chart import ChartLine, chart_svg
from fdvv.report.notebook import DRAWN_BY, table, to_html
from tests.model.strategies import models
from tests.recording.strategies import recordings

SVG = "{http://www.w3.org/2000/svg}"


def _drawing(html: str) -> ET.Element:
    found = ET.fromstring(re.findall(r"<svg.*?</svg>", html, re.DOTALL)[0])
    assert found.tag == f"{SVG}svg"
    return found


def _lines(drawing: ET.Element) -> list[ET.Element]:
    return [path for path in drawing.iter(f"{SVG}path") if "stroke-width" in path.attrib]


@pytest.mark.parametrize("name", builtin_names())
def test_every_shipped_model_shows_all_its_curves(name: str) -> None:
    model = load_builtin(name)
    html = to_html(model)
    lines = _lines(_drawing(html))
    # each curve has a line, and the first and last of a stroke one more in the legend
    assert len(lines) >= len(model.curves) + 2
    assert f"{model.travel_mm:g} mm" in html
    assert f"{landmarks(model).bottom_out_cN:.2f} cN" in html


@settings(max_examples=8, deadline=None)
@given(model=models())
def test_any_model_can_be_shown(model: FDVVModel) -> None:
    ET.fromstring(to_html(model))


@pytest.mark.parametrize("name", ["<script>alert(1)</script>", '"><img src=x onerror=y>', "a & b", "\x01x"])
def test_a_name_is_never_markup(name: str) -> None:
    html = to_html(load_builtin("mx-red").renamed(name))
    assert "<script" not in html
    assert "<img" not in html
    _drawing(html)
    for word in ("http://", "https://"):
        assert set(re.findall(rf"{word}[^\"<]*", html)) <= {"http://www.w3.org/2000/svg"}


def test_words_and_axes_take_the_pages_colour_and_nothing_paints_a_ground() -> None:
    html = to_html(load_builtin("mx-clear"))
    assert "currentColor" in html
    assert not re.search(r"background(-color)?:(?!none)", html)
    assert {e.get("fill") for e in _drawing(html).iter(f"{SVG}text")} <= {None, "currentColor"}


def _contrast(one: str, other: str) -> float:
    def light(colour: str) -> float:
        parts = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
        r, g, b = (c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts)
        return 0.2126 * r + 0.7152 * g + 0.0722 * b

    high, low = sorted((light(one), light(other)), reverse=True)
    return (high + 0.05) / (low + 0.05)


def test_lines_stand_out_on_light_and_on_dark_pages() -> None:
    colours = {path.attrib["stroke"] for path in _lines(_drawing(to_html(load_builtin("mx-blue"))))}
    assert len(colours) == 2
    for colour in colours:
        assert min(_contrast(colour, ground) for ground in ("#ffffff", "#111111")) >= 3


def test_importing_fdvv_registers_the_drawings_with_ipython(monkeypatch: pytest.MonkeyPatch) -> None:
    drawn: dict[tuple[str, str], Callable[[Any], str]] = {}

    class Formatter:
        def for_type_by_name(self, module: str, name: str, draw: Callable[[Any], str]) -> None:
            drawn[module, name] = draw

    shell = SimpleNamespace(display_formatter=SimpleNamespace(formatters={"text/html": Formatter()}))
    monkeypatch.setitem(sys.modules, "IPython", SimpleNamespace(get_ipython=lambda: shell))
    importlib.reload(fdvv)
    assert {(kind.__module__, kind.__name__) for kind in DRAWN_BY} == drawn.keys()
    model = load_builtin("mx-red")
    assert drawn["fdvv.model.model", "FDVVModel"](model) == to_html(model)


def test_a_press_shows_both_strokes_and_time() -> None:
    t = np.linspace(0, 0.2, 3000)
    x = 2 * (1 - np.cos(2 * np.pi * t / 0.2))
    press = Press(t, x, 10 * x, 100.0, simulated=True)
    html = to_html(press)
    assert html.count("<svg") == 2
    assert "simulated" in html
    one_way = Press(t[:100], x[:100], x[:100], 100.0)
    assert "release" not in to_html(one_way)


def test_landmarks_are_a_table_with_units_and_dashes() -> None:
    html = to_html(landmarks(load_builtin("mx-red")))
    assert "cN/mm" in html
    assert "–" in html
    ET.fromstring(html)


def test_a_long_line_keeps_its_highest_and_lowest_point() -> None:
    y = np.zeros(100_000)
    y[12_345], y[54_321] = 7.0, -3.0
    drawing = ET.fromstring(chart_svg([ChartLine(np.arange(float(y.size)), y)], "t", "y", "spikes"))
    (path,) = _lines(drawing)
    heights = [float(v) for v in re.findall(r"[ML][\d.]+ ([\d.]+)", path.attrib["d"])]
    assert len(heights) <= 400
    flat = max(set(heights), key=heights.count)
    assert min(heights) < flat - 50
    assert max(heights) > flat + 50


def test_a_gap_in_a_line_is_a_gap() -> None:
    line = ChartLine(np.arange(5.0), np.array([1.0, 2.0, np.nan, 3.0, 4.0]))
    (path,) = _lines(ET.fromstring(chart_svg([line], "x", "y", "gap")))
    assert path.attrib["d"].count("M") == 2


@given(low=st.floats(-1e6, 1e6), span=st.floats(1e-6, 1e6), names=st.lists(st.text(max_size=5), max_size=3))
@settings(max_examples=40, deadline=None)
def test_any_range_gets_axes_within_the_drawing(low: float, span: float, names: list[str]) -> None:
    lines = [
        ChartLine(np.array([0.0, 1.0]), np.array([low, low + span]), "line", i) for i, _ in enumerate(names)
    ]
    lines.append(ChartLine(np.array([0.0, 1.0]), np.array([low, low]), dots=True))
    root = ET.fromstring(chart_svg(lines, "x", "y", "t"))
    height = float(root.attrib["height"])
    for text in root.iter(f"{SVG}text"):
        assert 0 <= float(text.get("y", "0")) <= height


def test_nothing_to_draw_is_refused() -> None:
    with pytest.raises(ModelError, match="at least one finite point"):
        chart_svg([ChartLine(np.array([np.nan]), np.array([1.0]))], "x", "y", "t")


def test_cells_of_a_table_are_escaped() -> None:
    assert "&lt;b&gt;" in table([["<b>", "1"]])


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
