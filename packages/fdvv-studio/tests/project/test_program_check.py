"""Faults of a program are reported with the place in its document."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from fdvv.program.check import Severity
from fdvv.program.compile import compile_program
from fdvv.program.condition import Condition, Transition
from fdvv.program.file import program_to_json
from fdvv.program.library import load_shipped, programs
from fdvv.program.program import Program, State
from fdvv.program.surface import flat, line
from fdvv_studio.project.program_check import PlacedFinding, check_program_text

PUSH = flat("push", 40.0)


def plain(**changes: Any) -> Program:
    up = State("up", "push", "push", (Transition("down", Condition("deeper_than_mm", 2.0)),))  # type: ignore[arg-type]
    down = State("down", "push", "push", (Transition("up", Condition("shallower_than_mm", 1.8)),), key=1)  # type: ignore[arg-type]
    return replace(Program("plain", 4.0, "up", (up, down), (PUSH,)), **changes)


def findings(program: Program) -> tuple[PlacedFinding, ...]:
    return check_program_text(program_to_json(program)).findings


def broken(change: Callable[[dict[str, Any]], object]) -> PlacedFinding:
    document = json.loads(program_to_json(plain()))
    change(document)
    (finding,) = check_program_text(json.dumps(document)).findings
    assert finding.severity is Severity.REFUSED
    assert finding.remedy
    return finding


@pytest.mark.parametrize("recipe", programs(), ids=lambda r: r.name)
def test_a_shipped_program_stands_well_and_its_sizes_are_those_of_its_image(recipe: Any) -> None:
    program = load_shipped(recipe.name)
    standing = check_program_text(program_to_json(program))
    assert standing.accepted
    assert standing.findings == ()
    compiled = compile_program(program)
    sizes = {size.what: size for size in standing.sizes}
    assert sizes["bytes"].taken == len(compiled.image)
    assert sizes["states"].taken == len(program.states)
    assert all(size.taken is not None and size.taken <= size.most for size in standing.sizes)
    assert {s.name: s.columns for s in standing.surfaces} == compiled.columns


def test_a_state_that_holds_the_cap_down_is_reported_with_its_place() -> None:
    up, down = plain().states
    held = replace(down, press="hold", release="hold")
    (finding,) = findings(plain(states=(up, held), surfaces=(PUSH, flat("hold", -20.0))))
    assert (finding.path, finding.state, finding.at_mm) == ("states[1]", "down", 0.1)
    assert "after_ms" in finding.remedy


def test_a_transition_beyond_the_travel_is_reported_at_the_transition() -> None:
    up, down = plain().states
    far = Transition("down", Condition("deeper_than_mm", 5.0))  # type: ignore[arg-type]
    found = findings(plain(states=(replace(up, transitions=(*up.transitions, far)), down)))
    assert [(f.path, f.severity) for f in found] == [("states[0].transitions[1]", Severity.WARNING)]


def test_a_steep_surface_is_reported_at_the_surface_and_the_displacement() -> None:
    steep = line("push", (0, 40), (2.0, 40), (2.1, 90), (4.0, 90))
    found = [f for f in findings(plain(surfaces=(steep,))) if "buzz" in f.reason]
    assert [(f.path, f.at_mm) for f in found] == [("surfaces[0]", 2.0)] * 2
    assert {f.state for f in found} == {"up", "down"}


def test_a_surface_too_strong_for_the_rig_is_reported_at_the_surface() -> None:
    assert "surfaces[0]" in {f.path for f in findings(plain(surfaces=(flat("push", 500.0),)))}


def test_a_travel_beyond_the_stop_is_reported_at_the_travel() -> None:
    assert "travel_mm" in {f.path for f in findings(plain(travel_mm=6.3))}


BROKEN: dict[str, Callable[[dict[str, Any]], object]] = {
    "states[1].transitions[0]": lambda d: d["states"][1]["transitions"].__setitem__(0, {"to": "nowhere"}),
    "states[0].press": lambda d: d["states"][0].update(press=3),
    "states[0]": lambda d: d["states"][0].update(press="nothing"),
    "states[1]": lambda d: d["states"].__setitem__(0, {**d["states"][0], "name": "down"}),
    "surfaces[0]": lambda d: d["surfaces"][0].update(displacement_mm=[1.0, 0.0]),
    "start": lambda d: d.update(start="nowhere"),
    "travel_mm": lambda d: d.update(travel_mm=9.0),
    "vibrations[0]": lambda d: d.update(vibrations=[{"signal": "nothing", "at_mm": 1.0}]),
}


@pytest.mark.parametrize("path", BROKEN)
def test_an_invalid_program_document_is_refused_with_the_path_of_the_fault(path: str) -> None:
    assert broken(BROKEN[path]).path == path


def test_a_missing_target_state_is_reported_at_its_transition() -> None:
    found = broken(lambda d: d["states"][0]["transitions"][0].update(to="nowhere"))
    assert found.path == "states[0].transitions[0]"
    assert "'nowhere'" in found.reason


@pytest.mark.parametrize(
    "text",
    ["", "null", "[]", "{", "\ud800", "[" * 100_000, '{"format": "fdvv-program", "version": 1, "states": 3}'],
    ids=["empty", "null", "list", "half", "surrogate", "deep", "wrong"],
)
def test_a_text_that_is_no_program_is_one_finding(text: str) -> None:
    standing = check_program_text(text)
    assert len(standing.findings) == 1
    assert not standing.accepted
    assert standing.sizes == ()


def test_a_program_beyond_every_device_is_refused_without_the_proof() -> None:
    states = tuple(State(f"s{i}", "push", "push") for i in range(5000))
    standing = check_program_text(program_to_json(plain(states=states, start="s0")))
    assert (standing.return_s, standing.stiffness_cN_mm) == (None, None)
    assert [f.place for f in standing.findings] == ["states"]
    assert {s.what: s.taken for s in standing.sizes}["states"] == 5000
