"""Reading a study: what is refused, and that one line tells where and why."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.errors import InputError
from fdvv.model.file import load_model
from fdvv_people.study.plan.plan_file import (
    check_plan,
    read_plan_text,
    template_buttons,
    template_names,
    template_text,
    write_template,
)

SMALL = """
name = "small"
kind = "preference"
title.en = "Small"
[[items]]
name = "Red"
stimuli = [{ name = "one", button = "mx-red" }, { name = "two", button = "mx-brown" }]
"""


def test_the_shipped_realism_study_is_the_papers() -> None:
    plan = read_plan_text(template_text("realism"), "realism")
    assert len(plan.items) * plan.rounds == 36
    assert [s.name for s in plan.items[0].stimuli] == ["FD", "FDVV"]
    assert (plan.people, plan.break_every_min, plan.break_min, plan.ties) == (12, 20, 3, True)
    assert [(r.name, r.points) for r in plan.ratings] == [("realism", 7)]


@pytest.mark.parametrize(
    ("change", "place", "said"),
    [
        (("kind =", "kind"), "line 3", "not valid TOML"),
        (('name = "small"\n', ""), "whole file", "missing required field `name`"),
        (('"preference"', '"taste"'), "kind", "'taste' is no task"),
        (('title.en = "Small"', 'title = "Small"'), "title", "by language, as title.en"),
        (('button = "mx-brown"', "button = 7"), "items[1] ('Red'), stimuli[2] ('two'), button", "got `int`"),
        (('"mx-red" }', '"mx-red", renderd = "FD" }'), "stimuli[1] ('one')", "did you mean rendered?"),
        (("[[items]]", "round = 3\n[[items]]"), "whole file", "did you mean rounds?"),
        (("[[items]]", "zzz = 3\n[[items]]"), "whole file", "use one of format, version"),
        (("[[items]]", "rounds = 0\n[[items]]"), "rounds", ">= 1"),
        (("[[items]]", "rounds = 2.5\n[[items]]"), "rounds", "Expected `int`"),
        (("[[items]]", 'format = "fdvv-model"\n[[items]]'), "format", "is not a study"),
        (("[[items]]", "version = 2\n[[items]]"), "version", "reads version 1"),
        (("[[items]]", "[items]"), "items", "Expected a list"),
    ],
)
def test_a_mistake_is_one_line_that_names_its_place(change: tuple[str, str], place: str, said: str) -> None:
    assert change[0] in SMALL
    with pytest.raises(InputError) as refused:
        read_plan_text(SMALL.replace(*change), "small.toml")
    message = str(refused.value)
    assert message.startswith("small.toml: ")
    assert "\n" not in message
    assert place in refused.value.place
    assert said in message


def test_a_mark_of_byte_order_is_no_mistake() -> None:
    assert read_plan_text("\ufeff" + SMALL, "small.toml") == read_plan_text(SMALL, "small.toml")


def test_all_problems_are_listed_in_the_line_of_a_refusal() -> None:
    wrong = SMALL.replace('button = "mx-red"', 'button = "mx-pink"').replace("title.en", "title.de")
    with pytest.raises(InputError) as refused:
        check_plan(read_plan_text(wrong, "small.toml"), "small.toml")
    assert "there is no text in 'en'" in str(refused.value)
    assert "and 2 more" in str(refused.value)
    assert "mx-pink" in str(refused.value)


@settings(max_examples=30)
@given(st.text(max_size=200))
def test_any_text_is_read_or_refused_in_one_line(text: str) -> None:
    message = [refusal(tried) for tried in (text, SMALL + text)]
    assert all("\n" not in line for line in message)


def refusal(text: str) -> str:
    try:
        read_plan_text(text, "any")
    except InputError as error:
        return str(error)
    return ""


def test_a_file_without_end_is_refused() -> None:
    with pytest.raises(InputError, match="longer than"):
        read_plan_text("#" * 1_000_001, "long")
    with pytest.raises(InputError):
        read_plan_text("a = " + "[" * 20_000, "deep")


@pytest.mark.parametrize("name", template_names())
def test_a_shipped_study_is_written_with_all_files_it_names(name: str, tmp_path: Path) -> None:
    path = write_template(name, tmp_path / "study")
    assert path.read_text() == template_text(name)
    for button in template_buttons(name):
        model = load_model(path.parent / button)
        assert model.provenance.simulated
        assert "simulated" in model.provenance.source
        assert model.provenance.licence
        assert len(model.curves) == 10


def test_nothing_is_written_over(tmp_path: Path) -> None:
    path = write_template("realism", tmp_path)
    with pytest.raises(InputError, match="is there already"):
        write_template("abx", tmp_path)
    path.unlink()
    with pytest.raises(InputError, match="is there already"):
        write_template("realism", tmp_path)
    assert not path.exists()


@pytest.mark.parametrize(
    ("asked", "called"),
    [
        ("pilot", "pilot"),
        ('a "b" \\ c', 'a "b" \\ c'),
        ("x" * 80, "x" * 60),
        ("\n", "abx"),
        ("δοκιμή", "δοκιμή"),
    ],
)
def test_it_is_called_as_its_maker_says(asked: str, called: str, tmp_path: Path) -> None:
    path = write_template("abx", tmp_path, asked)
    plan = read_plan_text(path.read_text(), path)
    assert plan.name == called
    assert [item.name for item in plan.items] == ["MX Clear", "Rubber dome"]


def test_unknown_names_are_refused_with_those_there_are() -> None:
    with pytest.raises(InputError, match="use one of: 2ac, 2afc, abx"):
        template_text("taste")
