"""What the checker refuses and warns of, each named by state and place."""

from __future__ import annotations

from dataclasses import replace

import pytest

from fdvv.errors import InputError
from fdvv.model.file import load_builtin
from fdvv.model.vibration import Mode
from fdvv.program.button import button_program
from fdvv.program.check import Severity, check_program, require_accepted
from fdvv.program.condition import Condition, Transition, When
from fdvv.program.library import make
from fdvv.program.program import Program, Signal, State, Velocity
from fdvv.program.surface import Limits, Surface, flat, line

PUSH = flat("push", 40.0)


def deeper(mm: float, to: str) -> Transition:
    return Transition(to, Condition(When.DEEPER_THAN, mm))


def shallower(mm: float, to: str) -> Transition:
    return Transition(to, Condition(When.SHALLOWER_THAN, mm))


def two(*, down_at: float = 2.0, up_at: float = 1.8, surface: Surface = PUSH, **down: object) -> Program:
    """Return a plain button whose state `down` may be changed."""
    up = State("up", surface.name, surface.name, (deeper(down_at, "down"),))
    lower = State("down", surface.name, surface.name, (shallower(up_at, "up"),), key=1)
    return Program("two", 4.0, "up", (up, replace(lower, **down)), (surface,))  # type: ignore[arg-type]


def refusals(program: Program, limits: Limits | None = None) -> list[tuple[str, str]]:
    return [(f.state, f.reason) for f in check_program(program, limits).refused]


def test_a_plain_button_is_accepted_with_its_figures() -> None:
    report = check_program(two())
    assert report.findings == ()
    assert report.return_s is not None
    assert 0.05 < report.return_s < 1.0
    assert report.stiffness_cN_mm == 0.0
    require_accepted(two())


def test_force_beyond_the_limit_counts_the_bias() -> None:
    found = refusals(two(surface=flat("push", 400.0), bias_cN=60.0))
    assert [state for state, _ in found] == ["down"]
    assert "479.6 cN, weight included, the rig gives 440" in found[0][1]


def test_a_step_steeper_than_the_rigs_slew_is_refused_and_one_that_may_buzz_is_a_warning() -> None:
    def step(width_mm: float) -> Surface:
        return line("push", (0.0, 40.0), (1.0, 40.0), (1.0 + width_mm, 140.0))

    (steep, _) = check_program(two(surface=step(0.1))).refused
    assert (steep.state, steep.place) == ("up", "surface 'push' at 1.00 mm")
    assert "cN/s" in steep.reason
    gentle = check_program(two(surface=step(0.2)))
    assert [f.severity for f in gentle.findings] == [Severity.WARNING] * 2
    assert "buzz" in gentle.warnings[0].reason
    assert check_program(two(surface=step(0.25))).findings == ()


def test_the_contact_step_of_a_real_switch_is_no_slew() -> None:
    assert check_program(button_program(load_builtin("mx-red"))).refused == ()


def test_a_bias_that_changes_faster_than_the_rig_is_refused() -> None:
    assert refusals(two(bias_end_cN=300.0, bias_ms=1))[0][0] == "down"
    assert refusals(two(bias_end_cN=30.0, bias_ms=100)) == []


def test_a_state_that_no_way_leads_to_is_refused() -> None:
    program = two()
    lost = State("lost", "push", "push", (shallower(1.0, "up"),))
    assert ("lost", "no way leads to it") in refusals(replace(program, states=(*program.states, lost)))


def test_a_vibration_repeated_before_it_ends_is_refused() -> None:
    signal = Signal("long", 0.05, (Mode(200.0, 5.0, 50.0),))
    quick = replace(two(repeat_signal=None), signals=(signal,))
    up, down = quick.states
    for period_ms, refused in ((49, 1), (50, 0)):
        state = replace(down, repeat_signal="long", repeat_ms=period_ms)
        assert len(refusals(replace(quick, states=(up, state)))) == refused


def test_a_hold_that_overheats_the_coil_is_refused_and_one_that_derates_is_a_warning() -> None:
    hot = replace(Limits().settings, full_duty_rise_K=2000)
    (first, _) = check_program(two(surface=flat("push", 400.0)), Limits(settings=hot)).refused
    assert first.place == "at the bottom"
    assert "420 cN held warms the coil" in first.reason
    warm = check_program(two(surface=flat("push", 300.0)), Limits(settings=hot))
    assert warm.refused == ()
    assert "weakens" in warm.warnings[0].reason


def test_a_transition_beyond_the_travel_is_a_warning() -> None:
    (finding,) = check_program(two(down_at=4.5)).warnings
    assert (finding.state, finding.place) == ("up", "transition 1")


def test_a_travel_beyond_the_stop_is_refused() -> None:
    assert "6.2" in refusals(replace(two(), travel_mm=6.3))[0][1]


# -- programs that hang --------------------------------------------------


@pytest.mark.parametrize(
    ("up", "down"),
    [
        (Condition(When.DEEPER_THAN, 1.0), Condition(When.SHALLOWER_THAN, 2.0)),
        (Condition(When.ALWAYS), Condition(When.ALWAYS)),
        (Condition(When.DEEPER_THAN, 1.0), Condition(When.AFTER, 0)),
        (Condition(When.DEEPER_THAN, 1.0), Condition(When.RISEN_BY, 0.0)),
        (Condition(When.FASTER_THAN, 50.0), Condition(When.SLOWER_THAN, 80.0)),
    ],
)
def test_states_that_follow_each_other_without_motion_are_refused(up: Condition, down: Condition) -> None:
    states = (
        State("up", "push", "push", (Transition("down", up),), velocity=Velocity.CONTINUOUS),
        State("down", "push", "push", (Transition("up", down),), velocity=Velocity.CONTINUOUS),
    )
    found = refusals(Program("hang", 4.0, "up", states, (PUSH,)))
    assert ("up", "without any motion it goes up → down → up for ever") in found


def test_an_earlier_transition_may_save_a_program_from_hanging() -> None:
    up = State("up", "push", "push", (deeper(2.0, "down"),))
    down = State("down", "push", "push", (deeper(1.5, "deep"), shallower(2.5, "up")))
    deep = State("deep", "push", "push", (shallower(1.0, "up"),))
    saved = Program("saved", 4.0, "up", (up, down, deep), (PUSH,))
    assert not any("without any motion" in reason for _, reason in refusals(saved))
    assert any("without any motion" in reason for _, reason in refusals(two(up_at=2.5)))


# -- programs that never come back --------------------------------------------------


def test_a_state_that_waits_for_the_host_alone_is_refused() -> None:
    found = refusals(two(transitions=(Transition("up", Condition(When.HOST_EVENT, 1)),)))
    assert found == [("down", "nothing is sure to lead on to the start state")]


def test_a_guard_that_need_not_hold_makes_a_way_back_unsure() -> None:
    guarded = Transition("up", Condition(When.SHALLOWER_THAN, 1.0), Condition(When.FASTER_THAN, 10.0))
    assert refusals(two(transitions=(guarded,))) != []
    slower = Transition("up", Condition(When.SHALLOWER_THAN, 1.0), Condition(When.SLOWER_THAN, 10.0))
    assert refusals(two(transitions=(slower,))) != []
    assert refusals(two(transitions=(slower,), velocity=Velocity.CONTINUOUS)) == []


def test_a_button_too_weak_for_friction_and_weight_is_refused_by_where_it_sticks() -> None:
    program = two(surface=line("push", (0.0, 40.0), (2.0, 40.0), (2.5, 15.0), (4.0, 40.0)))
    assert refusals(program) == []
    stuck = check_program(program, Limits(opposing_cN=20.0)).refused
    assert {f.state for f in stuck} == {"up", "down"}
    assert all("2.5" in f.place or "2.4" in f.place for f in stuck)


def test_a_bounce_at_the_top_that_triggers_again_is_refused() -> None:
    close = make("fast-tapping", push_cN=60, trigger_mm=0.4)
    bouncy = Limits(rebound_ratio=0.9)
    assert check_program(close).refused == ()
    assert any("for ever" in reason for _, reason in refusals(close, bouncy))


def test_a_fall_that_pulls_again_before_the_top_is_refused() -> None:
    states = (
        State("up", "push", "push", (deeper(2.0, "pulled"),)),
        State("pulled", "pull", "pull", (Transition("rising", Condition(When.AFTER, 50)),)),
        State("rising", "push", "push", (shallower(3.0, "up"),)),
    )
    found = refusals(Program("again", 4.0, "up", states, (PUSH, flat("pull", -30.0))))
    assert any("up → pulled" in reason or "pulled → rising" in reason for _, reason in found)


def test_the_first_refusal_is_raised_in_one_line() -> None:
    with pytest.raises(InputError, match="state 'down', at the top: nothing is sure") as caught:
        require_accepted(two(transitions=()))
    assert "\n" not in str(caught.value)
