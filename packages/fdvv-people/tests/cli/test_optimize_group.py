"""fdvv optimize group: the button of several people, from their runs."""

from __future__ import annotations

from pathlib import Path

from fdvv.model.file import load_model
from fdvv_people.cli.optimize.group import group
from fdvv_people.cli.optimize.optimize import run
from fdvv_people.optimize.group.playoff import BLOCKS
from fdvv_people.optimize.people.groups import GROUPS
from fdvv_people.optimize.run.setup import WISHES
from tests.cli.test_optimize import run_optimize
from tests.support.command_line import Run


def test_two_runs_end_with_a_button_a_page_and_a_sentence(fdvv: Run, tmp_path: Path) -> None:
    for person in "12":
        ran = run_optimize(fdvv, f"p{person}", "--person", person, "--retest", "0", "--group", "diverse")
        assert ran.status == 0, ran.err
    ran = fdvv("optimize", "group", "p1", "p2", "--folder", "all", "--blocks", "2")
    assert ran.status == 0, ran.err
    assert ran.out.startswith("temporal-pointing, easy (simulated), 2 runs\n")
    assert "the group's button: x1_mm" in ran.out
    assert ", 2 people, simulated" in " ".join(ran.out.split())
    assert "\nnext: " in ran.out
    folder = tmp_path / "all"
    assert sorted(path.name for path in folder.iterdir()) == ["group.fdvv.json", "group.json", "report.html"]
    assert load_model(folder / "group.fdvv.json").actuation_mm is not None
    found = fdvv("optimize", "group", "p1", "p2", "--folder", "expected", "--blocks", "0", "--json").json
    assert found["played"] is None
    assert "expected from the runs, not yet played" in found["verdict"]


def test_wrong_runs_are_refused_in_one_line_and_nothing_is_written(fdvv: Run, tmp_path: Path) -> None:
    run_optimize(fdvv, "p1")
    ran = fdvv("optimize", "group", "p1", "p1", "--folder", "all")
    assert ran.status != 0
    assert "comes twice" in ran.err
    assert not (tmp_path / "all").exists()


def test_words_and_numbers_of_options_are_those_of_what_they_set() -> None:
    options = {option.name: option.to_info_dict() for option in (*run.params, *group.params)}
    assert tuple(options["also"]["type"]["choices"]) == WISHES
    assert set(options["group"]["type"]["choices"]) == set(GROUPS)
    assert options["blocks"]["default"] == BLOCKS
