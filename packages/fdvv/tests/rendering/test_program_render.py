"""Programs on identified rigs: with the loop closed, by commands, and how they are judged. Simulated."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fdvv.compensation.identification.rig_file import LearnedRig
from fdvv.compensation.rig_aware import RigAware
from fdvv.device.twin import TwinDevice
from fdvv.errors import InputError
from fdvv.model.curve import Stroke
from fdvv.model.file import load_builtin
from fdvv.program.compile import compile_program
from fdvv.program.library import MAKERS, make
from fdvv.program.program import Program
from fdvv.rendering.compensate import compensate
from fdvv.rendering.evaluation.probe_curve import judge_curves
from fdvv.rendering.evaluation.program_probe import StateError, all_errors_cN, judge_states, program_force_cN
from fdvv.rendering.program_render import ProgramReport, render_program, rendering_of
from fdvv.twin.files import load_rig
from fdvv.twin.rig import LoadCell, Rig

RIG, CLEAR = load_rig("recommended"), load_builtin("mx-clear")
WITHOUT = replace(RIG, load_cell=LoadCell(fitted="no"))
SPEED_mm_s = 100.0


def identified(rig: Rig) -> LearnedRig:
    known = compensate(TwinDevice(rig, seed=1), CLEAR, (50.0, 100.0, 200.0), RigAware(1)).learned_rig
    assert known is not None
    return known


@pytest.fixture(scope="module")
def known() -> LearnedRig:
    return identified(RIG)


@pytest.fixture(scope="module")
def known_without() -> LearnedRig:
    return identified(WITHOUT)


def shipped(name: str) -> Program:
    return make(name, cooldown_ms=60) if name == "returning-later" else make(name)


def rendered(rig: Rig, known: LearnedRig, name: str) -> ProgramReport:
    return render_program(TwinDevice(rig, seed=7), shipped(name), known, [SPEED_mm_s], 2)


@pytest.mark.parametrize("name", sorted(MAKERS))
def test_with_the_loop_closed_every_program_is_felt_as_written(name: str, known: LearnedRig) -> None:
    report = rendered(RIG, known, name)
    assert report.closed
    assert report.median_cN < 2.0
    assert report.worse == []
    assert "felt as written" in report.verdict


def test_a_program_is_felt_as_written_where_half_of_it_is_off_by_less_than_a_jnd() -> None:
    errors_cN, errors_JND = np.array([1.0, 2.0, 40.0]), np.array([0.3, 0.9, 8.0])
    for times, felt in ((1.0, "is felt as written"), (2.0, "is not yet felt as written")):
        row = StateError("up", Stroke.PRESS, SPEED_mm_s, errors_cN, times * errors_JND)
        report = ProgramReport("button", "twin", True, 1, (row,), (row,))
        assert f"button {felt}, by JNDs from the literature: median 2.0 cN off" in report.verdict


@pytest.mark.parametrize("name", sorted(MAKERS))
def test_without_a_cell_every_program_is_rendered_by_commands(name: str, known_without: LearnedRig) -> None:
    report = rendered(WITHOUT, known_without, name)
    assert not report.closed
    assert report.median_cN < 6.0
    after, before = (all_errors_cN(report.at(SPEED_mm_s, way)).mean() for way in (True, False))
    assert after < 0.6 * before


def test_a_plain_button_is_judged_as_the_probe_judges_it(known: LearnedRig) -> None:
    """fdvv probe bins force and model apart from this code; states up and down together are its curve."""
    device, program = TwinDevice(RIG, seed=3), make("button")
    rendering_of(program, device, known).put_on(device)
    trace = device.press_trace(SPEED_mm_s)
    curves = judge_curves(load_builtin("mx-red"), SPEED_mm_s, [trace.press(SPEED_mm_s)])
    states = judge_states(program, [trace], SPEED_mm_s)
    for curve in curves:
        own = all_errors_cN([s for s in states if s.stroke is curve.stroke])
        assert own.mean() == pytest.approx(float(curve.mean_errors_cN[0]), abs=0.15)


def test_states_change_where_they_are_meant_to_with_the_loop_closed(known: LearnedRig) -> None:
    """The sensed displacement is half a millisecond old; the estimated one is not."""
    late_mm = []
    for closed in (False, True):
        device, program = TwinDevice(RIG, seed=5), make("multi-level")
        if closed:
            rendering_of(program, device, known).put_on(device)
        else:
            device.upload_program(compile_program(program).image)
        trace = device.press_trace(200.0)
        places = [way.when.value for state in program.states[:3] for way in state.transitions[:1]]
        entered = [int(np.argmax(trace.state == k)) for k in (1, 2, 3)]
        late_mm.append(float(np.mean(trace.displacement_mm[entered] - places)))
    assert abs(late_mm[1]) < 0.04 < late_mm[0]


def test_a_step_to_a_pull_and_a_spring_back_neither_ring_nor_open_the_loop(known: LearnedRig) -> None:
    device, program = TwinDevice(RIG, seed=6), shipped("returning-later")
    rendering_of(program, device, known).put_on(device)
    trace = device.press_trace(SPEED_mm_s)
    entered = [program.states[k].name for k in trace.state[np.flatnonzero(np.diff(trace.state, prepend=255))]]
    assert entered == ["ready", "spent", "returning", "ready"]
    spent = trace.state == 1
    # 3 N of feedback for 4 ms would throw the cap of 12 g off the finger with 1 m/s
    assert trace.cap_velocity_mm_s[spent].max() < 400.0
    # 20 ms after the spring has come back its force is there, and does not swing until the finger leaves
    back = np.flatnonzero((trace.state == 2) & (trace.displacement_mm < 3.7) & (trace.displacement_mm > 0.3))
    meant = program_force_cN(program, trace, SPEED_mm_s, np.ones(trace.t_s.size, dtype=np.bool_))
    assert np.abs(trace.force_cN - meant)[back[200:]].max() < 5.0


def test_a_program_of_a_learned_button_gets_what_was_learned_for_it(known: LearnedRig) -> None:
    learned = compensate(TwinDevice(RIG, seed=2), CLEAR, (50.0, 100.0, 150.0), RigAware(3, known))
    program, means = make("rapid-trigger", "mx-clear"), []
    for given in ((), (learned, CLEAR)):
        device = TwinDevice(RIG, seed=8)
        rendering_of(program, device, known, *given).put_on(device)
        traces = [device.press_trace(50.0) for _ in range(4)]
        means.append(float(all_errors_cN(judge_states(program, traces, 50.0)).mean()))
    assert means[1] < 0.5 * means[0]


def test_tables_learned_without_a_loop_are_refused_on_a_rig_with_one(
    known: LearnedRig, known_without: LearnedRig
) -> None:
    learned = compensate(TwinDevice(WITHOUT, seed=2), CLEAR, [100.0], RigAware(0, known_without))
    with pytest.raises(InputError, match="learned without a force loop"):
        rendering_of(make("button", "mx-clear"), TwinDevice(RIG), known, learned, CLEAR)


def test_a_pull_is_meant_to_be_felt_as_nothing() -> None:
    device, program = TwinDevice(RIG, seed=4), shipped("fast-tapping")
    device.upload_program(compile_program(program).image)
    trace = device.press_trace(SPEED_mm_s)
    meant = program_force_cN(program, trace, SPEED_mm_s, np.zeros(trace.t_s.size, dtype=np.bool_))
    names = np.array([state.name for state in program.states])[trace.state]
    assert set(meant[names == "dropping"]) == {0.0}
    assert set(meant[names == "returning"]) == {120.0}
