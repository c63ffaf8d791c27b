"""fdvv compensate on a rig that is met once: learn, keep the rig, render other buttons."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest

from fdvv.compensation.identification.rig_file import load_learned_rig, load_rig, save_rig
from fdvv.compensation.rig_aware import RigAware
from fdvv.rendering.actuation_file import load_actuation
from fdvv.twin.files import load_rig as load_plant
from fdvv.twin.files import rig_to_toml
from tests.support.command_line import Run

SHORT = ("--velocity", "50", "--velocity", "100")
LEARN = ("compensate", "mx-clear", *SHORT, "--rounds", "1", "--save-rig", "bench.rig.json")
AT_ONCE = ("compensate", "mx-red", *SHORT, "--rig-known", "bench.rig.json", "--rounds", "0")


@pytest.fixture(scope="module")
def taught(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """Return the file of a rig that was identified once."""
    from fdvv.device.twin import TwinDevice
    from fdvv.model.file import load_builtin
    from fdvv.rendering.compensate import compensate

    path = tmp_path_factory.mktemp("rig") / "bench.rig.json"
    device = TwinDevice(load_plant("recommended"), seed=0)
    learned = compensate(device, load_builtin("mx-clear"), [50.0, 100.0], RigAware(rounds=1))
    assert learned.learned_rig is not None
    save_rig(learned.learned_rig, path)
    return path.read_bytes()


def test_a_rig_is_identified_learned_on_and_kept(fdvv: Run, tmp_path: Path, taught: bytes) -> None:
    ran = fdvv(*LEARN, "-v", "-o", "clear.actuation.json")
    assert ran.status == 0
    lines = ran.out.splitlines()
    assert lines[0] == "mx-clear on twin (simulated), 6 presses"
    assert re.search(r"^mean error \d\.\d cN, largest \d+\.\d cN$", ran.out, re.MULTILINE)
    assert lines[1].startswith("method: force-loop: the loop at the finger closed on an identified rig")
    assert lines[-2:] == ["written to clear.actuation.json", "written to bench.rig.json"]
    assert "1 of 4 identification presses" in ran.err
    assert re.search(r"drag \d\.\d \+- \d\.\d N s/m", ran.err)
    assert (tmp_path / "bench.rig.json").read_bytes() == taught
    memory = load_learned_rig(tmp_path / "bench.rig.json")
    assert memory.rig == load_rig(tmp_path / "bench.rig.json")
    assert memory.rig.presses == 4
    assert (
        load_actuation(tmp_path / "clear.actuation.json").outcome.tuning.bandwidth_Hz
        == RigAware().bandwidth_Hz
    )


def test_another_button_is_rendered_at_once_and_its_expected_errors_are_printed(
    fdvv: Run, tmp_path: Path, taught: bytes
) -> None:
    (tmp_path / "bench.rig.json").write_bytes(taught)
    ran = fdvv(*AT_ONCE, "-o", "red.actuation.json")
    assert (ran.status, ran.err) == (0, "")
    lines = ran.out.splitlines()
    assert lines[0] == "mx-red on twin (simulated), 0 presses"
    rows = [line for line in lines if line.startswith(("press ", "release "))]
    assert len(rows) == 4
    assert all(re.search(r"–\s+–\s+\d\.\d\d\s+–$", row) for row in rows)
    assert "nothing was pressed: the mean is what was left on the button that taught the rig" in lines
    expected = [c.mean_error_cN for c in load_actuation(tmp_path / "red.actuation.json").outcome.curves]
    memory = load_learned_rig(tmp_path / "bench.rig.json")
    assert expected == memory.error_cN.ravel().tolist()
    document = fdvv(*AT_ONCE, "--json").json
    assert document["presses"] == document["receipt"]["used"] == 0
    assert [c["max_error_cN"] for c in document["curves"]] == [None] * 4
    judged = fdvv("probe", "mx-red", "red.actuation.json", *SHORT, "--presses", "2", "--seed", "5", "--json")
    plain = fdvv("probe", "mx-red", *SHORT, "--presses", "2", "--seed", "5", "--json")
    means = [[c["mean_error_cN"] for c in ran.json["curves"]] for ran in (judged, plain)]
    assert sum(means[0]) < 0.5 * sum(means[1])


def test_a_changed_rig_is_reported_also_when_json_is_printed(
    fdvv: Run, tmp_path: Path, taught: bytes
) -> None:
    (tmp_path / "bench.rig.json").write_bytes(taught)
    (tmp_path / "rig.toml").write_text("[mover]\nmass_kg = 0.045\n")
    ran = fdvv(*AT_ONCE[:-1], "1", "--rig", "rig.toml", "--json")
    assert ran.status == 0
    assert ran.json["presses"] >= 2
    assert ran.err.startswith("warning: the rig is not as its file says: ")
    assert ran.err.count("\n") == 1
    same = fdvv(*AT_ONCE[:-1], "1", "--seed", "8", "--json")
    assert (same.status, same.err) == (0, "")


def test_a_probe_says_that_a_table_was_made_for_another_rig(fdvv: Run, tmp_path: Path, taught: bytes) -> None:
    (tmp_path / "bench.rig.json").write_bytes(taught)
    plant = load_plant("recommended")
    rough = replace(plant, mover=replace(plant.mover, coulomb_N=0.1))
    (tmp_path / "rig.toml").write_text(rig_to_toml(rough))
    assert fdvv(*AT_ONCE, "-o", "red.actuation.json").status == 0
    probe = ("probe", "mx-red", "red.actuation.json", *SHORT, "--presses", "2", "--json")
    same = fdvv(*probe)
    assert (same.status, same.err) == (0, "")
    other = fdvv(*probe, "--rig", "rig.toml")
    assert other.err.startswith("warning: the rig is not as its file says: friction rose")
    assert other.err.count("\n") == 1


def test_a_session_on_a_rig_goes_on_under_the_name_the_rig_had_before(fdvv: Run) -> None:
    paper = ("compensate", "mx-clear", "--velocity", "100", "--method", "paper", "--presses", "2")
    before = fdvv(*paper, "--rounds", "1", "--rig", "voltage", "--session", "s", "--json")
    again = fdvv(*paper, "--rounds", "1", "--rig", "default", "--session", "s", "--json")
    assert (before.status, again.status) == (0, 0)
    assert again.json["curves"] == before.json["curves"]
    other = fdvv(*paper, "--rounds", "1", "--rig", "light", "--session", "s")
    assert other.status == 2
    unknown = fdvv(*paper, "--rig", "simple")
    assert "one of recommended, ideal, light, paper, voltage" in unknown.err


def test_the_papers_law_is_there_by_its_name(fdvv: Run) -> None:
    paper = ("compensate", "mx-clear", "--velocity", "50", "--method", "paper", "--presses", "2")
    ran = fdvv(*paper, "--rounds", "1", "--json")
    assert ran.json["receipt"]["used"] == 2
    assert ran.json["receipt"]["settings"]["law"]["rounds"] == 1
    literal = fdvv(*paper, "--rounds", "2", "--literal", "--json").json
    assert literal["method"] != ran.json["method"]
    assert literal["receipt"]["used"] == 4


def test_a_probe_ends_with_its_verdict_and_the_next_step_and_draws_them(fdvv: Run, tmp_path: Path) -> None:
    probe = ("probe", "mx-clear", "--rig", "voltage", "--velocity", "50", "--presses", "2", "--seed", "7")
    ran = fdvv(*probe, "--figure", "f.svg", "--report", "r.html")
    assert ran.status == 0
    lines = ran.out.splitlines()
    assert lines[0] == "mx-clear on twin (simulated), 2 presses, 2 more with the vibration"
    text = " ".join(line.strip() for line in lines)
    assert "By JNDs from the literature, a finger would not notice the force on" in text
    assert "the 239 Hz vibration at 2.3 mm" in text
    assert "Next: Learn the actuation with fdvv compensate, then probe again." in lines
    assert lines[-2:] == ["written to f.svg", "written to r.html"]
    assert "<svg" in (tmp_path / "f.svg").read_text()
    assert "Just noticeable differences" in (tmp_path / "r.html").read_text()
    document = fdvv(*probe, "--json").json
    assert document["verdict"] in text
    assert (document["presses"], document["vibration_presses"]) == (2, 2)
    assert 0 <= document["noticeable"]["total"]["above_ratio"] <= 1
    silent = fdvv(*probe, "--vibration-presses", "0", "--json").json
    assert silent["vibration_presses"] == 0
    assert silent["curves"][0]["vibration"]["outcome"] == "not played"
    for one, other in zip(silent["curves"], document["curves"], strict=True):
        assert one["mean_error_cN"] == other["mean_error_cN"]


def test_a_button_without_a_vibration_asks_for_none(fdvv: Run) -> None:
    ran = fdvv("probe", "mx-red", "--velocity", "50", "--presses", "1")
    assert "; no vibration was asked for." in " ".join(ran.out.split())
    assert "late ms" not in ran.out
