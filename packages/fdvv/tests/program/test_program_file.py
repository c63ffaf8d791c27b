"""Program files: exact, canonical, and refused in one line that names the place."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tools import make_programs, make_schema

from fdvv.errors import InputError, ModelError
from fdvv.program.condition import Condition, Transition, When
from fdvv.program.file import load_program, program_from_json, program_to_json, save_program, schema
from fdvv.program.library import load_shipped, programs
from fdvv.program.program import Program, State
from fdvv.program.surface import Surface, flat
from tests.support.program import program_strategies

TEXT = program_to_json(load_shipped("rapid-trigger"))


@settings(max_examples=60, deadline=None)
@given(program_strategies.programs())
def test_a_program_comes_back_from_its_text_exactly(program: Program) -> None:
    text = program_to_json(program)
    again = program_from_json(text)
    assert again == program
    assert program_to_json(again) == text


def test_a_saved_program_is_loaded_as_it_was(tmp_path: Path) -> None:
    program = load_shipped("multi-level")
    save_program(program, tmp_path / "new" / "m.fdvv-program.json")
    assert load_program(tmp_path / "new" / "m.fdvv-program.json") == program


def test_the_shipped_files_are_those_of_the_code() -> None:
    made = make_programs.files()
    assert {path.name for path in made} == {path.name for path in make_programs.FOLDER.iterdir()}
    for path, text in made.items():
        assert path.read_text() == text, "run python tools/make_programs.py"


def test_the_published_schema_is_that_of_the_code_and_holds_for_what_is_shipped() -> None:
    published = make_schema.PROGRAM_OUTPUT.read_text()
    assert published == make_schema.text(schema()), "run python tools/make_schema.py"
    validator = jsonschema.Draft202012Validator(json.loads(published))
    for recipe in programs():
        validator.validate(json.loads(program_to_json(load_shipped(recipe.name))))
    broken = edited(lambda p: p["states"][0]["transitions"][0].update(when={"deeper": 1}))
    assert not validator.is_valid(json.loads(broken))


def edited(change: Callable[[dict[str, Any]], object]) -> str:
    record = json.loads(TEXT)
    change(record)
    return json.dumps(record)


def when(**condition: float) -> Callable[[dict[str, Any]], object]:
    return lambda p: p["states"][1]["transitions"][0].update(when=condition)


@pytest.mark.parametrize(
    ("change", "place", "reason"),
    [
        (lambda p: p.update(format="fdvv-model"), "$.format", "not a program"),
        (lambda p: p.update(version=9), "$.version", "file version 9"),
        (lambda p: p.pop("start"), "$", "start"),
        (lambda p: p.update(colour="red"), "$", "colour"),
        (lambda p: p.update(start="nowhere"), "$", "'nowhere'"),
        (lambda p: p["states"][1].update(key=900), "$.states[1].key", "255"),
        (lambda p: p["states"][0].update(velocity="guessed"), "$.states[0].velocity", "continuous"),
        (lambda p: p["states"][0].update(press="thin air"), "$", "thin air"),
        (when(always=3), "$.states[1].transitions[0]", "always takes true"),
        (when(after_ms=0.5), "$.states[1].transitions[0]", "whole number"),
        (when(deeper_mm=1), "$.states[1].transitions[0].when", "deeper_than_mm"),
        (lambda p: p["surfaces"][0]["displacement_mm"].reverse(), "$.surfaces[0]", "rising"),
        (lambda p: p["surfaces"][0].pop("velocity_mm_s"), "$.surfaces[0]", "missing required field"),
        (lambda p: p["surfaces"][1]["force_cN"][0].pop(), "$.surfaces[1]", "one force per displacement"),
    ],
)
def test_a_wrong_file_is_refused_by_its_place(
    change: Callable[[dict[str, Any]], object], place: str, reason: str
) -> None:
    with pytest.raises(InputError) as caught:
        program_from_json(edited(change), "p.fdvv-program.json")
    assert place in str(caught.value)
    assert reason in str(caught.value)
    assert "\n" not in str(caught.value)


def test_text_that_is_no_json_is_refused_by_line_and_column() -> None:
    with pytest.raises(InputError, match=r"line 3, column \d+: not valid JSON"):
        program_from_json('{\n "format": "fdvv-program",\n oops}', "p")


def test_names_must_be_known_and_differ() -> None:
    up = State("up", "push", "push")
    push = flat("push", 40.0)
    for states, surfaces, start, reason in (
        ((up, up), (push,), "up", "two states"),
        ((up,), (push, push), "up", "two surfaces"),
        ((up,), (push,), "down", "no state"),
        ((State("up", "push", "pull"),), (push,), "up", "no surface"),
    ):
        with pytest.raises(ModelError, match=reason):
            Program("p", 4.0, start, states, surfaces)


def test_conditions_read_like_sentences() -> None:
    transitions = [
        Transition("b", Condition(When.FALLEN_BY, 0.1), Condition(When.DEEPER_THAN, 0.3)),
        Transition("b", Condition(When.FASTER_THAN, 80)),
        Transition("b", Condition(When.HOST_EVENT, 3)),
        Transition("b", Condition(When.TURNED_TO_RELEASE)),
    ]
    assert [str(t) for t in transitions] == [
        "fallen by 0.1 mm if deeper than 0.3 mm → b",
        "faster than 80 mm/s → b",
        "host event 3 → b",
        "turned to release → b",
    ]


@given(
    st.lists(st.integers(0, 400), min_size=1, max_size=6, unique=True).map(sorted),
    st.integers(0, 2**32 - 1),
    st.floats(-5.0, 500.0),
)
def test_a_surface_is_bilinear_along_a_stroke(velocities: list[int], seed: int, velocity_mm_s: float) -> None:
    rng = np.random.default_rng(seed)
    places = np.cumsum(rng.uniform(0.01, 1.0, 5))
    table = rng.uniform(-50.0, 150.0, (len(velocities), places.size))
    surface = Surface("any", tuple(places), tuple(map(tuple, table)), tuple(map(float, velocities)))
    along = np.append(rng.uniform(-1.0, 6.0, 20), places)
    columns = [np.interp(along, places, row) for row in table]
    wanted = [np.interp(velocity_mm_s, velocities, column) for column in np.transpose(columns)]
    np.testing.assert_allclose(surface.force_along_cN(along, velocity_mm_s), wanted, atol=1e-10)
