"""Shipped studies as folders, and the simulated buttons they bring."""

from __future__ import annotations

from pathlib import Path

import pytest

from fdvv.errors import InputError
from fdvv.model import load_model
from fdvv.study import read_plan_text, template_buttons, template_names, template_text, write_template


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
