"""fdvv study jnds: from a study of thresholds to distances and verdicts in the JNDs of its people."""

from __future__ import annotations

from pathlib import Path

import pytest

from fdvv.model.jnd_file import save_jnds
from fdvv.model.noticeable import DIMENSIONS
from tests.support.command_line import Run, tactile_csv
from tests.support.jnds import as_literature, record_of

PASS = "correct horse battery staple"


def simulated_study(fdvv: Run, people: int, weber_ratio: float) -> None:
    """Leave an unsealed study of thresholds of force in the folder weights."""
    assert fdvv("study", "new", "weights", "--kind", "thresholds").status == 0
    path = Path("weights/study.toml")
    text = path.read_text().replace("people = 8", f"people = {people}").replace("trials = 54", "trials = 18")
    text = text.replace('dimensions = ["force", "snap", "vibration"]', 'dimensions = ["force"]')
    path.write_text(text)
    Path("pass").write_text(f"{PASS}\n")
    about = ("--passphrase-file", "pass")
    assert fdvv("study", "freeze", "weights", *about).status == 0
    simulate = ("study", "simulate", "weights", "--fast", "--set", f"weber_ratio={weber_ratio}")
    assert fdvv(*simulate).status == 0
    assert fdvv("study", "unseal", "weights", "--who", "me", "--why", "a test", *about).status == 0


@pytest.mark.slow
def test_what_a_study_measured_is_what_library_comparison_and_verdict_count_in(fdvv: Run) -> None:
    simulated_study(fdvv, 3, 0.2)
    assert "Three of four comparisons notice force" in fdvv("study", "analyse", "weights").out
    Path("project").mkdir()
    document = fdvv("study", "jnds", "weights", "--into", "project", "--json").json
    assert (document["simulated"], document["files"]) == (True, ["project/jnds.json"])
    (jnd,) = document["jnds"]
    origin = "JNDs of force of 3 people of study weights (simulated)"
    literature = fdvv("compare", "mx-clear", "mx-brown")
    own = fdvv("compare", "mx-clear", "mx-brown", "--jnds", "project")
    assert "Counted in JNDs from the literature" in literature.out
    assert f"Counted in {origin}" in " ".join(own.out.split())

    Path("switches").mkdir()
    tactile_csv(Path("switches/red.csv"))
    assert fdvv("library", "build", "switches", "-o", "library", "--processes", "1").status == 0
    like = ("library", "like", "library", "mx-clear", "--json")
    before, after = fdvv(*like).json, fdvv(*like, "--jnds", "project").json
    times = after["jnds"]["force_ratio"] / before["jnds"]["force_ratio"]
    assert times == pytest.approx(jnd["ratio"] * jnd["standard"] / (0.07 * (jnd["standard"] + 30)))
    assert after["jnds"]["origin"] == origin
    assert after["hits"][0]["force_JND"] == pytest.approx(before["hits"][0]["force_JND"] / times, abs=2e-3)

    probe = ("probe", "mx-clear", "--velocity", "100", "--presses", "1")
    first, second = fdvv(*probe, "--json").json, fdvv(*probe, "--jnds", "project", "--json").json
    shares = [one["noticeable"]["total"]["above_ratio"] for one in (first, second)]
    assert shares[1] < shares[0]
    assert second["verdict"].startswith(f"By {origin}, a finger would not notice the force on ")
    assert f"by {origin}" in " ".join(fdvv(*probe, "--jnds", "project").out.split())

    Path("project/jnds.json").unlink()
    gone = fdvv(*like, "--jnds", "project")
    assert gone.status == 2
    assert "project: project: holds no jnds.json" in gone.json["error"]["message"]


def test_what_people_notice_decides_between_two_buttons(fdvv: Run) -> None:
    for name, times, felt in (("sharp", 1.0, "feels clos"), ("dull", 10.0, "can hardly be felt apart from")):
        jnds = [as_literature(dimension, times) for dimension in DIMENSIONS]
        save_jnds(record_of(*jnds), Path(f"{name}.json"))
        said = " ".join(fdvv("compare", "mx-clear", "mx-brown", "--jnds", f"{name}.json").out.split())
        assert f"mx-brown {felt}" in said
        assert "Counted in JNDs of 12 people of study weights" in said


def test_a_file_that_is_none_of_jnds_is_refused_in_one_line(fdvv: Run) -> None:
    Path("bad.json").write_text('{"format": "fdvv-jnds", "version": 1}')
    for command in (("compare", "mx-clear", "mx-red"), ("probe", "mx-red", "--velocity", "100")):
        ran = fdvv(*command, "--jnds", "bad.json")
        assert ran.status == 2
        assert ran.err.startswith("fdvv: bad.json: ")
        assert ran.err.count("\n") == 1


def test_a_study_of_another_kind_and_a_sealed_one_are_refused(fdvv: Run) -> None:
    for kind, said in (("2afc", "measures no JND"), ("timing", "measures no JND"), ("staircase", "unseal")):
        assert fdvv("study", "new", kind, "--kind", kind).status == 0
        ran = fdvv("study", "jnds", kind)
        assert ran.status == 2
        assert said in ran.err
