"""The bench that captures real presses: perfect, it returns its input; then one error at a time."""

from __future__ import annotations

from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fdvv.errors import ModelError
from fdvv.recording.types import Quantity, Stage, Stream, Take
from fdvv.twin.capture.bench import CaptureBench, SimulatedTake, bench_facts
from fdvv.twin.capture.participant import PARTICIPANTS, WILD, Participant
from fdvv.twin.capture.rig import CaptureRig
from fdvv.twin.files import load_button
from fdvv.twin.finger import Finger
from fdvv.twin.pace import mean_speed_mm_s
from fdvv.twin.rig import ForceSensor
from fdvv.twin.simulate_button import ButtonTrace
from fdvv.units import FloatArray

NOTHING_WRONG: dict[str, Any] = {
    "exposure_s": 0.0,
    "marker_noise_m": 0.0,
    "marker_bias_m": 0.0,
    "rocking_rad": 0.0,
    "sideways_m": 0.0,
    "askew_rad": 0.0,
    "dropped_ratio": 0.0,
    "unseen_ratio": 0.0,
    "light_noise": 0.0,
    "clock_ppm": 0.0,
    "force_zero_N": 0.0,
    "sound_low_Hz": 0.0,
    "sound_filter_s": 0.0,
    "sound_noise_V": 0.0,
    "sound_range_V": 100.0,
    "sound_bits": 0,
}
PERFECT = CaptureRig(**NOTHING_WRONG)
STEADY = PARTICIPANTS["steady"]


def a_bench(
    rig: CaptureRig = PERFECT,
    participant: Participant = STEADY,
    seed: int = 7,
    finger: Finger | None = None,
    button: str = "mx-clear",
) -> CaptureBench:
    random = np.random.default_rng(seed)
    return CaptureBench(load_button(button), rig, finger or Finger(), ForceSensor(), participant, random)


def a_press(number: int = 1, velocity_mm_s: float = 100.0, **changes: Any) -> SimulatedTake:
    return a_bench(**changes).take(number, Stage.PRESS, velocity_mm_s)


def trace_of(made: SimulatedTake) -> ButtonTrace:
    assert made.truth.trace is not None
    return made.truth.trace


def stream(take: Take, name: str) -> Stream:
    return next(stream for stream in take.streams if stream.name == name)


def in_press_s(made: SimulatedTake, name: str) -> FloatArray:
    """Return a camera stream's times on the clock of the trace."""
    setup = made.truth.setup
    own_s = stream(made.take, name).t_s
    return np.asarray((own_s - setup.camera_offset_s) / setup.camera_ratio - made.truth.begin_s)


def down_mm(made: SimulatedTake, name: str) -> FloatArray:
    """Return the downward motion of a marker: the cameras' z points up."""
    return (
        np.asarray(made.truth.setup.places_mm[("left", "right").index(name), 2])
        - (stream(made.take, name).values[:, 2])
    )


def test_a_perfect_bench_returns_its_input() -> None:
    made = a_press()
    trace = trace_of(made)
    assert trace.sensed_cN is not None
    for name in ("left", "right"):
        true_mm = np.interp(in_press_s(made, name), trace.t_s, trace.displacement_mm)
        assert np.allclose(down_mm(made, name), true_mm, atol=1e-9)
    force, sound = stream(made.take, "force"), stream(made.take, "sound")
    assert force.raw.dtype == np.int16
    assert np.allclose(force.values, trace.sensed_cN[trace.tick], atol=1e-9)
    heard = 2e-3 * (trace.velocity_mm_s + trace.plate_velocity_mm_s)[trace.tick]
    assert np.allclose(sound.values, heard, atol=1e-9)
    assert np.allclose(force.t_s * 1e3, np.round(force.t_s * 1e3), atol=1e-6)
    assert np.allclose(np.diff(stream(made.take, "left").t_s), 1 / 256)


def test_a_take_is_the_same_whatever_was_taken_before() -> None:
    typical = PARTICIPANTS["typical"]
    straight, again = a_bench(CaptureRig(), typical), a_bench(CaptureRig(), typical)
    straight.take(1, Stage.REST)
    straight.take(2, Stage.PRESS, 50.0)
    first, second = (bench.take(3, Stage.PRESS, 100.0).take for bench in (straight, again))
    assert first.marks == second.marks
    for a, b in zip(first.streams, second.streams, strict=True):
        assert np.array_equal(a.t_s, b.t_s)
        assert np.array_equal(a.raw, b.raw, equal_nan=True)
    other = a_bench(CaptureRig(), typical, seed=8).take(3, Stage.PRESS, 100.0).take
    assert not np.array_equal(other.streams[0].raw, first.streams[0].raw)


def test_both_clocks_go_on_through_a_session_on_one_line() -> None:
    bench = a_bench(replace(PERFECT, clock_ppm=200.0))
    ends = [bench.take(n, Stage.PRESS, 200.0) for n in (1, 75)]
    assert ends[1].truth.begin_s - ends[0].truth.begin_s == pytest.approx(74 * 4.0, abs=0.5)
    setup = ends[0].truth.setup
    assert 1e-5 < abs(setup.camera_ratio - 1) < 1e-3
    for made in ends:
        trace = trace_of(made)
        true_mm = np.interp(in_press_s(made, "left"), trace.t_s, trace.displacement_mm)
        assert np.allclose(down_mm(made, "left"), true_mm, atol=1e-9)
    frames = np.concatenate([stream(made.take, "left").t_s for made in ends]) - setup.phase_s
    assert np.allclose(frames * 256, np.round(frames * 256), atol=1e-6)


def test_the_light_blinks_before_the_cap_moves_and_every_blink_is_seen() -> None:
    bench = a_bench(replace(PERFECT, exposure_s=3e-4))
    for number in range(1, 20):
        made = bench.take(number, Stage.PRESS, 200.0)
        trace, setup = trace_of(made), made.truth.setup
        on, off = made.take.times_s("light on"), made.take.times_s("light off")
        assert on.size == off.size == 4
        assert len(set(np.round(np.diff(np.sort(np.concatenate([on, off]))), 4))) >= 5
        moves_s = made.truth.begin_s + trace.t_s[np.argmax(trace.displacement_mm > 0.3)]
        assert off[-1] + 0.05 < moves_s
        light = stream(made.take, "light")
        # a frame is lit by as much of the light as falls into it, by the true relation of the clocks
        starts = setup.camera_s(np.array([on, off]))
        middle = light.t_s[:, None] + 1.5e-4
        lit = ((middle > starts[0]) & (middle < starts[1])).any(axis=1)
        edge = np.abs(middle[..., None] - starts.T).min(axis=(1, 2)) < 1.6e-4
        assert np.array_equal(light.values[~edge] > 0.5, lit[~edge])
        assert all((lit & (light.t_s > a - 1e-3) & (light.t_s < b)).sum() >= 2 for a, b in starts.T)


@pytest.mark.parametrize("button", ["mx-clear", "hp-pr1101u"])
def test_the_circuit_is_marked_where_the_sampled_board_first_sees_it_change(button: str) -> None:
    made = a_press(button=button)
    trace = trace_of(made)
    assert trace.closing_s is not None
    late_s = made.take.times_s("closed")[0] - made.truth.begin_s - trace.closing_s
    assert 0 <= late_s < 1.0001e-3
    assert made.take.times_s("open").size


def test_marker_noise_has_the_asked_size_and_bias_moves_a_take_as_a_whole() -> None:
    clean = a_press()
    noisy = a_press(rig=replace(PERFECT, marker_noise_m=5e-5))
    assert np.std(down_mm(noisy, "left") - down_mm(clean, "left")) == pytest.approx(0.05, rel=0.3)
    bench = a_bench(replace(PERFECT, marker_bias_m=1e-4))
    rests = [down_mm(bench.take(n, Stage.PRESS, 100.0), "left")[0] for n in range(1, 25)]
    assert np.std(rests) == pytest.approx(0.1, rel=0.4)


def test_rocking_parts_the_markers_and_their_mean_keeps_little_of_it() -> None:
    clean, rocked = (a_press(rig=replace(PERFECT, rocking_rad=r)) for r in (0.0, 0.03))
    left, right = (down_mm(rocked, n) - down_mm(clean, n) for n in ("left", "right"))
    apart = np.abs(left - right).max()
    assert 0.005 < apart < 0.5
    assert np.abs(left + right).max() / 2 == pytest.approx(0.025 * apart, rel=0.01)


def test_a_bench_askew_sees_the_press_on_all_three_axes() -> None:
    made = a_press(rig=replace(PERFECT, askew_rad=0.05))
    moved = stream(made.take, "left").values - made.truth.setup.places_mm[0]
    trace = trace_of(made)
    assert np.allclose(
        np.linalg.norm(moved, axis=1),
        np.abs(np.interp(in_press_s(made, "left"), trace.t_s, trace.displacement_mm)),
        atol=1e-9,
    )
    assert np.abs(moved[:, :2]).max() > 0.02


def test_lost_frames_are_left_out_and_a_marker_that_was_not_found_is_nan() -> None:
    whole, lost = a_press(), a_press(rig=replace(PERFECT, dropped_ratio=0.3))
    sizes = [stream(made.take, "left").t_s.size for made in (lost, whole)]
    assert 0.5 < sizes[0] / sizes[1] < 0.9
    assert stream(lost.take, "light").t_s.size == sizes[0]
    unseen = a_press(rig=replace(PERFECT, unseen_ratio=0.2))
    gone = [np.isnan(stream(unseen.take, name).values) for name in ("left", "right")]
    assert all(0.1 < rows.mean() < 0.35 and np.array_equal(rows[:, 0], rows[:, 2]) for rows in gone)
    assert not np.array_equal(gone[0], gone[1])


def test_an_exposure_averages_the_motion() -> None:
    made = a_press(rig=replace(PERFECT, exposure_s=0.004))
    trace, at_s = trace_of(made), in_press_s(made, "left")
    middle_mm, start_mm = (np.interp(at_s + d, trace.t_s, trace.displacement_mm) for d in (0.002, 0.0))
    seen = down_mm(made, "left")
    assert np.abs(seen - middle_mm).max() < 0.3 * np.abs(seen - start_mm).max()


def test_a_microphone_with_a_high_pass_does_not_hear_a_cap_at_rest() -> None:
    heard = stream(a_press(rig=replace(PERFECT, sound_low_Hz=90.0)).take, "sound").values
    assert np.abs(heard[:20]).max() < 0.05 * np.abs(heard).max()


def test_a_wide_band_microphone_samples_faster_and_agrees_at_the_slow_one_s_moments() -> None:
    slow, fast = (stream(a_press(rig=replace(PERFECT, sound_Hz=Hz)).take, "sound") for Hz in (1e3, 1e4))
    assert fast.rate_Hz == pytest.approx(1e4)
    assert slow.values.size == -(-fast.values.size // 10)
    assert np.allclose(fast.values[::10], slow.values, atol=1e-9)


def test_converters_write_counts_whose_scale_and_zero_give_the_unit() -> None:
    made = a_press(rig=CaptureRig())
    sound, force = stream(made.take, "sound"), stream(made.take, "force")
    assert sound.raw.dtype == force.raw.dtype == np.int16
    assert sound.scale == pytest.approx(3.3 / 1024)
    assert (sound.raw.min(), sound.raw.max()) >= (0, 0)
    assert sound.raw.max() <= 1023
    assert force.scale == pytest.approx(981 / 1024)


def test_the_bench_at_rest_tells_the_force_sensor_s_zero() -> None:
    bench = a_bench(replace(PERFECT, force_zero_N=0.1))
    rest = bench.take(1, Stage.REST)
    assert np.ptp(trace_of(rest).displacement_mm) < 1e-3
    zero_cN = 100 * bench.setup.force_zero_N
    assert abs(zero_cN) > 1.0
    assert stream(rest.take, "force").values.mean() == pytest.approx(zero_cN, abs=0.3)
    assert rest.take.velocity_mm_s is None


@pytest.mark.parametrize("button", ["mx-clear", "macbook-pro-2011"])
def test_a_probe_follows_the_slow_curve_down_and_up_on_its_stand_s_own_clock(button: str) -> None:
    made = a_bench(button=button).take(1, Stage.PROBE)
    probed, take = made.truth.probed, made.take
    assert probed is not None
    assert {s.clock for s in take.streams} == {"stand"}
    (force,), (way,) = take.of(Quantity.FORCE), take.of(Quantity.DISPLACEMENT)
    turn = int(np.argmax(way.values))
    contact = int(np.argmax(force.values > 5))
    x_mm = way.values - way.values[turn] + probed.displacement_mm[-1]
    got = np.interp(x_mm[contact + 5 : turn], probed.displacement_mm, probed.press_cN)
    # play 1 cN, noise 0.3 cN, steps of 1 cN
    assert np.sqrt(np.mean((force.values[contact + 5 : turn] - got) ** 2)) < 1.2
    back = np.interp(x_mm[turn + 1 :], probed.displacement_mm, probed.release_cN)
    on = x_mm[turn + 1 :] > 0.1
    assert np.sqrt(np.mean((force.values[turn + 1 :] - back)[on] ** 2)) < 1.2
    assert np.all(force.values[:20] < 2)
    curve = load_button(button).curve
    closed_mm = np.interp(take.times_s("closed")[0], way.t_s[:turn], x_mm[:turn])
    assert closed_mm == pytest.approx(1e3 * curve.close_m, abs=0.01)
    assert 15 < way.t_s[-1] * 4 / probed.displacement_mm[-1] < 20


def test_the_facts_are_what_a_builder_knows() -> None:
    facts = bench_facts(CaptureRig(), ForceSensor())
    assert (facts.force_filter_ms, facts.tip_mass_g, facts.exposure_ms) == (0.33, 2.0, 0.3)
    assert facts.clocks_go_on
    assert a_bench().facts() == bench_facts(PERFECT, ForceSensor())


@pytest.mark.parametrize("lift_m", [0.0, 0.004])
def test_every_take_shows_rest_before_and_after_the_press(lift_m: float) -> None:
    finger = replace(Finger(), habit=replace(Finger().habit, lift_m=lift_m))
    bench = a_bench(participant=Participant(0.2, 0.5), finger=finger)
    for number in range(1, 13):
        trace = trace_of(bench.take(number, Stage.PRESS, (50.0, 200.0)[number % 2]))
        away = trace.t_s[trace.displacement_mm > trace.displacement_mm[0] + 0.15]
        assert away[0] > 0.15
        assert trace.t_s[-1] - away[-1] > 0.08


def test_a_press_needs_a_pace_that_fits_between_two_takes() -> None:
    with pytest.raises(ModelError, match="pace"):
        a_bench().take(1, Stage.PRESS)
    with pytest.raises(ModelError, match="too slow"):
        a_press(velocity_mm_s=3.0)


def test_the_page_of_the_bench_names_every_error_and_every_way_to_go_wrong() -> None:
    page = (Path(__file__).parents[4] / "docs" / "explanation" / "capture-bench.md").read_text()
    names = [*(f.name for f in fields(CaptureRig)), *WILD, *PARTICIPANTS]
    assert [name for name in names if f"`{name}`" not in page] == []


# -- the participant --


def goes_wrong(kind: str, seed: int = 3, velocity_mm_s: float = 100.0) -> tuple[SimulatedTake, SimulatedTake]:
    """Return a press that goes wrong in one way, and the same press gone right."""
    person = Participant(0.0, 1.0, (kind,))
    return tuple(a_press(velocity_mm_s=velocity_mm_s, participant=p, seed=seed) for p in (person, STEADY))  # type: ignore[return-value]


def test_presses_go_wrong_as_often_as_the_participant_says() -> None:
    bench = a_bench(participant=PARTICIPANTS["clumsy"])
    intents = [bench.take(n, Stage.PRESS, 200.0).truth.intent for n in range(1, 301)]
    wild = [intent for intent in intents if intent.outcome == "wild"]
    assert len(wild) / 300 == pytest.approx(0.25, abs=0.08)
    assert sum(i.outcome == "incomplete" for i in intents) / 300 == pytest.approx(0.08, abs=0.05)
    assert {intent.kind for intent in wild} == set(WILD)


@pytest.mark.parametrize("velocity_mm_s", [50.0, 200.0])
def test_an_incomplete_press_never_reaches_the_bottom(velocity_mm_s: float) -> None:
    bench = a_bench(participant=Participant(1.0, 0.0))
    for number in range(1, 9):
        deepest_mm = trace_of(bench.take(number, Stage.PRESS, velocity_mm_s)).displacement_mm.max()
        assert 0.4 < deepest_mm <= 4.0 - 0.15


def test_a_press_off_the_pace_is_far_off() -> None:
    speeds = []
    for seed in range(12):
        trace = trace_of(goes_wrong("pace", seed)[0])
        speeds.append(mean_speed_mm_s(trace.t_s, trace.displacement_mm, 4.0))
    assert all(speed < 75 or speed > 130 for speed in speeds)
    assert min(speeds) < 75
    assert max(speeds) > 130


def test_a_double_tap_closes_the_circuit_twice() -> None:
    made = goes_wrong("double tap")[0]
    assert made.take.times_s("closed").size == 2
    trace = trace_of(made)
    peaks = trace.displacement_mm > 3.9
    assert np.sum(np.diff(peaks.astype(int)) == 1) >= 2


def test_a_hesitating_finger_stops_on_its_way_and_goes_on() -> None:
    made, right = goes_wrong("hesitation")
    trace, stop_s = trace_of(made), made.truth.intent.amount
    x, t = trace.displacement_mm, trace.t_s
    way = (x > 0.3) & (x < 3.8) & (t < t[np.argmax(x > 3.9)])
    assert 1e-4 * np.sum(way & (np.abs(trace.velocity_mm_s) < 10)) > 0.5 * stop_s
    assert x.max() > 3.95
    assert t[-1] > trace_of(right).t_s[-1] + 0.9 * stop_s


def test_a_knocked_marker_jumps_once_and_only_it() -> None:
    wrong, right = goes_wrong("marker knocked")
    intent = wrong.truth.intent
    for i, name in enumerate(("left", "right")):
        off = stream(wrong.take, name).values - stream(right.take, name).values
        assert np.abs(off[0]).max() < 1e-9
        assert np.linalg.norm(off[-1]) == pytest.approx(
            intent.amount if i == intent.marker else 0.0, abs=1e-9
        )


def test_a_slipped_sensor_reads_too_little_from_then_on() -> None:
    wrong, right = goes_wrong("sensor slipped")
    force, whole = (stream(made.take, "force").values for made in (wrong, right))
    assert 0.6 <= wrong.truth.intent.amount <= 0.85
    peak = int(np.argmax(whole))
    assert force[peak] / whole[peak] == pytest.approx(wrong.truth.intent.amount, abs=0.02)
    assert np.array_equal(force[:150], whole[:150])


def test_a_hidden_marker_is_missing_for_a_while_and_the_other_is_seen() -> None:
    made = goes_wrong("marker hidden")[0]
    gone = [np.isnan(stream(made.take, name).values[:, 0]) for name in ("left", "right")]
    hidden = gone[made.truth.intent.marker]
    assert gone[1 - made.truth.intent.marker].sum() == 0
    assert hidden.sum() / 256 == pytest.approx(made.truth.intent.amount, abs=1.1 / 256)
    assert np.sum(np.diff(hidden.astype(int)) == 1) == 1


@pytest.mark.parametrize(
    "wrong",
    [
        {"incomplete_ratio": 0.7, "wild_ratio": 0.5},
        {"wild_ratio": -0.1},
        {"wild_ratio": float("nan")},
        {"kinds": ()},
        {"kinds": ("sneeze",)},
    ],
)
def test_an_impossible_participant_is_refused(wrong: dict[str, Any]) -> None:
    with pytest.raises(ModelError):
        Participant(**wrong)
