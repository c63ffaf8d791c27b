"""Each shipped program does what its document says: in the firmware's core, and in the interpreter alike."""

from __future__ import annotations

import numpy as np
import pytest

from fdvv.errors import InputError
from fdvv.model.file import builtin_names, load_builtin
from fdvv.program.button import ranges
from fdvv.program.check import check_program
from fdvv.program.compile import compile_program
from fdvv.program.library import Recipe, make, programs
from fdvv.program.program import Program
from fdvv.program.surface import RETURNING_cN, of_model
from tests.support.program.scripted_press import TICKS_PER_S, path, press

NAMES = [p.name for p in programs()]
TICK_mm = 50 / TICKS_PER_S
"""How far a cap at 50 mm/s goes in a tick."""


TOO_MUCH: dict[tuple[str, str], dict[str, float]] = {
    ("fast-tapping", "mx-clear"): {"trigger_mm": 1.2},
    ("multi-level", "mx-clear"): {"levels": 2},
}
"""What the check refuses by default, since this light return lets the cap bounce deep, and what helps."""


@pytest.mark.parametrize("base", builtin_names())
@pytest.mark.parametrize("name", NAMES)
def test_a_shipped_program_is_accepted_and_compiles_over_every_button(name: str, base: str) -> None:
    program = make(name, base)
    compile_program(program)
    found = check_program(program).refused
    if helps := TOO_MUCH.get((name, base)):
        assert "with the finger off it may go" in str(found[0])
        assert found[0].remedy == "move the conditions of these states apart"
        found = check_program(make(name, base, **helps)).refused
    assert found == ()


def test_forces_that_do_not_bring_the_cap_back_are_raised_and_the_program_says_by_how_much() -> None:
    program, model = make("button", "mx-clear"), load_builtin("mx-clear")
    table, raw = program.surface("release").table_cN, of_model(model, "release").table_cN
    assert table[:, 5:].min() == RETURNING_cN
    assert np.array_equal(table[:, :5], raw[:, :5])
    assert np.array_equal(table[raw >= RETURNING_cN], raw[raw >= RETURNING_cN])
    assert f"by up to {(table - raw).max():.1f}" in program.description
    assert "raised" not in make("button", "mx-red").description


def test_a_rapid_trigger_begins_below_the_bounce_of_a_weak_base_unless_it_is_set() -> None:
    def top_dead_mm(**given: float) -> float:
        return make("rapid-trigger", "rubber-dome", **given).states[1].transitions[0].when.value

    assert top_dead_mm() > 0.3
    assert top_dead_mm(top_dead_mm=0.3) == 0.3


def test_fast_tapping_drops_and_returns_by_itself() -> None:
    program = make("fast-tapping", trigger_mm=1.0, pull_cN=30, push_cN=120)
    pressed = press(program, path((0, 0), (0.02, 1.0), (0.03, 1.1), (0.08, 3.9), (0.2, 0.1), (0.25, 0)))
    entries = pressed.entries()
    assert [state for state, _ in entries] == ["ready", "dropping", "returning", "ready"]
    assert entries[1][1] == pytest.approx(1.0, abs=TICK_mm)
    assert entries[2][1] == pytest.approx(3.645, abs=0.02)
    assert entries[3][1] == pytest.approx(0.5, abs=0.02)
    settled = {
        state: pressed.forces_cN[pressed.states.index(state) + 4] for state in ("dropping", "returning")
    }
    assert settled == pytest.approx({"dropping": -30, "returning": 120}, abs=0.1)


def test_fast_tapping_gives_up_its_drop_in_time() -> None:
    held = press(make("fast-tapping", drop_ms=40), path((0, 0), (0.02, 1.2), (0.2, 1.2)))
    assert held.states.count("dropping") == 160
    assert held.states[-1] == "returning"


def test_a_non_newtonian_button_resists_as_the_cap_speeds_up() -> None:
    program = make("non-newtonian", soft_ratio=0.5, stiffening_per_m_s=5.0)
    slow, fast = (press(program, path((0, 0), (3.8 / v, 3.8))) for v in (20, 200))
    at = [float(np.interp(3.0, run.x_mm, run.forces_cN)) for run in (slow, fast)]
    assert at[1] / at[0] == pytest.approx((0.5 + 5 * 0.2) / (0.5 + 5 * 0.02), rel=0.02)


def test_a_non_newtonian_button_follows_a_change_of_speed_within_a_press() -> None:
    program = make("non-newtonian", soft_ratio=0.5, stiffening_per_m_s=5.0)
    pressed = press(program, path((0, 0), (0.1, 2.0), (0.6, 2.5), (0.61, 3.5)))
    force = pressed.forces_cN / [program.surface("press").force_at_cN(x) for x in pressed.x_mm]
    middle = [int(t * TICKS_PER_S) for t in (0.08, 0.4, 0.609)]
    assert force[middle] * 0.5 == pytest.approx([0.6, 0.505, 1.0], rel=0.03)


def test_levels_are_entered_by_depth_and_come_with_their_clicks() -> None:
    program = make("multi-level", levels=3)
    pressed = press(program, path((0, 0), (0.2, 3.8), (0.4, 0.0)))
    entries = pressed.entries()
    assert [state for state, _ in entries] == [f"level {k}" for k in (0, 1, 2, 3, 2, 1, 0)]
    starts = [0.98, 1.98, 2.96]
    assert [x for _, x in entries[1:4]] == pytest.approx(starts, abs=0.01)
    assert [x for _, x in entries[4:]] == pytest.approx([s - 0.1 for s in starts[::-1]], abs=0.01)
    assert [s for s in pressed.signals if s] == ["click 1", "click 2", "click 3"]


def test_a_level_is_preceded_by_a_detent_on_the_way_down_only() -> None:
    plain, detent = (make("multi-level", detent_cN=cN) for cN in (0.0, 25.0))
    run = [press(p, path((0, 0), (0.2, 3.8), (0.4, 0.0))) for p in (plain, detent)]
    extra = run[1].forces_cN - run[0].forces_cN
    down = np.arange(extra.size) <= 0.2 * TICKS_PER_S
    assert extra[down].max() == pytest.approx(25, abs=1)
    assert run[0].x_mm[down][np.argmax(extra[down])] % 0.98 == pytest.approx(0.98 - 0.16, abs=0.05)
    assert np.abs(extra[~down][40:]).max() < 0.3


@pytest.mark.parametrize(("dwell_s", "ticks"), [(0.9, 4), (1.1, 5)])
def test_dwelling_ticks_at_once_and_every_period(dwell_s: float, ticks: int) -> None:
    program = make("dwell-ticks", period_ms=250)
    pressed = press(program, path((0, 0), (0.1, 3.9), (0.1 + dwell_s, 3.9), (0.2 + dwell_s, 0)))
    times = pressed.times_s("tick")
    assert len(times) == ticks
    assert np.diff(times) == pytest.approx(0.25)
    assert sorted(set(pressed.keys)) == [0, 1, 2]
    assert pressed.keys[-1] == 0


def test_a_cooling_button_stays_down_until_its_time_is_over() -> None:
    program = make("returning-later", cooldown_ms=500)
    pressed = press(program, path((0, 0), (0.1, 3.5), (0.2, 3.5), (0.25, 2.0), (0.9, 2.0), (1.0, 0)))
    first = pressed.states.index("spent")
    assert pressed.states.index("returning") - first == 0.5 * TICKS_PER_S
    assert pressed.forces_cN[first + 10] == pytest.approx(-15, abs=0.1)
    assert [state for state, _ in pressed.entries()] == ["ready", "spent", "returning", "ready"]
    assert pressed.entries()[-1][1] == pytest.approx(1.705 / 2, abs=0.02)


def test_the_host_may_end_a_cooldown() -> None:
    program = make("returning-later", cooldown_ms=5000, event=3)
    trajectory = path((0, 0), (0.1, 3.5), (0.5, 3.5))
    pressed = press(program, trajectory, {1000: 2, 1200: 3})
    assert pressed.states.index("returning") == 1200


def keys_at(program: Program, *places_mm: float) -> list[int]:
    """Go to one place after the other within 5 ms each, and return the key reported there."""
    pressed = press(program, path(*((0.005 * i, x) for i, x in enumerate(places_mm))))
    return [pressed.keys[20 * i] for i in range(len(places_mm))]


@pytest.mark.parametrize("press_mm", [0.01, 0.05, 0.3])
@pytest.mark.parametrize("release_mm", [0.01, 0.2])
def test_rapid_trigger_fires_at_the_very_hundredth(press_mm: float, release_mm: float) -> None:
    program = make("rapid-trigger", press_mm=press_mm, release_mm=release_mm, top_dead_mm=0.3)
    # readings come in steps of 1/8 µm and are dithered by 0.3 µm; a thousandth of a millimetre is clear of it
    e = 0.001
    keys = keys_at(program, 0, 1.0, 2.0, 2.0 - release_mm + e, 2.0 - release_mm - e, 1.2)
    assert keys == [0, 1, 1, 1, 0, 0]
    keys = keys_at(program, 0, 1.5, 1.2, 1.2 + press_mm - e, 1.2 + press_mm + e)
    assert keys == [0, 1, 0, 0, 1]


def test_rapid_trigger_rests_in_its_dead_zones() -> None:
    program = make("rapid-trigger", press_mm=0.05, release_mm=0.05, top_dead_mm=0.4, bottom_dead_mm=0.5)
    bottom = 3.945 - 0.5
    places = (0.0, 0.2, 0.1, 0.39, 0.41, 3.9, bottom + 0.02, 3.9, bottom - 0.06, 0.1)
    assert keys_at(program, *places) == [0, 0, 0, 0, 1, 1, 1, 1, 0, 0]


def test_the_button_reports_its_models_key_points() -> None:
    pressed = press(make("button", "mx-blue"), path((0, 0), (0.2, 3.8), (0.4, 0.0)))
    assert [x for _, x in pressed.entries()[1:]] == pytest.approx([2.13, 1.675], abs=0.01)


def test_states_follow_each_other_the_same_at_every_pace() -> None:
    program = make("dwell-ticks", period_ms=5000)
    found = {
        tuple(state for state, _ in press(program, path((0, 0), (s, 3.9), (2 * s, 0))).entries())
        for s in (0.013, 0.05, 0.3)
    }
    assert found == {("up", "down", "dwelling", "down", "up")}


@pytest.mark.parametrize(
    ("name", "parameters", "place"),
    [
        ("fast-tapping", {"trigger_mm": 9}, "trigger_mm"),
        ("rapid-trigger", {"press_mm": 0.015}, "press_mm"),
        ("rapid-trigger", {"press": 0.1}, "press"),
        ("multi-level", {"levels": 2.5}, "levels"),
        ("nothing", {}, "nothing"),
    ],
)
def test_a_parameter_that_cannot_be_is_named(name: str, parameters: dict[str, float], place: str) -> None:
    with pytest.raises(InputError, match=place):
        make(name, None, **parameters)


@pytest.mark.parametrize("recipe", programs(), ids=lambda recipe: recipe.name)
def test_a_parameter_may_be_what_its_range_says_and_no_more(recipe: Recipe) -> None:
    base = load_builtin("mx-red")
    allowed = ranges(recipe.name, base)
    assert list(allowed) == [parameter.name for parameter in recipe.parameters]
    for parameter in recipe.parameters:
        low, high = allowed[parameter.name]
        assert low <= parameter.default <= high
        step = 1 if isinstance(parameter.default, int) else 0.01
        make(recipe.name, base, **{parameter.name: low})
        with pytest.raises(InputError, match="must be"):
            make(recipe.name, base, **{parameter.name: low - step})
        with pytest.raises(InputError, match="must be"):
            make(recipe.name, base, **{parameter.name: high + step})


def test_more_levels_leave_less_room_for_a_detent() -> None:
    base = load_builtin("mx-red")
    assert ranges("multi-level", base, levels=3)["detent_mm"][1] == pytest.approx(base.travel_mm / 4)
