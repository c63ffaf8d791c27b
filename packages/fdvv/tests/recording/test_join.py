"""Recordings of several instruments side by side, and of their markers those of the cap and the light."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fdvv.errors import ModelError
from fdvv.recording.join import join, select
from fdvv.recording.read import read_log
from fdvv.recording.types import Bench, Quantity, Recording, Stage, Stream, Take
from tests.recording.files import motive, serial


@pytest.fixture
def camera(tmp_path: Path) -> Recording:
    (tmp_path / "camera.csv").write_text(motive())
    return read_log(tmp_path / "camera.csv")


@pytest.fixture
def board(tmp_path: Path) -> Recording:
    (tmp_path / "board.txt").write_text(serial())
    return read_log(tmp_path / "board.txt")


def test_a_camera_and_a_board_keep_their_clocks(camera: Recording, board: Recording) -> None:
    found = join([camera, board], "mx-clear")
    take = found.takes[0]
    assert {stream.name: stream.clock for stream in take.streams} == {
        "left": "camera",
        "right": "camera",
        "force": "board",
        "sound": "board",
    }
    assert [mark.clock for mark in take.marks] == ["board"]
    assert (found.name, take.remark, take.made) == ("mx-clear", "made up", "2026-01-02T15:04:05.678")
    assert found.bench == board.bench
    assert [source.name for source in found.sources] == ["camera.csv", "board.txt"]
    for one, other in zip(take.streams, (*camera.takes[0].streams, *board.takes[0].streams), strict=True):
        assert one.raw.tobytes() == other.raw.tobytes()
        np.testing.assert_array_equal(one.t_s, other.t_s)


def test_two_clocks_of_one_name_stay_two(board: Recording) -> None:
    take = join([board, board, board]).takes[0]
    assert [stream.clock for stream in take.streams[::2]] == ["board", "board 2", "board 3"]
    assert [mark.clock for mark in take.marks] == ["board", "board 2", "board 3"]
    assert [stream.name for stream in take.streams] == [
        *("force", "sound", "force 2", "sound 2", "force 3", "sound 3")
    ]


def test_takes_are_joined_by_their_numbers(board: Recording, camera: Recording) -> None:
    second = replace(board.takes[0], number=2, stage=Stage.PROBE, velocity_mm_s=50.0)
    two = replace(board, takes=(board.takes[0], second))
    with pytest.raises(ModelError, match=r"recordings of \[1, 2\] takes cannot be joined"):
        join([two, camera])
    seen = replace(camera, takes=(camera.takes[0], Take(2, camera.takes[0].streams)))
    found = join([seen, two])
    assert [len(take.streams) for take in found.takes] == [4, 4]
    assert (found.takes[1].stage, found.takes[1].velocity_mm_s) == (Stage.PROBE, 50.0)


CONTRADICTIONS = [
    {"bench": Bench(tip_mass_g=9.0)},
    {"licence": "MIT"},
    {"person": "B"},
    {"simulated": True},
]


@pytest.mark.parametrize("change", CONTRADICTIONS, ids=lambda change: next(iter(change)))
def test_recordings_that_contradict_each_other_are_not_joined(
    board: Recording, change: dict[str, object]
) -> None:
    known = replace(board, licence="CC0", person="A")
    with pytest.raises(ModelError, match="the recordings differ in"):
        join([known, replace(known, **change)])  # type: ignore[arg-type]


def test_nothing_is_not_joined() -> None:
    with pytest.raises(ModelError, match="there is no recording to join"):
        join([])


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
