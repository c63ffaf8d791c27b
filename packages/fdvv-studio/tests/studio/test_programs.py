"""What the page asks about programs, and the errors it gets for invalid requests."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from starlette.testclient import TestClient

from fdvv.program.file import program_from_json, program_to_json
from fdvv.program.library import load_shipped, programs
from fdvv_studio.studio.studio import Studio

BUTTON = program_to_json(load_shipped("button"))
CALLS = ("list", "open", "save", "keep", "copy", "delete", "restore", "check", "recipe", "ranges", "surface")


def ask(client: TestClient, name: str, status: int = 200, /, **fields: Any) -> Any:
    answer = client.post(f"/api/program.{name}", json=fields)
    assert answer.status_code == status, answer.text
    found = answer.json()
    if status != 200:
        assert list(found) == ["error"]
        assert found["error"]
        assert "\n" not in found["error"]
        assert "/tmp" not in found["error"]
    return found


def test_a_new_project_offers_shipped_programs_and_recipes_with_their_ranges(client: TestClient) -> None:
    rows = ask(client, "list")
    assert [row["id"] for row in rows["programs"]] == [f"shipped:{r.name}" for r in programs()]
    for recipe in rows["recipes"]:
        for parameter in recipe["parameters"]:
            assert parameter["low"] <= parameter["default"] <= parameter["high"]
    assert "builtin:mx-clear" in rows["bases"]


def test_a_program_is_copied_changed_saved_and_found_again(client: TestClient, own_studio: Studio) -> None:
    copied = ask(client, "copy", program="shipped:button", name="mine")
    assert copied["program"] == "own:mine"
    document = json.loads(copied["text"]) | {"travel_mm": 2.5}
    saved = ask(client, "save", program="own:mine", text=json.dumps(document), revision=copied["revision"])
    assert ask(client, "open", program="own:mine") == saved
    kept = own_studio.project / "programs" / "mine.fdvv-program.json"
    assert kept.read_text() == saved["text"]
    assert program_from_json(saved["text"]).travel_mm == 2.5
    refusal = ask(client, "save", 422, program="own:mine", text=copied["text"], revision=copied["revision"])
    assert "changed elsewhere" in refusal["error"]


def test_a_deleted_program_comes_back(client: TestClient) -> None:
    kept = ask(client, "keep", text=BUTTON)
    thrown = ask(client, "delete", program=kept["program"], revision=kept["revision"])
    ask(client, "open", 422, program=kept["program"])
    assert ask(client, "restore", **thrown) == kept


@pytest.mark.parametrize("recipe", programs(), ids=lambda r: r.name)
def test_a_recipe_makes_a_program_that_is_accepted(client: TestClient, recipe: Any) -> None:
    made = ask(client, "recipe", recipe=recipe.name, base="builtin:mx-black", parameters={})
    check = ask(client, "check", text=made["text"])
    assert check["accepted"]
    assert check["return_s"] > 0
    assert {size["what"] for size in check["sizes"]} >= {"bytes", "states", "transitions"}
    ranges = ask(client, "ranges", recipe=recipe.name, base="builtin:mx-black")
    assert [p["name"] for p in ranges["parameters"]] == [p.name for p in recipe.parameters]


def test_a_buttons_forces_can_be_put_into_a_program(client: TestClient) -> None:
    surface = ask(client, "surface", button="builtin:mx-clear", stroke="press")
    document = json.loads(BUTTON)
    document["surfaces"][0].update(surface)
    assert program_from_json(json.dumps(document)).surfaces[0].force_cN[0][3] == surface["force_cN"][0][3]


def test_a_planted_fault_is_reported_with_its_place_and_remedy(client: TestClient) -> None:
    document = json.loads(BUTTON)
    document["states"][1]["transitions"] = []
    check = ask(client, "check", text=json.dumps(document))
    assert not check["accepted"]
    assert [(f["path"], f["state"]) for f in check["findings"]] == [("states[1]", "down")]
    assert check["findings"][0]["remedy"]


def hostile_texts() -> dict[str, str]:
    """Return texts that no page sends, by what a careless reader would do on them."""
    base = json.loads(BUTTON)
    state, surface = base["states"][0], base["surfaces"][0]

    def with_(**fields: Any) -> str:
        return json.dumps({**base, **fields})

    many = [{**state, "name": f"s{i}", "transitions": []} for i in range(9000)]
    wide = {**surface, "displacement_mm": list(range(90_000)), "force_cN": [[0] * 90_000]}
    ways = [{"to": state["name"], "when": {"always": True}}] * 9000
    return {
        "empty": "",
        "null": "null",
        "deep lists": "[" * 200_000,
        "deep objects": '{"states":' * 100_000,
        "deep in a program": BUTTON.replace('"states": [', '"states": [' + "[" * 50_000),
        "nan": BUTTON.replace('"travel_mm": ', '"travel_mm": NaN'),
        "infinity": BUTTON.replace('"travel_mm": ', '"travel_mm": 1e999, "was": '),
        "huge integer": BUTTON.replace('"version": 1', '"version": ' + "9" * 5000),
        "nul in a name": with_(name="a\0b"),
        "line break in a name": with_(name="a\nb"),
        "long name": with_(name="x" * 100_000),
        "surrogate": '{"name": "\\ud800"}',
        "two states of a name": with_(states=[state, state]),
        "two surfaces of a name": with_(surfaces=[surface, surface]),
        "many states": with_(states=many, start="s0"),
        "many transitions": with_(states=[{**state, "transitions": ways}, base["states"][1]]),
        "many surfaces": with_(surfaces=[{**surface, "name": f"p{i}", "displacement_mm": [0, 1],
                                          "force_cN": [[1, 1]]} for i in range(9000)]),
        "wide surface": with_(surfaces=[wide, base["surfaces"][1]]),
        "surface of nothing": with_(surfaces=[{**surface, "displacement_mm": [], "force_cN": []}]),
        "ragged surface": with_(surfaces=[{**surface, "force_cN": [[1.0]]}]),
        "forces of another kind": with_(surfaces=[{**surface, "force_cN": "all"}]),
        "unknown field": with_(extra=1),
        "other version": with_(version=2),
        "other format": with_(format="fdvv"),
        "condition of two fields": with_(
            states=[{**state, "transitions": [{"to": "up", "when": {"always": True, "after_ms": 1}}]}]
        ),
        "condition of nothing": with_(states=[{**state, "transitions": [{"to": "up", "when": {}}]}]),
        "way to nowhere": with_(states=[{**state, "transitions": [{"to": "x", "when": {"always": True}}]}]),
        "more than may be kept": BUTTON + " " * 2_000_000,
    }  # fmt: skip


HOSTILE = hostile_texts()


@pytest.mark.parametrize("what", HOSTILE)
def test_a_hostile_text_is_refused_in_a_line_and_nothing_is_kept(
    client: TestClient, own_studio: Studio, what: str
) -> None:
    text = HOSTILE[what]
    check = ask(client, "check", text=text)
    assert not check["accepted"]
    assert 1 <= len(check["findings"]) <= 8
    assert all("\n" not in f["reason"] and len(f["reason"]) < 800 for f in check["findings"])
    keepable = {"many states", "many transitions", "many surfaces", "wide surface"}
    for name, fields in (("keep", {}), ("save", {"program": "own:hostile"})):
        if what not in keepable:
            ask(client, name, 422, text=text, **fields)
    assert not (own_studio.project / "programs").exists()


NO_TEXT: tuple[object, ...] = (None, 3, [], {}, "x" * 81)
NONSENSE: tuple[tuple[str, int, dict[str, Any]], ...] = (
    *(("open", 422, {"program": name}) for name in ("", "own:", "own:../../x", "shipped:", "x:y", "own:\0")),
    *(("open", 400, {"program": kind}) for kind in NO_TEXT),
    *(("save", 422, {"program": f"own:{name}", "text": BUTTON}) for name in ("..", "a/b", "", "a\0", ".x")),
    ("save", 422, {"program": "shipped:button", "text": BUTTON}),
    ("save", 422, {"program": "own:x", "text": BUTTON, "revision": "0" * 16}),
    ("copy", 422, {"program": "shipped:button", "name": "../x"}),
    ("copy", 422, {"program": "shipped:nothing"}),
    ("delete", 422, {"program": "own:x", "revision": ""}),
    ("delete", 422, {"program": "shipped:button", "revision": ""}),
    *(("restore", 422, {"thrown": name}) for name in ("", "..", "../button", "x~1")),
    ("recipe", 422, {"recipe": "nothing", "base": "builtin:mx-red", "parameters": {}}),
    ("recipe", 422, {"recipe": "button", "base": "nothing", "parameters": {}}),
    ("recipe", 422, {"recipe": "multi-level", "base": "builtin:mx-red", "parameters": {"levels": 1e300}}),
    ("recipe", 422, {"recipe": "multi-level", "base": "builtin:mx-red", "parameters": {"levels": 0}}),
    ("recipe", 422, {"recipe": "multi-level", "base": "builtin:mx-red", "parameters": {"levels": 2.5}}),
    *(
        ("recipe", 422, {"recipe": "button", "base": "builtin:mx-red", "parameters": {name: 1}})
        for name in ("base", "name", "self", "parameters", "__class__")
    ),
    ("recipe", 400, {"recipe": "button", "base": "builtin:mx-red", "parameters": {"a": "b"}}),
    ("ranges", 422, {"recipe": "nothing", "base": "builtin:mx-red"}),
    ("ranges", 400, {"recipe": "multi-level", "base": "builtin:mx-red", "levels": 10**9}),
    ("surface", 422, {"button": "own:../x", "stroke": "press"}),
    ("surface", 400, {"button": "builtin:mx-red", "stroke": "sideways"}),
    *((name, 400, {"unknown": 1}) for name in CALLS),
)


@pytest.mark.parametrize("number", range(len(NONSENSE)))
def test_nonsense_is_answered_in_a_line_and_leaves_nothing(
    client: TestClient, own_studio: Studio, number: int
) -> None:
    name, status, fields = NONSENSE[number]
    ask(client, name, status, **fields)
    assert not (own_studio.project / "programs").exists()


def test_a_number_beyond_all_bounds_is_no_number(client: TestClient) -> None:
    body = '{"recipe": "multi-level", "base": "builtin:mx-red", "parameters": {"levels": 1e999}}'
    answer = client.post("/api/program.recipe", content=body, headers={"content-type": "application/json"})
    assert answer.status_code in (400, 422)


def test_a_broken_file_in_the_project_is_listed_and_opens_with_one_line(
    client: TestClient, own_studio: Studio
) -> None:
    folder: Path = own_studio.project / "programs"
    folder.mkdir(parents=True)
    for name in ("bad", ".half"):
        (folder / f"{name}.fdvv-program.json").write_text("{")
    (own,) = [row for row in ask(client, "list")["programs"] if row["id"].startswith("own:")]
    assert (own["id"], bool(own["problem"])) == ("own:bad", True)
    ask(client, "open", 422, program="own:bad")
