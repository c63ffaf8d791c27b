"""Files that are dropped on the page, asked as the page asks."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from starlette.testclient import TestClient

from fdvv.button.export_file import export_vibration
from fdvv.model.file import load_builtin, model_to_json
from fdvv_studio.studio.studio import Studio
from tests.support.buttons import known_cN, write_cycle


def dropped(client: TestClient, *files: tuple[str, bytes], **options: Any) -> list[dict[str, Any]]:
    contents = [{"name": name, "content": base64.b64encode(data).decode()} for name, data in files]
    answer = client.post("/api/file.read", json={"files": contents, **options})
    assert answer.status_code == 200, answer.text
    found: list[dict[str, Any]] = answer.json()["buttons"]
    return found


def cycle(folder: Path) -> bytes:
    return write_cycle(folder / "measured.csv").read_bytes()


def test_a_file_is_fitted_beside_its_samples_and_nothing_is_kept(
    client: TestClient, own_studio: Studio, tmp_path: Path
) -> None:
    (found,) = dropped(client, ("My Switch.csv", cycle(tmp_path)))
    assert (found["file"], found["name"], found["reason"]) == ("My Switch.csv", "My Switch", "")
    assert found["sentence"].startswith("Tactile: the press falls by ")
    press = found["samples"][0]
    assert 400 < len(press["force_cN"]) <= 1500
    drawn = found["strokes"][0]
    x = drawn["start_mm"] + drawn["step_mm"] * np.arange(len(drawn["force_cN"]))
    off = np.interp(press["displacement_mm"], x, drawn["force_cN"]) - press["force_cN"]
    assert np.sqrt(np.mean(off**2)) < 0.1
    assert [fit["stroke"] for fit in found["fits"]] == ["press", "release"]
    assert not (own_studio.project / "buttons").exists()


def test_what_was_read_can_be_kept_under_a_name(client: TestClient, tmp_path: Path) -> None:
    (found,) = dropped(client, ("a/b/My Switch.csv", cycle(tmp_path)))
    question = {"name": found["name"], "template": None, "model": found["model"]}
    assert client.post("/api/document.create", json=question).json() == {"button": "own:My Switch"}
    (again,) = dropped(client, ("My Switch.csv", cycle(tmp_path)))
    assert again["name"] == "My Switch 2"


def strokes() -> list[tuple[str, bytes]]:
    x = np.round(np.arange(0.0, 4.38, 0.005), 3)
    files = []
    for name, stroke, places in (("downstroke", "press", x), ("upstroke", "release", x[::-1])):
        rows = "\n".join(f"{v},{f}" for v, f in zip(places, known_cN(places, stroke), strict=True))
        files.append((f"set/Two.{name}.csv", f"displacement_mm,force_cN\n{rows}\n".encode()))
    return files


def test_the_two_files_of_a_pair_are_one_button(client: TestClient) -> None:
    pair = strokes()
    for files in (pair, pair[::-1]):
        (found,) = dropped(client, *files)
        assert [fit["stroke"] for fit in found["fits"]] == ["press", "release"]
    assert len(dropped(client, pair[0], ("elsewhere/Two.upstroke.csv", pair[1][1]))) == 2


def test_a_refused_file_says_why_and_the_others_are_read(client: TestClient, tmp_path: Path) -> None:
    found = dropped(client, ("bad.csv", b"text,of\nno,use\n"), ("good.csv", cycle(tmp_path)))
    assert [bool(one["reason"]) for one in found] == [True, False]
    assert found[0]["reason"].count("\n") == 0
    assert str(tmp_path.anchor + "tmp") not in found[0]["reason"]


def test_what_cannot_be_a_button_is_read_when_it_is_accepted(client: TestClient) -> None:
    x = np.round(np.arange(0.0, 4.3, 0.01), 3)
    rows = "\n".join(f"{v},{60 + 0.001 * v}" for v in x)
    flat = ("flat.csv", f"displacement_mm,force_cN\n{rows}\n".encode())
    (refused,) = dropped(client, flat)
    assert refused["model"] is None
    assert "cannot be a button's" in refused["reason"]
    assert refused["doubted"]
    assert "--accept" not in refused["reason"]
    (taken,) = dropped(client, flat, accept_implausible=True)
    assert any("implausible" in note for note in taken["notes"])


def test_a_model_file_is_opened_as_it_is(client: TestClient) -> None:
    text = model_to_json(load_builtin("mx-clear"))
    (found,) = dropped(client, ("x.fdvv.json", text.encode()))
    assert found["name"] == load_builtin("mx-clear").name
    assert len(found["strokes"]) == 10
    assert found["samples"] == []


def test_a_sound_goes_into_the_button_that_the_page_shows(client: TestClient) -> None:
    snap = load_builtin("mx-clear").vibrations[0]
    sound = ("snap.wav", export_vibration(snap, "wav", "snap").data)
    (alone,) = dropped(client, sound)
    assert "open the button that it belongs to" in alone["reason"]
    (given,) = dropped(client, sound, into="builtin:mx-red", full_scale_m_s2=50.0)
    assert len(given["model"]["vibrations"]) >= 1, given["reason"]


@pytest.mark.parametrize(
    "name",
    [
        "../../../escaped.csv",
        "..",
        "/etc/passwd",
        "C:\\users\\me\\x.csv",
        "a\0b.csv",
        "\U0001f600" * 300,
        "con.csv/..",
    ],
)
def test_no_name_leads_out_of_the_folder(client: TestClient, tmp_path: Path, name: str) -> None:
    before = set(tmp_path.parent.iterdir())
    (found,) = dropped(client, (name, cycle(tmp_path)))
    assert found["reason"] == "", found["reason"]
    assert not (tmp_path.parent / "escaped.csv").exists()
    assert set(tmp_path.parent.iterdir()) == before


FOLDERS: Sequence[tuple[str, str]] = (
    ("haata", "*.csv"),
    ("bluepylons", "*.ods"),
    ("bluepylons-parsed", "*.csv"),
    ("geekboards", "*.json"),
    ("joaoachando", "tf*.json"),
    ("buddyog-topre", "*/*.csv"),
    ("tg-tidy", "data/*.csv"),
)


@pytest.mark.shared
@pytest.mark.parametrize(("folder", "files"), FOLDERS)
def test_every_format_of_real_files_can_be_dropped(
    client: TestClient, shared_data: Path, folder: str, files: str
) -> None:
    paths = sorted((shared_data / folder).glob(files))[:4]
    assert paths
    found = dropped(client, *((str(path.relative_to(shared_data)), path.read_bytes()) for path in paths))
    assert [one["reason"] for one in found if one["reason"]] == []
    assert all(one["model"] and one["samples"] for one in found)


@pytest.mark.shared
@pytest.mark.parametrize(
    ("folder", "files"),
    [
        ("tg-raw-excerpt", "*.csv"),
        ("forcepeaks-tapping", "*.dat"),
        ("wooting-analog", "*.csv"),
        ("audio-mechvibes", "*/*.ogg"),
        ("optitrack-motive", "*/*.csv"),
        ("baath-sync-tapping", "*.csv"),
    ],
)
def test_a_real_file_that_is_no_button_is_refused_in_one_line(
    client: TestClient, shared_data: Path, folder: str, files: str
) -> None:
    paths = sorted((shared_data / folder).glob(files))[:2]
    assert paths
    for found in dropped(client, *((path.name, path.read_bytes()) for path in paths)):
        assert found["model"] is None
        assert found["reason"]
        assert found["reason"].count("\n") == 0
