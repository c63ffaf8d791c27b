"""What cannot be rendered is told before the first person, item by item, in one line each."""

from __future__ import annotations

from pathlib import Path

import pytest
from msgspec import structs
from tests.workflow.conftest import line_model

from fdvv.model import save_model
from fdvv.study import Item, Staircase, Stimulus, StudyPlan
from fdvv.workflow import device_problems, twin_problems


def plan(*items: Item) -> StudyPlan:
    return StudyPlan(name="s", title={"en": "S"}, kind="realism", items=items)


def item(button: str, actuation: str = "") -> Item:
    fd = Stimulus(name="FD", button=button, rendered="FD")
    return Item(name=button, stimuli=(fd, Stimulus(name="FDVV", button=button, actuation=actuation)))


def test_every_shipped_button_is_rendered_by_the_twin_and_fits_a_device_in_both_renderings() -> None:
    names = ("mx-black", "mx-blue", "mx-brown", "mx-clear", "mx-red", "rubber-dome")
    whole = plan(*(item(name) for name in names))
    assert twin_problems(whole, Path()) == ()
    assert device_problems(whole, Path()) == ()


@pytest.mark.parametrize("problems", [twin_problems, device_problems])
def test_a_file_that_is_not_there_is_named_with_its_item(problems: object, tmp_path: Path) -> None:
    assert callable(problems)
    found = problems(plan(item("mx-red"), item("mx-blue", actuation="gone.actuation.json")), tmp_path)
    assert len(found) == 1
    assert "'mx-blue'" in found[0]
    assert "gone.actuation.json" in found[0]
    assert "\n" not in found[0]


def test_a_reference_of_another_travel_is_no_problem_of_the_twin_and_one_of_a_device() -> None:
    reference = Stimulus(name="real", button="rubber-dome")
    one = Item(name="clear", stimuli=item("mx-clear").stimuli, reference=reference)
    assert twin_problems(plan(one), Path()) == ()
    assert "travels differ" in device_problems(plan(one), Path())[0]


def test_a_staircase_is_judged_at_the_strongest_comparison_that_it_may_come_to(tmp_path: Path) -> None:
    strong = line_model("strong", 200.0, travel_mm=3.0)
    save_model(strong, tmp_path / "strong.fdvv.json")
    standard = Stimulus(name="standard", button="strong.fdvv.json", rendered="FD")
    stimuli = (standard, structs.replace(standard, name="comparison"))
    one = StudyPlan(
        name="s",
        title={"en": "S"},
        kind="staircase",
        items=(Item(name="b", stimuli=stimuli),),
        staircase=Staircase(),
    )
    assert "440" in device_problems(one, tmp_path)[0]
    assert device_problems(structs.replace(one, kind="2afc"), tmp_path) == ()
