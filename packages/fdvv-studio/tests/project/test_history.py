"""The history of a button: a session of the page, replayed."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import msgspec
import pytest

from fdvv.errors import InputError, ModelError
from fdvv.model.file import builtin_names, load_builtin
from fdvv_studio.project.history import EditHistory, HistoryChange, RedoMade, UndoMade, UnpinMade
from fdvv_studio.project.patch import Patch, apply_patch, inverse_patch, model_of, patch_between, record_of

SESSION = Path(__file__).resolve().parents[4] / "web" / "tests" / "golden" / "session.json"


def test_a_session_of_the_page_leads_to_the_same_history() -> None:
    session = json.loads(SESSION.read_text())
    history = EditHistory(session["opening"], session["opening"])
    kinds = set()
    for change in session["changes"]:
        kinds.add(change["type"])
        history = history.after(msgspec.convert(change, HistoryChange))
        model_of(history.record, "session")
    left = session["left"]
    assert kinds >= {"edit", "undo", "redo", "pin"}
    assert any(change.get("joins") for change in session["changes"])
    assert json.loads(msgspec.json.encode(history.steps)) == left["steps"]
    assert (history.opening, history.done) == (left["opening"], left["done"])
    assert json.loads(msgspec.json.encode(history.pins)) == left["pins"]
    back = history.after(UndoMade("u", history.done))
    assert back.record == history.opening
    assert back.after(RedoMade("r", history.done)).record == history.record


def test_steps_and_pins_that_are_not_there_are_refused() -> None:
    history = EditHistory({"name": "a"}, {"name": "a"})
    for change in (UndoMade("u", 1), RedoMade("r", 1), UnpinMade("p", 0)):
        with pytest.raises(InputError, match="open the button again"):
            history.after(change)


GOLDEN = Path(__file__).resolve().parents[4] / "web" / "tests" / "golden"


def cases(name: str) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = json.loads((GOLDEN / f"{name}.json").read_text())
    return found


UNKNOWN = next(model for model in cases("models") if model["name"] == "unknown")


@pytest.mark.parametrize("case", cases("patches"))
def test_a_patch_leads_there_and_back_and_refuses_another_model(case: dict[str, Any]) -> None:
    patch = msgspec.convert(case["patch"], Patch)
    assert patch_between(case["before"], case["after"]) == patch
    assert apply_patch(case["before"], patch) == case["after"]
    assert apply_patch(case["after"], inverse_patch(patch)) == case["before"]
    assert inverse_patch(inverse_patch(patch)) == patch
    if case["fits_unknown"]:
        apply_patch(UNKNOWN, patch)
    else:
        with pytest.raises(ModelError, match="the edit does not fit the model: its "):
            apply_patch(UNKNOWN, patch)


@pytest.mark.parametrize("name", builtin_names())
def test_between_any_two_models_a_patch_leads_exactly(name: str) -> None:
    a, b = record_of(load_builtin("mx-clear")), record_of(load_builtin(name))
    patch = msgspec.json.decode(msgspec.json.encode(patch_between(a, b)), type=Patch)
    assert model_of(apply_patch(a, patch), "b") == load_builtin(name)
    assert model_of(apply_patch(b, inverse_patch(patch)), "a") == load_builtin("mx-clear")


@pytest.mark.parametrize("record", cases("edited"))
def test_a_model_that_the_page_makes_is_a_model_here(record: dict[str, Any]) -> None:
    assert record_of(model_of(record, "edited")) == record


def test_an_empty_patch_is_nothing() -> None:
    record = record_of(load_builtin("mx-red"))
    assert patch_between(record, record) == Patch()
    assert msgspec.json.encode(Patch()) == b"{}"


@pytest.mark.parametrize(
    "patch",
    [
        {"curves": [{"stroke": "press", "velocity_mm_s": None, "points": [[99, 0.0, 1.0]]}]},
        {"curves": [{"stroke": "press", "velocity_mm_s": 7.0, "points": [[0, 0.0, 1.0]]}]},
        {"curves": [{"stroke": "press", "velocity_mm_s": 7.0, "before": {"degree": 3}}]},
        {"vibrations": [{"stroke": "press", "velocity_mm_s": 7.0, "before": {"onset_mm": 1}}]},
        {"fields": {"name": ["another", "new"]}},
    ],
)
def test_a_patch_of_what_is_not_there_is_refused(patch: dict[str, Any]) -> None:
    with pytest.raises(ModelError, match="the edit does not fit the model"):
        apply_patch(UNKNOWN, msgspec.convert(patch, Patch))


@pytest.mark.parametrize(
    "patch",
    [
        {"fields": {"__class__": [1, 2]}},
        {"curves": [{"stroke": "press", "velocity_mm_s": None, "points": [[-1, 0.0, 1.0]]}]},
        {"more": 1},
    ],
)
def test_what_is_no_patch_is_refused_by_its_shape(patch: dict[str, Any]) -> None:
    with pytest.raises(msgspec.ValidationError):
        msgspec.convert(patch, Patch)
