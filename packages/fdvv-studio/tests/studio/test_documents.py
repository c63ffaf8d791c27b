"""A person's own buttons over the studio's calls and its live connection."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import msgspec
import pytest
from starlette.testclient import TestClient

from fdvv.model.file import load_builtin, load_model
from fdvv_studio.project.patch import patch_between, record_of
from fdvv_studio.studio.studio import Studio
from tests.studio.conftest import LIVE

CLEAR = load_builtin("mx-clear")


def ask(client: TestClient, call: str, /, **question: Any) -> dict[str, Any]:
    answer = client.post(f"/api/document.{call}", json=question)
    assert answer.status_code == 200, answer.text
    found: dict[str, Any] = answer.json()
    return found


def refused(client: TestClient, call: str, /, **question: Any) -> str:
    answer = client.post(f"/api/document.{call}", json=question)
    assert answer.status_code == 422, answer.text
    line: str = answer.json()["error"]
    return line


def copied(client: TestClient, name: str | None = "mine") -> str:
    button: str = ask(client, "copy", button="builtin:mx-clear", name=name)["button"]
    return button


def travel(button: str, travel_mm: float, change_id: str) -> dict[str, Any]:
    """Make the edit that a page would send for another travel."""
    record = record_of(CLEAR.renamed(button.removeprefix("own:")))
    patch = msgspec.to_builtins(patch_between(record, {**record, "travel_mm": travel_mm}))
    words = {"type": "edit", "change_id": change_id, "label": f"set travel to {travel_mm:g} mm"}
    return {**words, "patch": patch, "joins": False, "time_s": 12.0}


def test_a_built_in_button_opens_to_be_seen_and_is_copied_to_be_edited(client: TestClient) -> None:
    found = ask(client, "open", button="builtin:mx-clear")
    assert (found["editable"], found["revision"], found["steps"]) == (False, 0, [])
    assert found["opening"] == record_of(CLEAR)
    change = travel("mx-clear", 3.5, "a")
    line = refused(client, "change", button="builtin:mx-clear", revision=0, change=change)
    assert line == "builtin:mx-clear: only your own buttons can be edited; copy it first"
    assert copied(client, None) == "own:mx-clear 2"
    assert copied(client, None) == "own:mx-clear 3"
    assert ask(client, "open", button="own:mx-clear 3")["editable"] is True


def test_an_edit_is_kept_undone_and_done_again(client: TestClient, own_studio: Studio) -> None:
    button = copied(client)
    change = travel(button, 3.5, "a")
    answer = ask(client, "change", button=button, revision=0, change=change)
    assert answer == {"revision": 1, "conflict": None}
    path = own_studio.project / "buttons" / "mine.fdvv.json"
    assert load_model(path).travel_mm == 3.5
    for number, kind in enumerate(("undo", "redo"), start=1):
        change = {"type": kind, "change_id": kind, "count": 1}
        ask(client, "change", button=button, revision=number, change=change)
    change = {"type": "pin", "change_id": "p", "label": "shorter"}
    ask(client, "change", button=button, revision=3, change=change)
    found = ask(client, "open", button=button)
    assert (found["revision"], found["done"], found["opening"]["travel_mm"]) == (4, 1, 4.0)
    assert [step["label"] for step in found["steps"]] == ["set travel to 3.5 mm"]
    assert [pin["model"]["travel_mm"] for pin in found["pins"]] == [3.5]


def test_a_change_on_an_old_revision_is_answered_with_the_newest_state(client: TestClient) -> None:
    button = copied(client)
    one, two = travel(button, 3.5, "one"), travel(button, 3.6, "two")
    ask(client, "change", button=button, revision=0, change=one)
    answer = ask(client, "change", button=button, revision=0, change=two)
    assert answer["conflict"] == ask(client, "open", button=button)
    assert answer["revision"] == 1
    again = ask(client, "change", button=button, revision=0, change=one)
    assert again == {"revision": 1, "conflict": None}


@pytest.mark.parametrize("place", [{"stroke": "x"}, {"velocity_mm_s": "x"}, {"degree": []}, {"spread": 5}])
def test_a_curve_that_is_none_is_one_line(client: TestClient, place: dict[str, Any]) -> None:
    button = copied(client)
    curve = {"stroke": "press", "velocity_mm_s": 7.0, "after": place}
    words = {"type": "edit", "change_id": "a", "label": "", "joins": False, "time_s": 0.0}
    change = {**words, "patch": {"curves": [curve]}}
    assert refused(client, "change", button=button, revision=0, change=change)


def test_a_button_is_made_from_a_template_or_from_what_a_page_has(client: TestClient) -> None:
    made = ask(client, "create", name=None, template="linear", model=None)
    assert made["button"] == "own:my button"
    assert ask(client, "open", button="own:my button")["opening"]["travel_mm"] == 4.0
    model = {**record_of(CLEAR), "travel_mm": 3.25}
    assert ask(client, "create", name="kept", template=None, model=model)["button"] == "own:kept"
    assert ask(client, "open", button="own:kept")["opening"]["travel_mm"] == 3.25
    assert "not an FDVV model" in refused(client, "create", name="x", template=None, model={})


def test_buttons_are_listed_renamed_and_deleted(client: TestClient, own_studio: Studio) -> None:
    copied(client, "a")
    copied(client, "b")
    assert {row["button"] for row in ask(client, "list")["rows"]} == {"own:a", "own:b"}
    assert ask(client, "rename", button="own:a", name="c")["button"] == "own:c"
    assert "there is a button 'b' already" in refused(client, "rename", button="own:c", name="B")
    ask(client, "delete", button="own:c")
    assert [row["name"] for row in ask(client, "list")["rows"]] == ["b"]
    assert len(list((own_studio.project / "trash").rglob("*.fdvv.json"))) == 1
    assert "no such button" in refused(client, "open", button="own:a")


def test_a_copy_of_an_own_button_is_its_newest_state(client: TestClient) -> None:
    button = copied(client)
    ask(client, "change", button=button, revision=0, change=travel(button, 3.5, "a"))
    other = ask(client, "copy", button=button, name="other")["button"]
    found = ask(client, "open", button=other)
    assert (found["opening"]["travel_mm"], found["steps"]) == (3.5, [])


def test_other_pages_hear_of_every_change(client: TestClient) -> None:
    button = copied(client)
    with client.websocket_connect(LIVE) as live:
        live.send_json({"channel": "documents", "body": {"type": "watch"}})
        assert live.receive_json()["body"] == {"type": "watching"}
        change = travel(button, 3.5, "a")
        ask(client, "change", button=button, revision=0, change=change)
        ask(client, "change", button=button, revision=0, change={**change, "change_id": "stale"})
        ask(client, "rename", button=button, name="other")
        ask(client, "delete", button="own:other")
        copied(client, "new")
        heard = [live.receive_json()["body"] for _ in range(4)]
    assert heard == [
        {"type": "changed", "button": button, "revision": 1},
        {"type": "gone", "button": button, "renamed_to": "own:other"},
        {"type": "gone", "button": "own:other", "renamed_to": None},
        {"type": "changed", "button": "own:new", "revision": 0},
    ]


def test_a_project_folder_is_made_only_when_something_is_kept(client: TestClient, tmp_path: Path) -> None:
    assert ask(client, "list") == {"rows": []}
    ask(client, "open", button="builtin:mx-red")
    assert not (tmp_path / "project").exists()
