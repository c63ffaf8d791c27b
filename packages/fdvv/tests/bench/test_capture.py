"""The guided capture: its plan, its looks, what it asks again, and that it goes on where it stopped."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fdvv.bench.capture import CaptureGuide, TakeDone, TakeRequest, capture_session
from fdvv.bench.plan import Outcome, Step, capture_duration_s, capture_steps, settle
from fdvv.bench.settings import CaptureSettings
from fdvv.bench.take_check import TakeCheck, quick_look
from fdvv.device.bench import BenchInfo, CaptureDevice, Cue, open_bench
from fdvv.errors import DeviceError
from fdvv.recording.file import load_recording
from fdvv.recording.types import Bench, Quantity, Recording, Stage, Stream, Take
from fdvv.twin.capture.bench import CaptureBench
from fdvv.twin.capture.participant import Participant
from fdvv.twin.capture.rig import CaptureRig
from fdvv.twin.files import load_button
from fdvv.twin.finger import Finger
from fdvv.twin.rig import ForceSensor
from tests.recording.strategies import contents

SMALL = CaptureSettings(paces_mm_s=(50.0, 100.0), presses=3)


def takes_of(recording: Recording) -> Any:
    """Return all that the takes hold, to the bit, whenever they were made."""
    return contents(tuple(replace(take, made="") for take in recording.takes))


# -- the plan --


def test_the_procedure_is_rest_probe_and_fifteen_presses_at_each_of_four_paces() -> None:
    steps = capture_steps(CaptureSettings())
    assert [s.stage for s in steps[:2]] == [Stage.REST, Stage.PROBE]
    assert [s.velocity_mm_s for s in steps[2:]] == [v for v in (50.0, 100.0, 150.0, 200.0) for _ in range(15)]
    assert all(s.stage is Stage.PRESS for s in steps[2:])
    assert capture_steps(CaptureSettings(probe=False))[1] == Step(Stage.PRESS, 50.0)


def test_shuffled_blocks_hold_each_pace_once_in_an_order_that_the_seed_repeats() -> None:
    plan = CaptureSettings(shuffled=True, seed=4)
    velocities = [s.velocity_mm_s for s in capture_steps(plan)[2:]]
    assert all(sorted(velocities[i : i + 4]) == [50, 100, 150, 200] for i in range(0, 60, 4))  # type: ignore[type-var]
    assert velocities != [s.velocity_mm_s for s in capture_steps(CaptureSettings(shuffled=True, seed=5))[2:]]
    assert capture_steps(plan) == capture_steps(CaptureSettings(shuffled=True, seed=4))


def test_the_session_takes_a_person_less_than_five_minutes() -> None:
    """Sixty presses, the probe, the bench at rest, and one press in seven made again."""
    assert 150 < capture_duration_s(CaptureSettings(), 4.0, repeated=9) < 300


def test_a_take_counts_for_the_first_open_step_of_its_kind_and_enough_tries_settle_it() -> None:
    a, b = Step(Stage.PRESS, 50.0), Step(Stage.PRESS, 100.0)
    outcomes: tuple[Outcome, ...] = (Outcome(a), Outcome(b), Outcome(a))
    outcomes = settle(outcomes, b, False, 1)
    assert outcomes[1] == Outcome(b, 1, False)
    outcomes = settle(outcomes, b, False, 1)
    assert outcomes[1] == Outcome(b, 2, True)
    outcomes = settle(settle(outcomes, a, True, 1), a, True, 1)
    assert all(outcome.settled for outcome in outcomes)
    assert settle(outcomes, a, True, 1) == outcomes


# -- the quick look --


def looked_at(kinds: tuple[str, ...], count: int = 20, velocity_mm_s: float = 100.0) -> list[TakeCheck]:
    """Return checks of presses that all fail in one of these kinds, or in none."""
    person = Participant(0.0, 1.0, kinds) if kinds else Participant(0.0, 0.0)
    bench = CaptureBench(
        load_button("mx-clear"), CaptureRig(), Finger(), ForceSensor(), person, np.random.default_rng(3)
    )
    return [quick_look(bench.take(n, Stage.PRESS, velocity_mm_s).take, 4.0) for n in range(1, count + 1)]


@pytest.mark.parametrize("velocity_mm_s", [50.0, 100.0, 150.0, 200.0])
def test_a_good_press_is_found_good(velocity_mm_s: float) -> None:
    checks = looked_at((), 30, velocity_mm_s)
    good = [v for v in checks if v.ok]
    assert len(good) >= 28
    assert np.median([v.travel_mm for v in good]) == pytest.approx(4.03, abs=0.05)


@pytest.mark.parametrize(
    ("kind", "words"),
    [
        ("double tap", "pressed twice"),
        ("pace", "too "),
        ("marker knocked", "marker moved"),
        ("marker hidden", "hidden"),
        ("hesitation", "paused|too slow"),
    ],
)
def test_a_press_that_went_wrong_is_found_and_the_reason_reported(kind: str, words: str) -> None:
    bad = [v for v in looked_at((kind,)) if not v.ok]
    assert len(bad) >= 16
    explained = [v for v in bad if re.search(words, v.reason)]
    assert len(explained) >= 0.7 * len(bad)
    assert all(";" in v.reason for v in bad), "every reason says what to do"


def test_the_measured_pace_of_a_press_is_the_true_one() -> None:
    from fdvv.twin.pace import mean_speed_mm_s

    bench = CaptureBench(load_button("mx-clear"), CaptureRig(), Finger(), ForceSensor(), Participant(0, 0),
                         np.random.default_rng(9))  # fmt: skip
    ratios = []
    for number in range(1, 31):
        made = bench.take(number, Stage.PRESS, 150.0)
        trace = made.truth.trace
        assert trace is not None
        true = mean_speed_mm_s(trace.t_s, trace.displacement_mm, 4.0)
        ratios.append(quick_look(made.take, 4.0).achieved_mm_s / true)
    assert np.median(ratios) == pytest.approx(1.0, abs=0.05)
    assert np.abs(np.array(ratios) - 1).max() < 0.25


def stream(name: str, quantity: Quantity, values: Any) -> Stream:
    t_s = np.asarray(np.arange(len(values)) / 256, dtype=np.float64)
    return Stream(name, quantity, "board", t_s, np.asarray(values, dtype=np.float64))


WAY, FORCE = Quantity.DISPLACEMENT, Quantity.FORCE
NOTHING = Take(1, (stream("f", FORCE, np.zeros(50)),), (), Stage.PRESS, 50.0)


@pytest.mark.parametrize(
    ("take", "words"),
    [
        (replace(NOTHING, streams=()), "nothing shows where the cap is"),
        (NOTHING, "no press was felt"),
        (replace(NOTHING, streams=(stream("x", WAY, np.full(50, np.nan)),)), "hardly ever seen"),
        (replace(NOTHING, streams=(stream("x", WAY, np.zeros(50)),)), "no press was seen"),
        (replace(NOTHING, streams=(stream("x", Quantity.MARKER, np.zeros((50, 3))),)), "no press was seen"),
        (replace(NOTHING, stage=Stage.REST, streams=(stream("f", FORCE, np.arange(50)),)), "touched"),
        (
            replace(NOTHING, stage=Stage.PROBE, streams=(
                stream("f", FORCE, np.zeros(50)), stream("x", WAY, np.arange(50)),
            )),
            "felt no force",
        ),
    ],
)  # fmt: skip
def test_a_take_that_shows_nothing_is_not_good(take: Take, words: str) -> None:
    check = quick_look(take)
    assert not check.ok
    assert words in check.reason


def test_where_cameras_record_for_themselves_the_force_alone_tells_a_press() -> None:
    force_cN = np.concatenate([np.full(20, 9.0), np.linspace(10, 150, 10), np.full(20, 9.0)])
    check = quick_look(replace(NOTHING, streams=(stream("f", FORCE, force_cN),)))
    assert check.ok
    assert np.isnan(check.achieved_mm_s)


# -- the session --


def test_a_session_on_the_twin_records_what_the_plan_asks(tmp_path: Path) -> None:
    asked, done = list[TakeRequest](), list[TakeDone]()

    def cue(ask: TakeRequest) -> Callable[[float], None]:
        asked.append(ask)
        return lambda _t_s: None

    path = tmp_path / "a.recording.jsonl"
    bench = open_bench("twin", "mx-clear", "clumsy", 2)
    result = capture_session(bench, path, "mx-clear", SMALL, CaptureGuide(cue, done.append))
    assert result.recording.simulated
    assert takes_of(result.recording) == takes_of(load_recording(path))
    assert [(p.velocity_mm_s, p.good + p.missed) for p in result.velocities] == [(50.0, 3), (100.0, 3)]
    assert (
        len(asked) == len(done) == len(result.recording.takes) == sum(p.made for p in result.velocities) + 2
    )
    bad = [d for d in done if not d.check.ok]
    assert bad
    for event, ask in zip(done, asked[1:], strict=False):
        assert ask.again == ("" if event.check.ok or event.missed else event.check.reason)
    assert done[-1].done == done[-1].total == 8
    assert asked[2].travel_mm == pytest.approx(4.0, abs=0.05), "the probe has measured it"


def test_a_press_that_stays_bad_is_asked_for_so_often_and_then_done_without(tmp_path: Path) -> None:
    class Hopeless:
        """Records nothing but an empty cap."""

        def facts(self) -> BenchInfo:
            return BenchInfo("still", True, Bench())

        def take(self, number: int, stage: Stage, velocity_mm_s: float | None, _cue: Cue) -> Take:
            ways = (stream("x", WAY, np.zeros(50)),)
            return Take(number, ways, (), stage, velocity_mm_s)

        def close(self) -> None:
            pass

    done = list[TakeDone]()
    plan = CaptureSettings(paces_mm_s=(50.0,), presses=2, probe=False, repeats=2)
    result = capture_session(Hopeless(), tmp_path / "a", "x", plan, CaptureGuide(done=done.append))
    assert len(result.recording.takes) == 1 + 2 * 3
    assert [d.missed for d in done] == [False, False, False, True, False, False, True]
    assert (result.velocities[0].good, result.velocities[0].missed, result.velocities[0].made) == (0, 2, 6)


class Fails:
    """The twin, but something happens at one take."""

    def __init__(self, bench: CaptureDevice, at: int, error: BaseException) -> None:
        self._bench, self._at, self._error = bench, at, error

    def facts(self) -> BenchInfo:
        return self._bench.facts()

    def take(self, number: int, stage: Stage, velocity_mm_s: float | None, cue: Cue) -> Take:
        if number == self._at:
            raise self._error
        return self._bench.take(number, stage, velocity_mm_s, cue)

    def close(self) -> None:
        self._bench.close()


@pytest.mark.parametrize("error", [KeyboardInterrupt(), DeviceError("bench: the cable is out")])
def test_a_session_that_was_stopped_anywhere_goes_on_to_the_same_recording(
    tmp_path: Path, error: BaseException
) -> None:
    bench = open_bench("twin", "mx-clear", "clumsy", 7)
    whole = capture_session(bench, tmp_path / "whole", "mx-clear", SMALL)
    for at in (1, 2, 5, len(whole.recording.takes)):
        path = tmp_path / f"stopped-{at}"
        kept = "1 take is kept" if at == 2 else f"{at - 1} takes are kept"
        with pytest.raises(type(error), match=f"{kept} in .*stopped-{at}; run the same command again"):
            capture_session(Fails(bench, at, error), path, "mx-clear", SMALL)
        notices = list[str]()
        fresh = open_bench("twin", "mx-clear", "clumsy", 7)
        again = capture_session(fresh, path, "mx-clear", SMALL, CaptureGuide(notice=notices.append))
        assert takes_of(again.recording) == takes_of(whole.recording)
        assert (again.velocities, len(notices)) == (whole.velocities, int(at > 1))
        assert at == 1 or "goes on" in notices[0]


def test_a_larger_plan_goes_on_with_what_is_missing(tmp_path: Path) -> None:
    path = tmp_path / "a"
    capture_session(open_bench("twin", "mx-clear", "steady"), path, "mx-clear", SMALL)
    more = SMALL.replace(paces_mm_s=(50.0, 100.0, 200.0), presses=4)
    found = capture_session(open_bench("twin", "mx-clear", "steady"), path, "mx-clear", more)
    assert [(p.good + p.missed, p.wanted) for p in found.velocities] == [(4, 4)] * 3


def test_the_cue_tells_contact_and_bottom_in_the_time_of_the_stroke(tmp_path: Path) -> None:
    cues = list[Cue]()

    class Watched(Fails):
        def take(self, number: int, stage: Stage, velocity_mm_s: float | None, cue: Cue) -> Take:
            cues.append(cue)
            return super().take(number, stage, velocity_mm_s, cue)

    plan = CaptureSettings(paces_mm_s=(200.0,), presses=1, probe=False, travel_mm=4.0)
    bench = open_bench("twin", "mx-clear")
    capture_session(Watched(bench, 0, AssertionError()), tmp_path / "a", "mx-clear", plan)
    assert cues[0].events == ()
    assert dict(cues[1].events) == {"cue contact": 1.5, "cue bottom": pytest.approx(1.52)}
    assert cues[1].length_s == pytest.approx(1.5 + 2 * 0.02 + 0.05)
