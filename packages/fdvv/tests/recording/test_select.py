"""Markers of the cap and the light are distinguished from the others of an export."""

from __future__ import annotations

import numpy as np

from fdvv.recording.join import select
from fdvv.recording.types import Quantity, Recording, Stream, Take


def export() -> Recording:
    t_s = np.arange(6) / 256
    seen = np.arange(18.0).reshape(6, 3)
    led = seen.copy()
    led[[0, 1, 4]] = np.nan
    streams = [
        Stream(n, Quantity.MARKER, "camera", t_s, v) for n, v in (("a", seen), ("b", seen), ("led", led))
    ]
    return Recording("mx-clear", (Take(1, tuple(streams)),))


def test_markers_that_are_not_named_are_left_out_with_a_word() -> None:
    found = select(export(), ["a"])

    assert [s.name for s in found.takes[0].streams] == ["a"]
    assert found.warnings == ("markers left out: b, led",)


def test_a_marker_that_is_seen_while_the_light_is_on_becomes_the_light() -> None:
    found = select(export(), light="led")

    (light,) = found.takes[0].of(Quantity.LIGHT)
    assert light.values.tolist() == [0, 0, 1, 1, 0, 1]
    assert [s.name for s in found.takes[0].of(Quantity.MARKER)] == ["a", "b"]
    assert found.warnings == ()


def test_nothing_named_keeps_all() -> None:
    assert [s.name for s in select(export()).takes[0].streams] == ["a", "b", "led"]
