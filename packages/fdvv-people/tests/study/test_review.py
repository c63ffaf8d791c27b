"""A study is looked at with the files it names."""

from __future__ import annotations

from pathlib import Path

import pytest
from msgspec import structs

from fdvv.errors import InputError
from fdvv.model.file import load_builtin, save_model
from fdvv_people.study.admin.preview import preview_dict, preview_html, preview_sections
from fdvv_people.study.admin.review import device_problems, review_study, twin_problems
from fdvv_people.study.plan.plan import Item, Staircase, Stimulus, StudyPlan
from fdvv_people.study.plan.plan_file import template_names, write_template
from tests.support.buttons import line_model

PREFERENCE = """
name = "two"
kind = "{kind}"
title.en = "Two"
pages = [{{ name = "consent", when = "consent", title.en = "Yes?" }}]
[[items]]
name = "Red"
stimuli = [
    {{ name = "one", button = "{one}", rendered = "FD" }},
    {{ name = "two", button = "{two}", rendered = "FDVV"{more} }},
]
[claim]
more = "two"
less = "one"
"""


def written(folder: Path, one: str, two: str, more: str = "", kind: str = "preference") -> Path:
    path = folder / "study.toml"
    path.write_text(PREFERENCE.format(one=one, two=two, more=more, kind=kind))
    return path


@pytest.mark.parametrize("name", template_names())
def test_a_shipped_study_can_be_run_and_its_renderings_differ(name: str, tmp_path: Path) -> None:
    look = review_study(write_template(name, tmp_path).parent)
    assert look.problems == look.notes == ()
    assert all(apart > 2.0 for apart in look.differences_cN.values())
    assert len(look.differences_cN) == (0 if name in ("staircase", "thresholds") else len(look.plan.items))


def test_fd_and_fdvv_of_a_model_with_one_speed_are_refused_as_the_same(tmp_path: Path) -> None:
    (problem,) = review_study(written(tmp_path, "mx-red", "mx-red")).problems
    assert problem == "items ('Red'): 'one' and 'two' feel the same: its model has one speed and no vibration"
    assert review_study(written(tmp_path, "mx-clear", "mx-clear")).problems == ()


def test_the_difference_is_that_of_the_force(tmp_path: Path) -> None:
    import numpy as np

    look = review_study(written(tmp_path, "mx-red", "mx-red", ", force_ratio = 1.1"))
    model = load_builtin("mx-red")
    x = np.arange(0.0, model.travel_mm, 0.05)
    force_cN = np.array([model.force_cN(x, 50.0, stroke) for stroke in ("press", "release")])
    assert look.differences_cN["Red"] == pytest.approx(0.1 * np.sqrt(np.mean(force_cN**2)), rel=1e-6)


def test_renderings_that_hardly_differ_are_remarked_on(tmp_path: Path) -> None:
    look = review_study(written(tmp_path, "mx-red", "mx-red", ", force_ratio = 1.005"))
    assert look.problems == ()
    assert any("differ by 0.2" in note for note in look.notes)


@pytest.mark.parametrize("place", ["own.fdvv.json", "buttons/own.fdvv.json"])
def test_a_model_beside_the_study_is_opened_and_one_that_cannot_be_is_reported(
    place: str, tmp_path: Path
) -> None:
    path = written(tmp_path, "mx-red", place)
    (missing,) = review_study(path).problems
    assert "no such file" in missing
    (tmp_path / "buttons").mkdir()
    save_model(load_builtin("mx-brown").renamed("own"), tmp_path / place)
    assert review_study(path).problems == ()
    (tmp_path / place).write_text("{}")
    (broken,) = review_study(path).problems
    assert "items ('Red')" in broken


def test_an_actuation_that_is_missing_is_reported(tmp_path: Path) -> None:
    path = written(tmp_path, "mx-red", "mx-brown", ', actuation = "learned.actuation.json"')
    (problem,) = review_study(path).problems
    assert "learned.actuation.json" in problem


def test_what_is_no_file_or_no_text_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="No such file"):
        review_study(tmp_path / "none.toml")
    (tmp_path / "study.toml").write_bytes(b"name = '\xff'")
    with pytest.raises(InputError, match="is not UTF-8"):
        review_study(tmp_path)


@pytest.mark.parametrize("name", template_names())
def test_a_preview_tells_everything_asked_and_nothing_drawn(name: str, tmp_path: Path) -> None:
    look = review_study(write_template(name, tmp_path))
    titles = [section.title for section in preview_sections(look)]
    assert titles[:6] == ["A person", "A trial", "Buttons", "Orders", "What will not count", "The claim"]
    html = preview_html(look)
    for item in look.plan.items:
        assert item.name in html
    for rating in look.plan.ratings:
        assert all(words in html for words in rating.question.values())
    assert preview_html(look) == html
    assert preview_dict(look)["plan"]["kind"] == name


def test_a_title_with_markup_stays_text(tmp_path: Path) -> None:
    path = write_template("abx", tmp_path)
    path.write_text(path.read_text().replace("Can you tell them apart?", "<script>alert(1)</script>"))
    assert "<script>" not in preview_html(review_study(path))


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
    assert device_problems(structs.replace(one, kind="2afc", staircase=None), tmp_path) == ()
