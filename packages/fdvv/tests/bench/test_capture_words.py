"""What is said of a recorded model."""

from __future__ import annotations

from dataclasses import replace

from fdvv.bench.model import assumptions_of, method_of, source_of, used_and_left_out
from fdvv.preprocess.clock import ClockFit
from fdvv.preprocess.process import Settings
from fdvv.preprocess.reject import Reason
from fdvv.recording.types import Bench, Source
from tests.support.captures import capture, recorded


def test_takes_that_are_left_out_are_grouped_by_reason_and_many_are_counted() -> None:
    judged = tuple(
        replace(one, reason=Reason.OFF_PACE if i < 8 else Reason.TWO if i == 8 else None)
        for i, one in enumerate(recorded().processed.judged)
    )
    said = used_and_left_out(replace(recorded().processed, judged=judged))
    assert said.startswith("3 of 12 presses averaged")
    assert "far off the pace of the others (takes 4, 5, 6, 7, 8, 9 and 2 more)" in said
    assert "two presses where one was asked for (take 12)" in said


def test_nothing_is_said_of_what_was_not_done() -> None:
    plain = replace(recorded().processed, clock=ClockFit(0.0), probe=None)
    said = method_of(replace(capture(), bench=Bench()), plain)
    assert not any(word in said for word in ("clock", "filter", "play", "probe"))
    assumptions = assumptions_of(replace(capture(), bench=Bench()), Settings(cap_g=2.5))
    assert len(assumptions) == 2
    assert "2.5 g" in assumptions[0]


def test_the_source_names_takes_files_and_who_pressed() -> None:
    recording = replace(capture(), sources=(Source("a.csv", "0" * 64, "motive"),), person="participant B")
    assert source_of(recording) == "15 takes of mx-clear; participant B; a.csv (motive)"
