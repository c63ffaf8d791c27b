"""Images: the same bytes every time, what they cost, and what a device refuses is refused before."""

from __future__ import annotations

import hashlib
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.errors import InputError
from fdvv.model.file import builtin_names, load_builtin
from fdvv.model.surface import ForceSurface
from fdvv.program.button import button_program, compile_button
from fdvv.program.compile import compile_program
from fdvv.program.condition import Condition, Transition, When
from fdvv.program.describe import describe
from fdvv.program.library import load_shipped, programs
from fdvv.program.program import During, Program, State
from fdvv.program.surface import Limits, Surface, flat
from fdvv.protocol.tables import Refusal
from tests.safety._checking import check_image
from tests.support.program import program_strategies

NAMES = [p.name for p in programs()]


@settings(max_examples=30, deadline=None)
@given(program_strategies.programs())
def test_an_image_holds_what_the_program_says(program: Program) -> None:
    compiled = compile_program(program, Limits(worst_grid_error_cN=400.0, weight_cN=0.0))
    held = describe(compiled.image)
    assert held.travel_mm == program.travel_mm
    assert held.start == program.start
    assert held.states == program.states
    for one, other in zip(held.vibrations, program.vibrations, strict=True):
        states = other.states or tuple(s.name for s in program.states)
        assert replace(one, states=()) == replace(other, states=())
        assert set(one.states) == set(states)


@settings(max_examples=30, deadline=None)
@given(program_strategies.surfaces("s"), st.floats(0, 6), st.floats(0, 600))
def test_forces_are_within_the_reported_error(surface: Surface, x_mm: float, v_mm_s: float) -> None:
    program = Program("p", 6.2, "a", (State("a", "s", "s"),), (surface,))
    compiled = compile_program(program, Limits(worst_grid_error_cN=400.0))
    held = describe(compiled.image).surfaces[0]
    reported_cN = compiled.grid_error_cN["s"] + compiled.rounding_cN
    assert compiled.rounding_cN <= 1 / 128
    assert abs(held.force_at_cN(x_mm, v_mm_s) - surface.force_at_cN(x_mm, v_mm_s)) <= reported_cN + 1e-9


@pytest.mark.parametrize("name", NAMES)
def test_the_firmware_accepts_every_shipped_image(name: str) -> None:
    assert check_image(compile_program(load_shipped(name)).image).verdict is Refusal.NONE


@pytest.mark.parametrize("name", builtin_names())
def test_every_built_in_button_fits_within_a_tenth_of_a_centinewton(name: str) -> None:
    compiled = compile_button(load_builtin(name))
    assert check_image(compiled.image).verdict is Refusal.NONE
    assert max(compiled.grid_error_cN.values()) <= 0.1


def test_every_state_carries_the_weight_but_for_learned_forces() -> None:
    model = load_builtin("mx-red")
    surface = ForceSurface.of_model(model, [100.0])
    found = [
        describe(compiled.image).states[1].bias_cN
        for compiled in (
            compile_button(model),
            compile_button(model, limits=Limits(weight_cN=0.0)),
            compile_button(model, surface),
        )
    ]
    assert found == pytest.approx([19.6, 0, 0], abs=1 / 128)


def test_the_image_of_a_shipped_program_has_not_changed() -> None:
    compiled = compile_program(load_shipped("dwell-ticks"))
    assert hashlib.sha256(compiled.image).hexdigest()[:16] == GOLDEN
    assert compile_program(load_shipped("dwell-ticks")) == compiled


def wavy(name: str, count: int, waves: float, rows: int = 1) -> Surface:
    x = np.linspace(0, 4, count)
    table = [tuple((40 + 10 * np.sin(2 * np.pi * waves * x / 4 + r)).tolist()) for r in range(rows)]
    return Surface(name, tuple(x.tolist()), tuple(table), tuple(10.0 * r for r in range(rows)))


def one_state(*surfaces: Surface) -> Program:
    states = tuple(
        State(f"s{i}", s.name, s.name, (Transition(f"s{(i + 1) % len(surfaces)}", Condition(When.AFTER, 9)),))
        for i, s in enumerate(surfaces)
    )
    return Program("p", 4.0, "s0", states, surfaces)


def test_a_straight_surface_takes_few_columns_and_a_wavy_one_many() -> None:
    compiled = compile_program(one_state(flat("flat", 40.0), wavy("wavy", 400, 3)))
    assert compiled.columns["flat"] == 2
    assert 40 < compiled.columns["wavy"] < 200


def test_where_room_is_short_all_grids_become_coarser_within_the_bound() -> None:
    few, many = (one_state(*(wavy(f"w{i}", 400, 5 + i / 100, 8) for i in range(n))) for n in (1, 12))
    loose = Limits(worst_grid_error_cN=2.0)
    roomy, tight = compile_program(few, loose), compile_program(many, loose)
    assert roomy.grid_error_cN["w0"] <= 0.1 < tight.grid_error_cN["w0"] <= 2.0
    assert len(tight.image) <= 7168
    with pytest.raises(InputError, match=r"whole program: \d+ bytes"):
        compile_program(many, Limits(worst_grid_error_cN=0.2))


def test_equal_tables_are_stored_once() -> None:
    same = compile_program(one_state(wavy("a", 100, 2), replace(wavy("a", 100, 2), name="b")))
    other = compile_program(one_state(wavy("a", 100, 2), wavy("b", 100, 2.1)))
    assert len(same.image) < len(other.image) - 90


@pytest.mark.parametrize(
    ("program", "place"),
    [
        (one_state(flat("strong", 500.0)), "'strong'"),
        (one_state(flat("far", 50.0), Surface("wide", (0.0, 20.1), ((1.0, 1.0),))), "'wide'"),
        (one_state(Surface("close", (0.0, 1.0), ((1.0, 1.0), (2.0, 2.0)), (10.0, 10.01))), "'close'"),
        (one_state(*(flat(f"f{i}", float(i)) for i in range(17))), "states"),
        (one_state(Surface("step", (0.0, 1.001, 1.003, 4.0), ((0.0, 0.0, 90.0, 90.0),))), "'step'"),
    ],
)
def test_what_no_device_takes_is_refused_by_its_place(program: Program, place: str) -> None:
    with pytest.raises(InputError) as caught:
        compile_program(program)
    assert place in str(caught.value)


@pytest.mark.parametrize("at", [0, 5, 20, 40, -1])
def test_a_damaged_image_is_refused(at: int) -> None:
    image = bytearray(compile_program(load_shipped("button")).image)
    image[at] ^= 1
    with pytest.raises(InputError, match=r"not the image|does not fit"):
        describe(bytes(image))


def test_a_button_with_a_learned_surface_commands_what_was_learned() -> None:
    model = load_builtin("mx-red")
    x = np.arange(0, 4.0, 0.05)
    learned = ForceSurface(x, np.array([50.0, 100.0]), np.full((2, x.size), 33.0), np.full((2, x.size), -7.0))
    held = describe(compile_button(model, learned).image)
    assert [s.force_at_cN(2.0, 75.0) for s in held.surfaces] == [33.0, -7.0]
    assert [s.velocity_mm_s for s in held.surfaces] == [(50.0, 100.0)] * 2


def test_a_models_vibrations_are_played_at_the_velocities_nearest_to_theirs() -> None:
    model = load_builtin("mx-clear")
    (press, _) = model.vibrations
    slow, fast = (replace(press, velocity_mm_s=v, duration_s=d) for v, d in ((50.0, 0.01), (150.0, 0.02)))
    program = button_program(replace(model, vibrations=(slow, fast)))
    bounds = [(e.stroke, e.slowest_mm_s, e.fastest_mm_s) for e in program.vibrations]
    assert bounds == [(During.PRESS, None, 100.0), (During.PRESS, 100.0, None)]
    both = button_program(model)
    assert [s.name for s in both.signals] == ["snap 1"]
    assert [e.stroke for e in both.vibrations] == [During.PRESS, During.RELEASE]


GOLDEN = "a34cb80a3aa7c71b"
