"""A user's mistake gets one line that says what, where and what to do; a missed bound gets status 1."""

from __future__ import annotations

import json
from importlib import resources
from pathlib import Path

import pytest

from fdvv.compensation.identification.rig_file import save_rig
from fdvv.compensation.identification.rig_model import RigModel
from tests.support.command_line import Run, tactile_csv

OUT = ("-o", "new.fdvv.json")
MERGE, ASSIGN = ("--name", "x", *OUT), ("--stroke", "press", *OUT)


def blue() -> dict[str, object]:
    text = (resources.files("fdvv.model") / "builtin" / "mx-blue.fdvv.json").read_text()
    record = json.loads(text)
    assert isinstance(record, dict)
    return record


@pytest.fixture
def bad(tmp_path: Path) -> Path:
    """Fill the test's folder with files and folders that cannot be used."""
    tactile_csv(tmp_path / "good.csv")
    pounds = (tmp_path / "good.csv").read_text().replace("force_cN", "force_lbf")
    (tmp_path / "pounds.csv").write_text(pounds)
    (tmp_path / "empty.csv").touch()
    (tmp_path / "empty").mkdir()
    (tmp_path / "refused").mkdir()
    (tmp_path / "refused" / "text.csv").write_text("nothing in here\n")
    (tmp_path / "binary.csv").write_bytes(bytes(range(256)) * 8)
    text = json.dumps(blue(), indent=1)
    (tmp_path / "good.fdvv.json").write_text(text)
    (tmp_path / "cut.fdvv.json").write_text(text[:700])
    (tmp_path / "binary.fdvv.json").write_bytes(bytes(range(256)))
    record = blue()
    curves = record["curves"]
    assert isinstance(curves, list)
    releases = [c for c in curves if c["stroke"] == "release"]
    changes: dict[str, dict[str, object]] = {
        "version": {"version": 9},
        "pressless": {"curves": releases},
        "curveless": {"curves": []},
        "huge": {"travel_mm": 1e300, "actuation_mm": None, "reset_mm": None},
        "strong": {"curves": [{**c, "control_points_cN": [1e300] * 15} for c in curves]},
    }
    for name, change in changes.items():
        (tmp_path / f"{name}.fdvv.json").write_text(json.dumps({**record, **change}))
    (tmp_path / "cut.actuation.json").write_text('{"format": "fdvv-actuation", "version": 1, "meth')
    (tmp_path / "rig.toml").write_text("this is no toml\n")
    (tmp_path / "deep.toml").write_text(f"a = {'[' * 50_000}{']' * 50_000}\n")
    save_rig(RigModel(), tmp_path / "good.rig.json")
    return tmp_path


REFUSED = {
    "no such command": (("squeeze",), "'squeeze'"),
    "no argument": (("fit",), "'PATH'"),
    "a missing file": (("fit", "gone.csv"), "'gone.csv' does not exist"),
    "a built-in to fit": (("fit", "mx-blue"), "'mx-blue' does not exist"),
    "an empty file": (("fit", "empty.csv"), "empty.csv: whole file: it is empty"),
    "an empty folder": (("fit", "empty"), "empty: folder: no .csv"),
    "a force that no button has": (("fit", "pounds.csv"), "pounds.csv: press: the force reaches"),
    "a force that no button has, to import": (("import", "pounds.csv", *OUT), "check the units"),
    "a force that no button has, to show": (("show", "pounds.csv"), "fdvv fit --accept-implausible"),
    "a folder of nothing usable": (("fit", "refused"), "text.csv"),
    "a binary file": (("fit", "binary.csv"), "binary.csv: whole file: it is a binary file"),
    "a model to fit": (("fit", "good.fdvv.json"), "holds an FDVV model, not a measurement"),
    "an option for a file": (("fit", "-good.csv"), "'-g'"),
    "too few control points": (("fit", "good.csv", "--control-points", "3"), "not between 4 and 64"),
    "no number of control points": (("fit", "good.csv", "--control-points", "nan"), "'nan' is neither"),
    "an unknown method": (("fit", "good.csv", "--method", "magic"), "'magic' is not one of"),
    "nan to smooth with": (("fit", "good.csv", "--smoothing-mm", "nan"), "not a finite number"),
    "smoothing wider than any travel": (("fit", "good.csv", "--smoothing-mm", "1e30"), "0<=x<=5"),
    "nan as a bound": (("fit", "good.csv", "--max-rmse-cN", "nan"), "not a finite number"),
    "an output below a file": (("fit", "good.csv", "-o", "good.csv/m.fdvv.json"), "good.csv: output: is a"),
    "an output that is a folder": (("fit", "good.csv", "-o", "empty"), "empty: output: is a folder"),
    "an output without a name": (("fit", "good.csv", "-o", ""), "output: is a folder"),
    "the measurement as output": (("fit", "good.csv", "-o", "good.csv"), "end it in .fdvv.json"),
    "a file for a folder's models": (("fit", "refused", "-o", "good.csv"), "a folder is needed"),
    "an unknown button": (("show", "mx-blu"), "name a file or one of mx-black"),
    "a button without a name": (("show", ""), "no such file or built-in button"),
    "a missing model": (("show", "gone.fdvv.json"), "gone.fdvv.json: whole file: No such file"),
    "a truncated model": (("show", "cut.fdvv.json"), "cut.fdvv.json: end of file: not valid JSON"),
    "a binary model": (("show", "binary.fdvv.json"), "binary.fdvv.json: line 1, column 1"),
    "another version": (("show", "version.fdvv.json"), "$.version: file version 9"),
    "a model without curves": (("show", "curveless.fdvv.json"), "$.curves"),
    "a model without a press": (("show", "pressless.fdvv.json"), "it has no press"),
    "an absurd travel": (("show", "huge.fdvv.json"), "$: travel_mm must stay within 1000, got 1e+300"),
    "an absurd force": (("compare", "mx-red", "strong.fdvv.json"), "must stay within 1e+06"),
    "a speed of nan": (("show", "mx-blue", "--velocity", "nan"), "not a finite number"),
    "a speed of nothing": (("show", "mx-blue", "--velocity", "0"), "x>0"),
    "a figure of no kind": (("show", "mx-blue", "--figure", "x.txt"), "end it in .svg"),
    "a figure below a file": (("show", "mx-blue", "--figure", "good.csv/x.svg"), "output: is a file"),
    "a figure of a folder": (("show", "empty", "--figure", "x.svg"), "--figure draws one button"),
    "one button to compare": (("compare", "mx-blue"), "two or more buttons"),
    "an empty folder to compare": (("compare", "mx-blue", "empty"), "empty: folder"),
    "a merge without a name": (("merge", "mx-blue", *OUT), "'--name'"),
    "a merge of different travels": (("merge", "mx-blue@50", "mx-red@100", *MERGE), "pass --travel-mm"),
    "a merge of two presses": (
        ("merge", "mx-blue:press@50", "mx-red:press@50", *MERGE, "--travel-mm", "3", "--actuation-mm", "2",
         "--reset-mm", "1"), "pass --conflict"),
    "a merge with an unknown speed": (("merge", "mx-blue", "mx-blue@5", *MERGE), "mx-blue@VELOCITY"),
    "a merge at no speed": (("merge", "mx-blue@0", *MERGE), "'0' is not a speed above 0"),
    "a speed that is not there": (("merge", "mx-clear@5", *MERGE), "no curve of 5 mm/s"),
    "a misspelt button": (("show", "mxclear"), "did you mean mx-clear?"),
    "a merge of an absent stroke": (("merge", "pressless.fdvv.json:press", *MERGE), "no press curve"),
    "an absurd travel to merge": (("merge", "mx-blue", *MERGE, "--travel-mm", "1e300"), "0<x<=1000"),
    "a folder to merge": (("merge", "empty", *MERGE), "empty: argument: is a folder"),
    "two curves to assign": (("assign", "mx-blue", "mx-red", *ASSIGN), "add :press or :release"),
    "a segment that falls": (("assign", "mx-blue", "mx-red:press", *ASSIGN, "--segment", "2", "1"), "rise"),
    "a segment of nan": (("assign", "mx-blue", "mx-red:press", *ASSIGN, "--segment", "nan", "1"), "finite"),
    "an unknown device": (("compensate", "mx-blue", "--device", "serial"), "use one of twin"),
    "a missing rig": (("compensate", "mx-blue", "--rig", "gone.toml"), "'gone.toml' does not exist"),
    "a rig nested too deeply": (("compensate", "mx-blue", "--rig", "deep.toml"), "TOML that is nested"),
    "a device in place of a file": (("fit", "/dev/zero"), "/dev/zero: whole file: is a device or a pipe"),
    "a rig that is no TOML": (("compensate", "mx-blue", "--rig", "rig.toml"), "column 6: not valid TOML"),
    "a speed twice": (
        ("compensate", "mx-blue", "--velocity", "50", "--velocity", "50"), "must differ, got 50.0"),
    "the paper's presses for another method": (
        ("compensate", "mx-blue", "--presses", "3"), "--presses: option: belongs to the method paper"),
    "the paper's law printed by another method": (
        ("compensate", "mx-blue", "--literal"), "--literal: option: belongs to the method paper"),
    "no rounds of the paper's law": (
        ("compensate", "mx-blue", "--method", "paper", "--rounds", "0"), "belongs to the method rig-aware"),
    "a rig known to the paper's law": (
        ("compensate", "mx-blue", "--method", "paper", "--rig-known", "good.rig.json"), "--rig-known"),
    "a rig kept by the paper's law": (
        ("compensate", "mx-blue", "--method", "paper", "--save-rig", "x.rig.json"), "--save-rig: option"),
    "a rig that has taught nothing": (
        ("compensate", "mx-blue", "--rig-known", "good.rig.json"), "good.rig.json: $.learned: holds"),
    "a model as a rig": (("compensate", "mx-blue", "--rig-known", "good.fdvv.json"), "not an identified rig"),
    "a rig that is gone": (("compensate", "mx-blue", "--rig-known", "gone.rig.json"), "does not exist"),
    "a rig saved below a file": (
        ("compensate", "mx-blue", "--save-rig", "good.csv/x.rig.json"), "good.csv: output: is a file"),
    "a rig saved as text": (("compensate", "mx-blue", "--save-rig", "rig.txt"), "end it in .rig.json"),
    "actuation below a file": (
        ("compensate", "mx-blue", "-o", "good.csv/x.actuation.json"), "good.csv: output: is a file"),
    "a model as actuation": (("probe", "mx-blue", "good.fdvv.json"), "expected 'fdvv-actuation'"),
    "truncated actuation": (("probe", "mx-blue", "cut.actuation.json"), "cut.actuation.json: whole file"),
    "actuation as a button": (("compare", "cut.actuation.json", "mx-red"), "holds an actuation"),
    "a report below a file": (("demo", "-o", "good.csv/x"), "good.csv: output: is a file"),
}  # fmt: skip


@pytest.mark.parametrize("mistake", REFUSED)
def test_a_mistake_is_reported_in_one_line_with_status_2(fdvv: Run, bad: Path, mistake: str) -> None:
    command, message = REFUSED[mistake]
    before = {p: p.read_bytes() for p in bad.rglob("*") if p.is_file()}
    ran = fdvv(*command)
    *others, line = ran.err.splitlines()
    assert ran.status == 2
    assert line.startswith("fdvv: ")
    assert message in ran.err
    assert all(other.startswith(("warning: ", "refused: ")) for other in others)
    assert {p: p.read_bytes() for p in bad.rglob("*") if p.is_file()} == before


def test_every_file_a_person_names_wrongly_is_named_back(fdvv: Run, bad: Path) -> None:
    for path in sorted(p for p in bad.iterdir() if p.suffix == ".json" and p.name != "good.fdvv.json"):
        ran = fdvv("show", path.name)
        assert ran.status == 2
        assert path.name in ran.err


def test_a_bound_on_the_fit_decides_between_0_and_1(fdvv: Run, switch: Path) -> None:
    assert fdvv("fit", switch, "--max-rmse-cN", "0.2").status == 0
    missed = fdvv("fit", switch, "--max-rmse-cN", "0.001", "--json")
    assert missed.status == 1
    assert missed.json["name"] == "switch"
    assert "exceeds the bound of 0.001 cN" in missed.err
    assert missed.err.count("\n") == 1


def test_a_bound_on_a_folder_names_the_worst_file(fdvv: Run, folder: Path) -> None:
    assert fdvv("fit", folder, "--max-rmse-cN", "0.2").status == 0
    missed = fdvv("fit", folder, "--max-rmse-cN", "0.01", "--json")
    assert missed.status == 1
    worst = max(missed.json["results"], key=lambda r: max(s["rmse_cN"] for s in r["strokes"].values()))
    assert worst["file"] in missed.err


def test_a_bound_on_the_rendering_decides_between_0_and_1(fdvv: Run) -> None:
    probe = ("probe", "mx-blue", "--velocity", "100", "--presses", "1")
    assert fdvv(*probe, "--max-mean-error-cN", "1000").status == 0
    missed = fdvv(*probe, "--max-mean-error-cN", "0.01", "--json")
    assert missed.status == 1
    assert missed.json["simulated"] is True
    assert "exceeds the bound of 0.01 cN" in missed.err


def test_a_folder_of_which_some_files_are_refused_is_a_success(fdvv: Run, folder: Path) -> None:
    ran = fdvv("fit", folder)
    assert ran.status == 0
    assert ran.err.startswith("refused: ")


def test_a_leading_dash_is_a_file_after_two_dashes(fdvv: Run, tmp_path: Path) -> None:
    tactile_csv(tmp_path / "-dash.csv")
    assert fdvv("fit", "--json", "--", "-dash.csv").json["name"] == "-dash"
