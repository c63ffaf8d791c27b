"""The editor's questions, asked as the page asks them. Simulated rigs."""

from __future__ import annotations

import json
from typing import Any

import pytest
from starlette.testclient import TestClient

from fdvv.device.twin import TwinDevice
from fdvv.model.file import load_builtin, model_from_json, model_to_json
from fdvv.rendering.compensate import start_surface
from fdvv.rendering.probe import probe
from fdvv_studio.studio.studio import Studio

MODEL = json.loads(model_to_json(load_builtin("mx-clear")))


def post(client: TestClient, name: str, question: dict[str, Any], status: int = 200) -> Any:
    answer = client.post(f"/api/editor.{name}", json=question)
    assert answer.status_code == status, answer.text
    return answer.json()


def test_the_shipped_rigs_are_listed_and_said_to_be_simulated(client: TestClient) -> None:
    rigs = post(client, "rigs", {})["rigs"]
    assert [r["rig_id"] for r in rigs] == [
        f"shipped:{name}" for name in ("recommended", "light", "paper", "voltage")
    ]
    assert all(r["simulated"] and not r["known"] for r in rigs)


def test_a_rig_answers_for_both_strokes_of_the_speed_asked(client: TestClient) -> None:
    question = {"model": MODEL, "velocities_mm_s": [100.0], "rig_id": "shipped:light"}
    curves = post(client, "achievable", question)["curves"]
    assert [(c["stroke"], c["velocity_mm_s"]) for c in curves] == [("press", 100.0), ("release", 100.0)]
    press = curves[0]
    sizes = {len(press[name]) for name in ("displacement_mm", "intended_cN", "achievable_cN")}
    assert sizes == {201}
    assert press["verdict"] in ("can follow", "follows in part", "cannot")
    known = {rig["rig_id"]: rig["known"] for rig in post(client, "rigs", {})["rigs"]}
    assert known["shipped:light"]


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"rig_id": "own:../../x"}, "no such rig"),
        ({"model": {"format": "fdvv-model"}}, "version"),
        ({"model": MODEL | {"travel_mm": -1.0}}, "travel_mm"),
    ],
)
def test_what_cannot_be_answered_is_one_line(client: TestClient, change: dict[str, Any], said: str) -> None:
    question = {"model": MODEL, "velocities_mm_s": [50.0], "rig_id": "shipped:light"} | change
    line = post(client, "achievable", question, 422)["error"]
    assert said in line
    assert "\n" not in line


def test_speeds_that_no_finger_has_are_refused(client: TestClient) -> None:
    for speeds in ([], [0.001], [1e9], [50.0] * 25):
        question = {"model": MODEL, "velocities_mm_s": speeds, "rig_id": "shipped:light"}
        assert "velocities_mm_s" in post(client, "achievable", question, 400)["error"]


def test_a_button_of_the_shelf_is_given_as_in_its_file(client: TestClient) -> None:
    document = post(client, "button", {"button_id": "builtin:mx-clear"})["model"]
    assert model_from_json(json.dumps(document), "model") == load_builtin("mx-clear")
    assert "no button is called" in post(client, "button", {"button_id": "own:none"}, 422)["error"]


def test_measured_presses_are_listed_once_there_is_a_file(client: TestClient, own_studio: Studio) -> None:
    assert post(client, "measured", {"name": "mine"}) == {"found": None}
    device, model = TwinDevice(seed=3), load_builtin("mx-clear")
    probed = probe(device, model, start_surface(device, model, [50.0]), [50.0], presses=2)
    folder = own_studio.project / "measured"
    folder.mkdir(parents=True)
    (folder / "mine.json").write_text(json.dumps(probed.to_dict()))
    found = post(client, "measured", {"name": "mine"})["found"]
    assert (found["presses"], found["simulated"], len(found["curves"])) == (2, True, 2)
    for curve in found["curves"]:
        for low, median, high in zip(curve["low_cN"], curve["median_cN"], curve["high_cN"], strict=True):
            assert low <= median <= high
