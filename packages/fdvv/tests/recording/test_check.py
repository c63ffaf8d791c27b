"""The check of a recording: what is there, and what is wrong, with its place."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fdvv.recording.check import check_recording
from fdvv.recording.file import RECORDING_SUFFIX, Correction, save_recording
from fdvv.recording.log import RecordingLog
from fdvv.recording.types import Bench, Recording, Take
from fdvv.testing.captured import captured_session
from tests.recording.takes import ABOUT, take


def saved(path: Path, *takes: Take, about: Recording = ABOUT) -> Path:
    save_recording(replace(about, takes=takes), path)
    return path


def whole(path: Path) -> Path:
    return saved(path, take(1), take(2), take(3))


def test_a_whole_recording_tells_its_facts(tmp_path: Path) -> None:
    path = whole(tmp_path / "a")
    with RecordingLog(path, ABOUT) as log:
        log.mend(Correction({"remark": "slipped"}, take=2))
    found = check_recording(path)
    assert (found.kind, found.status, found.problems, found.notes) == ("a recording", 0, (), ())
    facts = found.facts
    assert (facts["version"], facts["name"], facts["takes"], facts["corrections"]) == (1, "mx-clear", 3, 1)
    assert (facts["stages"], facts["velocities_mm_s"], facts["marks"]) == (
        {"press": 3},
        [100.0],
        {"light on": 3},
    )
    assert facts["clocks"]["board"] == {"first_s": 1.0, "last_s": pytest.approx(3.049)}
    force, _, left, right = facts["streams"]
    assert (force["unit"], force["kind"], force["samples"], force["gaps_percent"]) == (
        "cN",
        "int16",
        150,
        0.0,
    )
    assert (left["unit"], left["axes"], right["kind"]) == ("mm", 3, "float32")
    assert left["gaps_percent"] == pytest.approx(100 / 12)
    assert left["rate_Hz"] == pytest.approx(256)
    assert facts["size_bytes"] == path.stat().st_size
    assert found.to_dict()["verdict"] == "whole"


def test_a_cut_recording_can_be_read_and_says_what_to_do(tmp_path: Path) -> None:
    path = whole(tmp_path / "a")
    path.write_bytes(path.read_bytes()[:-9])
    found = check_recording(path)
    assert (found.status, found.facts["takes"]) == (1, 2)
    message = (
        "the last record is not whole and is left out; go on with it, which cuts the rest off; takes kept: 2"
    )
    assert str(found.problems[0]) == f"end of file: {message}"


def test_a_damaged_recording_is_unusable_with_its_line(tmp_path: Path) -> None:
    path = whole(tmp_path / "a")
    path.write_bytes(path.read_bytes().replace(b"press", b"prass", 1))
    found = check_recording(path)
    assert (found.status, found.usable, found.facts) == (2, False, {})
    assert str(found.problems[0]).startswith("line 2: the record is damaged; compare with docs")


def blind(one: Take) -> Take:
    streams = list(one.streams)
    streams[2] = replace(streams[2], raw=np.full_like(streams[2].raw, np.nan))
    return replace(one, streams=tuple(streams))


def empty(one: Take) -> Take:
    streams = list(one.streams)
    streams[0] = replace(streams[0], t_s=streams[0].t_s[:0], raw=streams[0].raw[:0])
    return replace(one, streams=tuple(streams))


def lacking(one: Take) -> Take:
    return replace(one, streams=one.streams[1:])


def early(one: Take) -> Take:
    return replace(take(1), number=one.number)


FAULTS: dict[str, tuple[Callable[[Take], Take], str]] = {
    "blind": (blind, "take 2, left: nothing was seen in any sample"),
    "empty": (empty, "take 2, force: holds no sample"),
    "lacking": (lacking, "take 2: lacks force, which other takes of its stage hold"),
    "early": (early, "take 2, force: begins before take 1 ended"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_of_a_take_is_reported_with_its_place(tmp_path: Path, fault: str) -> None:
    change, message = FAULTS[fault]
    found = check_recording(saved(tmp_path / "a", take(1), change(take(2)), take(3)))
    assert found.status == 1
    assert [str(problem)[: len(message)] for problem in found.problems] == [message]


def test_clocks_that_begin_anew_may_do_so(tmp_path: Path) -> None:
    about = replace(ABOUT, bench=Bench(clocks_go_on=False))
    assert check_recording(saved(tmp_path / "a", take(1), early(take(2)), about=about)).status == 0


def test_a_recording_without_a_take_says_so(tmp_path: Path) -> None:
    found = check_recording(saved(tmp_path / "a"))
    assert (found.status, str(found.problems[0])) == (1, "whole file: holds no take; go on with the capture")


def test_a_probe_may_be_recorded_by_other_instruments_than_presses(tmp_path: Path) -> None:
    session = captured_session("mx-red", 2, presses=1, paces_mm_s=(100.0,))
    path = tmp_path / f"a{RECORDING_SUFFIX}"
    save_recording(session.recording, path)

    assert check_recording(path).problems == ()
