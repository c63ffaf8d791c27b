"""The history of a button: a session of the page, replayed."""

from __future__ import annotations

import json
from pathlib import Path

import msgspec
import pytest

from fdvv.errors import InputError
from fdvv.workflow import DraftChange, DraftHistory, RedoMade, UndoMade, UnpinMade, model_of

SESSION = Path(__file__).resolve().parents[2] / "web" / "tests" / "golden" / "session.json"


def test_a_session_of_the_page_leads_to_the_same_history() -> None:
    session = json.loads(SESSION.read_text())
    history = DraftHistory(session["opening"], session["opening"])
    kinds = set()
    for change in session["changes"]:
        kinds.add(change["type"])
        history = history.after(msgspec.convert(change, DraftChange))
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
    history = DraftHistory({"name": "a"}, {"name": "a"})
    for change in (UndoMade("u", 1), RedoMade("r", 1), UnpinMade("p", 0)):
        with pytest.raises(InputError, match="open the button again"):
            history.after(change)
