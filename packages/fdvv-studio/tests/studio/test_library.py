"""The library's calls and channel, asked as the page asks."""

from __future__ import annotations

import base64
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from starlette.testclient import TestClient

from fdvv.model.file import MODEL_SUFFIX, builtin_names, load_builtin, save_model
from fdvv.model.jnd_file import FILE_NAME as JNDS_FILE
from fdvv.model.jnd_file import save_jnds
from fdvv_studio.library.row import NUMBERS as SHELF_NUMBERS
from fdvv_studio.studio.server import address_of, create_app
from fdvv_studio.studio.studio import Studio
from tests.studio.conftest import LIVE, ORIGIN, TOKEN
from tests.support.buttons import write_cycle
from tests.support.jnds import as_literature, record_of


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("bench")
    for i, name in enumerate(("Kailh Pro", "Gateron Yellow")):
        write_cycle(folder / f"{name}.csv", added_cN=5 * i, seed=i)
    (folder / "bad.csv").write_text("text,of,no,kind\n1,2,3,4\n")
    return folder


@pytest.fixture(scope="module")
def project(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("library") / "project"


@pytest.fixture(scope="module")
def client(project: Path, bench: Path) -> Iterator[TestClient]:
    """A studio whose index has read everything."""
    save_model(load_builtin("mx-red"), project / "buttons" / f"mine{MODEL_SUFFIX}")
    app = create_app(Studio(project, (bench,)), address_of(["127.0.0.1"], 8377, TOKEN))
    with TestClient(app, base_url=ORIGIN, headers={"origin": ORIGIN}) as client:
        client.get("/", params={"token": TOKEN})
        with client.websocket_connect(LIVE, headers={"origin": ORIGIN}) as live:
            live.send_json({"channel": "library", "body": {"type": "watch"}})
            while not live.receive_json()["body"]["ended"]:
                pass
        yield client


def ask(client: TestClient, name: str, **question: Any) -> Any:
    answer = client.post(f"/api/library.{name}", json=question)
    assert answer.status_code == 200, answer.text
    return answer.json()


def test_the_index_gives_every_button_as_columns(client: TestClient) -> None:
    found = ask(client, "index")
    count = len(builtin_names()) + 3
    assert found["standing"] | {"epoch": 0} == {
        **{"type": "standing", "epoch": 0, "rows": count, "refused": 1, "done": 4, "total": 4},
        **{"ended": True, "sources": 1, "trouble": ""},
    }
    assert set(found["numbers"]) == set(SHELF_NUMBERS)
    for column in (found["ids"], found["kinds"], *found["numbers"].values()):
        assert len(column) == count
    sketches = np.frombuffer(base64.b64decode(found["sketches"]), "<i2").reshape(count, 2, 64)
    clear = found["ids"].index("builtin:mx-clear")
    expected = load_builtin("mx-clear").force_cN(np.linspace(0, 4, 64), 0.5)
    np.testing.assert_allclose(0.1 * sketches[clear, 0], expected, atol=0.0501)


def test_rows_that_the_page_has_are_not_sent_again(client: TestClient) -> None:
    whole = ask(client, "index")
    epoch = whole["standing"]["epoch"]
    rest = ask(client, "index", epoch=epoch, first=4)
    assert (rest["first"], rest["ids"]) == (4, whole["ids"][4:])
    assert ask(client, "index", epoch=epoch + 1, first=4)["ids"] == whole["ids"]


def test_what_is_found_are_positions_of_the_index(client: TestClient) -> None:
    names = ask(client, "index")["names"]
    found = ask(client, "find", text="gatreon", ranges={"travel_mm": {"low": 3}})
    assert [names[at] for at in found["positions"]] == ["Gateron Yellow"]
    assert found["mended"] == ["gatreon"]
    assert found["without"] == {"text": len(names), "travel_mm": 1}
    assert sum(found["histograms"]["travel_mm"]["counts"]) == 1


def test_a_picker_gets_rows(client: TestClient) -> None:
    found = ask(client, "search", text="mx", limit=2)
    assert [row["id"] for row in found["rows"]] == ["builtin:mx-black", "builtin:mx-blue"]
    assert found["total"] == 6
    assert found["ended"]
    assert found["rows"][0]["peak_cN"] is None
    assert found["rows"][1]["peak_cN"] == pytest.approx(66.5, abs=0.5)


def test_the_nearest_come_first_with_what_they_differ_in(client: TestClient) -> None:
    alike = ask(client, "like", id="own:mine", limit=3)["alike"]
    assert alike[0]["row"]["id"] == "builtin:mx-red"
    assert alike[0]["distance_jnd"] == 0
    for one in alike:
        parts = np.array([one["force_jnd"], one["shape_jnd"], one["landmarks_jnd"]])
        assert one["distance_jnd"] == pytest.approx(np.sqrt(np.mean(parts**2)), abs=2e-3)


def test_curves_come_with_all_that_is_known_and_a_stale_id_keeps_no_other_back(client: TestClient) -> None:
    ids = ask(client, "index")["ids"]
    measured = next(one for one in ids if one.startswith("measured:"))
    found = ask(client, "curves", ids=["own:gone", "builtin:mx-clear", measured])
    assert [one["id"] for one in found["buttons"]] == ["builtin:mx-clear", measured]
    assert [one["id"] for one in found["missing"]] == ["own:gone"]
    assert "no button is called" in found["missing"][0]["reason"]
    clear = found["buttons"][0]
    model = load_builtin("mx-clear")
    assert len(clear["strokes"]) == len(model.curves)
    for stroke, curve in zip(clear["strokes"], model.curves, strict=True):
        assert (stroke["stroke"], stroke["velocity_mm_s"]) == (curve.stroke, curve.velocity_mm_s)
        x = stroke["start_mm"] + stroke["step_mm"] * np.arange(len(stroke["force_cN"]))
        np.testing.assert_allclose(stroke["force_cN"], curve.force_cN(x), atol=6e-4)
    assert found["buttons"][1]["cycles"] == 1
    assert "reset: " not in " ".join(found["buttons"][1]["why"])


def test_refusals_are_shown_without_a_path_of_the_machine(client: TestClient, bench: Path) -> None:
    (file,) = ask(client, "refused")["files"]
    assert file["place"].endswith("bad.csv")
    assert str(bench.parent) not in file["place"] + file["reason"]


@pytest.mark.parametrize(
    ("name", "question", "status"),
    [
        ("find", {"sort": "weight"}, 422),
        ("find", {"ranges": {"../x": {}}}, 422),
        ("find", {"text": "x" * 201}, 400),
        ("like", {"id": "own:none"}, 422),
        ("like", {"id": "own:mine", "limit": 0}, 400),
        ("curves", {"ids": ["x"] * 101}, 400),
        ("index", {"first": -1}, 400),
        ("search", {"path": "/"}, 400),
    ],
)
def test_wrong_questions_are_refused_in_one_line(
    client: TestClient, name: str, question: dict[str, Any], status: int
) -> None:
    answer = client.post(f"/api/library.{name}", json=question)
    assert answer.status_code == status
    assert "\n" not in answer.json()["error"]


def test_a_rescan_finds_what_came_and_went_and_notifies_the_page(client: TestClient, bench: Path) -> None:
    with client.websocket_connect(LIVE, headers={"origin": ORIGIN}) as live:
        live.send_json({"channel": "library", "body": {"type": "watch"}})
        before = live.receive_json()["body"]

        def rescanned(rows: int) -> Any:
            ask(client, "rescan")
            while (state := live.receive_json()["body"])["rows"] != rows or not state["ended"]:
                pass
            return state

        write_cycle(bench / "Later.csv")
        assert rescanned(before["rows"] + 1)["epoch"] > before["epoch"]
        assert ask(client, "search", text="later")["total"] == 1
        (bench / "Later.csv").unlink()
        rescanned(before["rows"])
        assert ask(client, "search", text="later")["total"] == 0


def test_distances_count_in_the_projects_own_jnds_while_its_file_is_there(
    client: TestClient, project: Path
) -> None:
    def looked() -> tuple[str, list[float], str, str]:
        alike = ask(client, "like", id="builtin:mx-clear")
        found = ask(client, "find", like="builtin:mx-clear")
        page = ask(client, "page", ids=["builtin:mx-clear", "builtin:mx-red"])["html"]
        assert alike["jnds"] == found["jnds"]
        return alike["jnds"], [one["force_jnd"] for one in alike["alike"]], found["distances_jnd"], page

    before = looked()
    assert before[0] == "JNDs from the literature"
    save_jnds(record_of(as_literature("force", 2.0), simulated=True), project / JNDS_FILE)
    own = looked()
    assert own[0] == "JNDs of force of 12 people of study weights (simulated)"
    assert sum(own[1]) < sum(before[1])
    assert own[0] in own[3]
    (project / JNDS_FILE).write_text("{")
    for name, question in (("like", {"id": "builtin:mx-clear"}), ("find", {"like": "builtin:mx-clear"})):
        broken = client.post(f"/api/library.{name}", json=question)
        assert broken.status_code != 200
        assert re.fullmatch(
            rf"{JNDS_FILE}, end of file: not valid JSON .*; write {JNDS_FILE} again .*, or remove it",
            broken.json()["error"],
        )
    assert ask(client, "find", text="mx")["positions"]
    (project / JNDS_FILE).unlink()
    assert looked() == before
