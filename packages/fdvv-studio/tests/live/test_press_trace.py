"""Traces of a key's travel: drawn, read, refused."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from fdvv.errors import InputError
from fdvv.model.file import load_builtin
from fdvv_studio.live.press import LiveEventKind, LivePress
from fdvv_studio.live.press_subject import model_subject
from fdvv_studio.live.press_trace import read_press_trace, synthetic_traces


def test_drawn_traces_begin_and_end_with_the_key_up_and_have_names_of_their_own() -> None:
    traces = synthetic_traces()
    assert len({trace.name for trace in traces}) == len(traces)
    for trace in traces:
        assert trace.displacement_mm[[0, -1]] == pytest.approx([0.0, 0.0])
        assert trace.displacement_mm.max() > 2.0
        speed = np.diff(trace.displacement_mm) / np.diff(trace.t_s)
        assert np.abs(np.diff(speed)).max() < 40.0, "a drawn move has no jump of its speed, mm/s"


@pytest.mark.parametrize("header", ["t_s,displacement_mm", "time_ms,travel_mm", "x_mm,t_s"])
def test_columns_are_found_by_their_names(header: str) -> None:
    t, x = [0.0, 0.5, 1.0, 1.5], [0.0, 1.0, 4.0, 0.0]
    names = header.split(",")
    values = {"t_s": t, "time_ms": [1000 * v for v in t], "displacement_mm": x, "travel_mm": x, "x_mm": x}
    rows = zip(*(values[name] for name in names), strict=True)
    text = "\n".join([header, *(",".join(map(str, row)) for row in rows)])
    for data in (text, json.dumps({name: values[name] for name in names})):
        trace = read_press_trace(data.encode(), "keys")
        assert trace.t_s == pytest.approx(t)
        assert trace.displacement_mm == pytest.approx(x)


def test_a_key_that_the_studio_recorded_is_read_below_its_comments() -> None:
    head = "# fdvv key recording 1\n# key: Space\n# full_scale_mm: 4\n"
    trace = read_press_trace(f"{head}t_ms,depth_mm\n0,0\n1,0.5\n2.5,1\n4,0\n".encode(), "key.csv")
    assert trace.t_s == pytest.approx([0.0, 0.001, 0.0025, 0.004])
    assert trace.displacement_mm == pytest.approx([0.0, 0.5, 1.0, 0.0])
    with pytest.raises(InputError, match="line 6"):
        read_press_trace(f"{head}t_ms,depth_mm\n0,0\n1,deep\n".encode(), "key.csv")


def test_an_analogue_keyboards_log_gives_the_key_that_moved_most() -> None:
    rows = [(1000 + i, 40 if i % 2 else 41, 0.1 if i % 2 else i / 40) for i in range(40)]
    text = "unixtime,keyCode,keyValue\n" + "\n".join(f"{a},{b},{c}" for a, b, c in rows)
    trace = read_press_trace(text.encode(), "log")
    assert trace.t_s.size == 20
    assert trace.displacement_mm.max() == pytest.approx(4.0 * 38 / 40)
    assert trace.t_s[1] == pytest.approx(0.002)


def test_a_key_that_a_log_is_silent_of_stays_where_it_was() -> None:
    rows = "".join(f"{t},4,{x}\n" for t, x in ((0, 0.5), (9, 0), (900, 0.1), (910, 1)))
    text = f"unixtime,keyCode,keyValue\n{rows}"
    trace = read_press_trace(text.encode(), "log")
    assert np.interp(0.85, trace.t_s, trace.displacement_mm) == 0.0


@pytest.mark.shared
def test_a_persons_typing_can_be_replayed(shared_data: Path) -> None:
    """Of an analogue keyboard (wooting-analog): strokes of 5 to 20 ms, hard to follow."""
    path = shared_data / "wooting-analog" / "001_KMJ_20240531.csv"
    trace = read_press_trace(path.read_bytes(), path.name)
    press = LivePress(model_subject(load_builtin("mx-red")))
    press.replay(trace)
    ticks, events = press.advance(10.0)
    wanted = np.minimum(np.interp(ticks.t_s, trace.t_s, trace.displacement_mm), press.subject.travel_mm)
    assert np.abs(ticks.displacement_mm - wanted).mean() < 0.1
    speeds = [event.velocity_mm_s for event in events if event.kind is LiveEventKind.PRESSED]
    assert len(speeds) > 3
    assert np.median(speeds) > 50.0


@pytest.mark.parametrize(
    ("data", "place"),
    [
        (b"\xff\xfe", "whole file"),
        (b"", "header"),
        (b"a,b\n1,2\n", "header"),
        (b"t_s,displacement_mm\n0,one\n", "line 2"),
        (b"t_s,displacement_mm\n0\n", "line 2"),
        (b"t_s,displacement_mm\n0,1\n1,2\n", "columns"),
        (b"t_s,displacement_mm\n" + b"".join(b"%d,1\n" % (100 * i) for i in range(9)), "columns"),
        (b"t_s,displacement_mm\n0,0\n1,90\n2,0\n3,0\n", "columns"),
        (b"t_s,displacement_mm\n0,0\n1,nan\n2,0\n3,0\n", "columns"),
        (b'{"t_s": "x"}', "$"),
        (b'{"t_s": [0, 1], "x_mm": [0]}', "columns"),
        (b"x" * 4_000_001, "whole file"),
    ],
)
def test_a_file_that_is_no_trace_is_refused_with_place_and_remedy(data: bytes, place: str) -> None:
    with pytest.raises(InputError) as refused:
        read_press_trace(data, "keys.csv")
    assert refused.value.place == place
    assert refused.value.remedy
