"""fdvv feasible: whether a known rig can render a button, and why not."""

from __future__ import annotations

from pathlib import Path

import pytest

from fdvv.compensation.identification.rig_file import save_rig
from fdvv.twin.files import finger_to_toml, rig_to_toml
from tests.support.command_line import Run
from tests.support.rig_truth import draw_fast_rig, rig_truth


@pytest.fixture
def known(tmp_path: Path) -> tuple[str | Path, ...]:
    """Return the options that name one simulated rig, its finger and its identified model."""
    rig, finger = draw_fast_rig(407, "voltage")
    save_rig(rig_truth(rig), tmp_path / "mine.rig.json")
    (tmp_path / "rig.toml").write_text(rig_to_toml(rig))
    (tmp_path / "finger.toml").write_text(finger_to_toml(finger))
    return (
        *("--rig-known", tmp_path / "mine.rig.json"),
        *("--rig", tmp_path / "rig.toml", "--finger", tmp_path / "finger.toml"),
    )


def test_a_table_of_curves_is_followed_by_the_reasons_and_the_warmth(
    fdvv: Run, known: tuple[str | Path, ...]
) -> None:
    ran = fdvv("feasible", "mx-clear", *known, "--velocity", "50", "--velocity", "350")
    assert ran.status == 0
    lines = ran.out.splitlines()
    assert [line[:16].strip() for line in lines[2:6]] == [
        "press 50 mm/s",
        "press 350 mm/s",
        "release 50 mm/s",
        "release 350 mm/s",
    ]
    assert lines[2].endswith("can follow")
    assert lines[3].endswith("cannot")
    assert any(line.startswith("press 350 mm/s: needs a command of") for line in lines)
    assert sum(line.startswith("warmth at") for line in lines) == 2
    assert "an estimate" in ran.out
    assert max(len(line) for line in lines) <= 100


def test_json_holds_the_whole_report(fdvv: Run, known: tuple[str | Path, ...]) -> None:
    report = fdvv("feasible", "mx-red", *known, "--velocity", "80", "--json").json
    assert [c["stroke"] for c in report["curves"]] == ["press", "release"]
    for curve in report["curves"]:
        assert len(curve["displacement_mm"]) == len(curve["achievable_cN"]) == len(curve["command_cN"])
        assert curve["expected_error"]["mean_cN"] > 0
    assert report["thermal"][0]["velocity_mm_s"] == 80.0


def test_a_learned_table_is_pressed_and_drawn_with_the_rest(
    fdvv: Run, known: tuple[str | Path, ...], tmp_path: Path
) -> None:
    learned, figure = tmp_path / "a.actuation.json", tmp_path / "a.svg"
    where = (*known[2:], "--velocity", "60")
    fdvv(
        "compensate", "mx-red", *where, "--method", "paper", "--rounds", "1", "--presses", "2", "-o", learned
    )
    ran = fdvv(
        *("feasible", "mx-red", *known, "--velocity", "60"),
        *("--actuation", learned, "--presses", "2", "--seed", "9", "--figure", figure, "--json"),
    )
    measured = [curve["measured"] for curve in ran.json["curves"]]
    assert all(m["mean_error_cN"] > 0 for m in measured)
    assert ran.json["simulated"]
    assert figure.read_text().lstrip().startswith("<?xml")


def test_without_a_known_rig_one_line_tells_how_to_get_it(fdvv: Run) -> None:
    ran = fdvv("feasible", "mx-clear")
    assert ran.status == 0
    assert len(ran.out.splitlines()) == 1
    assert "--rig-known" in ran.out
    assert "identify" in ran.out
