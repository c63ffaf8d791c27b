"""What is stated of a button: a table before a name, a name before a make."""

from __future__ import annotations

from pathlib import Path

import pytest

from fdvv_studio.library.stated import find_type


@pytest.mark.parametrize(
    ("name", "folder", "expected"),
    [
        ("Cherry MX Blue", "", "clicky by its maker"),
        ("MX2A RGB Brown", "", "tactile by its maker"),
        ("Kalih Box Jade 2", "", "clicky by its maker"),
        ("NiZ Black 65g", "", "dome by its maker"),
        ("Topre_45g", "", "dome by its name"),
        ("My button", "mine/silent_linear", "linear by its name"),
        ("Cherry MX Blue", "tactile", "tactile by its name"),
    ],
)
def test_a_name_or_a_make_states_a_type(name: str, folder: str, expected: str) -> None:
    assert str(find_type(name, folder)) == expected


@pytest.mark.parametrize(
    ("name", "folder"),
    [
        ("My button", ""),
        ("linear or tactile", ""),
        ("Cherry MX Clear stem in Cherry MX Hyperglide Blue Bottom", ""),
        ("Cherry MX Blue", "linear and tactile"),
    ],
)
def test_what_is_unknown_or_contradicts_itself_states_nothing(name: str, folder: str) -> None:
    assert find_type(name, folder) is None


def test_a_table_beside_the_file_or_above_it_comes_first(tmp_path: Path) -> None:
    path = tmp_path / "curves" / "Cherry MX Blue.downstroke.csv"
    path.parent.mkdir()
    (tmp_path / "switchmeta.csv").write_text('cherry mx blue,tactile\n"odd, one",special\n')
    assert str(find_type("Cherry MX Blue", "", path)) == "tactile by switchmeta.csv"
    (path.parent / "types.csv").write_text("name,type\nCherry MX Blue,linear\n")
    assert str(find_type("Cherry MX Blue", "", path)) == "linear by types.csv"
    (path.parent / "types.csv").write_bytes(b"\xff\x00broken")
    assert str(find_type("Cherry MX Blue", "", path)) == "tactile by switchmeta.csv"


@pytest.mark.shared
def test_makes_agree_with_what_a_measurer_states(shared_data: Path) -> None:
    lines = (shared_data / "tg-strokes" / "switchmeta.csv").read_text().splitlines()
    measurer = dict(line.rsplit(",", 1) for line in lines if "," in line)
    makes = {name: find_type(name) for name in measurer}
    known = {name: one.type for name, one in makes.items() if one and one.by == "its maker"}
    assert len(known) >= 15
    assert [name for name, kind in known.items() if kind != measurer[name]] == []
