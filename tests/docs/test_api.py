"""The reference of the package tells everything that people may import."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.docs.pages import API
from tools import api_docstrings, api_signatures, make_api_reference
from tools.api_reading import EVERYWHERE, WORDS, Part, Thing, rooms, things

ANEW = f"run {make_api_reference.COMMAND}"


def everything() -> list[tuple[str, Thing]]:
    """Give every public name and every method, with what it is called in a message."""
    found = [(f"{room}.{thing.name}", thing) for room in rooms() for thing in things(room)]
    methods = [(f"{name}.{method.name}", method) for name, thing in found for method in thing.methods]
    return found + methods


def test_every_public_name_has_a_docstring() -> None:
    bare = [name for name, thing in everything() if thing.said is None]
    assert bare == [], (
        f"write a docstring for each: a sentence in the imperative, then meaning, shapes, units, errors; "
        f'below a constant a """sentence.""": {bare}'
    )


def test_every_parameter_field_and_member_is_told() -> None:
    silent = [f"{name}: {part.name}" for name, thing in everything() for part in thing.parts if not part.told]
    assert silent == [], (
        f"{len(silent)} are not told: write `name : what it is` into the docstring of each, or, if the name "
        f"means the same everywhere in its room, into tools/api_words.toml: {silent}"
    )


def test_the_pages_are_those_of_the_code() -> None:
    made = make_api_reference.pages()
    assert {path.name for path in API.glob("*.md")} == set(made), ANEW
    stale = [name for name, text in made.items() if (API / name).read_text(encoding="utf-8") != text]
    assert stale == [], f"{ANEW}: {stale}"


def test_words_are_told_for_rooms_that_there_are_and_names_that_they_use() -> None:
    used: dict[str, set[str]] = {EVERYWHERE: set()}
    for _, thing in everything():
        used.setdefault(thing.room, set()).update(part.name for part in thing.parts)
    used[EVERYWHERE] = set().union(*used.values())
    # records of files and messages of the studio use words too
    from tools.make_record_reference import FILES, messages, thing_of
    from tools.record_types import reached

    for record in [*messages(), *(r for kind in FILES for r in reached(kind.classes))]:
        thing = thing_of(record)
        used.setdefault(thing.room, set()).update(part.name for part in thing.parts)
        used[EVERYWHERE].update(part.name for part in thing.parts)
    idle = {room: sorted(set(told) - used.get(room, set())) for room, told in WORDS.items()}
    assert {room: names for room, names in idle.items() if names} == {}, (
        "take them out of tools/api_words.toml"
    )


def test_a_docstring_is_split_into_text_and_entries() -> None:
    said, entries = api_docstrings.read(
        "Fit a curve.\n\nx_mm, y : places and values; size : how many,\nat least 4. Then something else.\n\n"
        "    a = b + c\n\nAttributes\n----------\nkept : whether it\n    was kept.\nother : no parameter.",
        ("x_mm", "y", "size", "kept"),
    )
    assert said is not None
    assert entries["x_mm"] == entries["y"] == "places and values"
    assert entries["size"].startswith("how many, at least 4")
    assert entries["kept"] == "whether it was kept"
    assert said.head == "Fit a curve."
    assert "    a = b + c" in said.body
    assert "other : no parameter." in said.body


@pytest.mark.parametrize(
    ("name", "unit"),
    [
        ("travel_mm", "mm"),
        ("velocity_mm_s", "mm/s"),
        ("stiffness_N_m", "N/m"),
        ("amplitude_m_s2", "m/s²"),
        ("bump_kept_ratio", "1"),
        ("commanded_cN64", "1/64 cN"),
        ("name", ""),
        ("s", ""),
    ],
)
def test_the_unit_is_the_last_part_of_a_name(name: str, unit: str) -> None:
    assert api_signatures.unit_of(name) == unit
    assert Part(name, "float", "", "", True).unit == unit


def test_a_signature_is_told_as_the_source_has_it() -> None:
    def fit(x_mm: list[float], *, size: int = 15, path: Path | None = None) -> bool:
        return bool(x_mm and size and path)

    shown = api_signatures.call(fit, api_signatures.returned(fit))
    assert shown == "(x_mm: list[float], *, size: int = 15, path: Path | None = None) -> bool"
