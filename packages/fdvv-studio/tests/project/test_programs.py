"""A person's programs are kept whole, under safe names, and never overwritten by surprise."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import pytest

from fdvv.errors import InputError
from fdvv.program.file import program_to_json
from fdvv.program.library import load_shipped, programs
from fdvv_studio.project.programs import ProgramCatalog

BUTTON = program_to_json(load_shipped("button"))


@pytest.fixture
def shelf(tmp_path: Path) -> ProgramCatalog:
    return ProgramCatalog(tmp_path)


@pytest.mark.parametrize("recipe", programs(), ids=lambda r: r.name)
def test_a_shipped_program_is_copied_with_all_it_does(shelf: ProgramCatalog, recipe: object) -> None:
    name = recipe.name  # type: ignore[attr-defined]
    kept = shelf.copy(f"shipped:{name}", "mine")
    shipped = load_shipped(name)
    assert replace(shelf.program("own:mine"), name=shipped.name) == shipped
    assert shelf.open("own:mine") == kept


def test_who_opened_a_program_before_it_changed_does_not_overwrite_it(shelf: ProgramCatalog) -> None:
    first = shelf.save("own:one", BUTTON)
    changed = program_to_json(replace(load_shipped("button"), travel_mm=1.5))
    second = shelf.save("own:one", changed, first.revision)
    for revision, reason in ((first.revision, "changed elsewhere"), ("", "name is taken")):
        with pytest.raises(InputError, match=reason):
            shelf.save("own:one", BUTTON, revision)
        with pytest.raises(InputError, match=reason):
            shelf.delete("own:one", revision)
    assert shelf.open("own:one") == second


def test_of_many_savers_at_once_one_wins(shelf: ProgramCatalog) -> None:
    first = shelf.save("own:one", BUTTON)
    texts = [program_to_json(replace(load_shipped("button"), travel_mm=1.0 + i / 10)) for i in range(8)]

    def save(text: str) -> bool:
        try:
            shelf.save("own:one", text, first.revision)
        except InputError:
            return False
        return True

    with ThreadPoolExecutor(8) as pool:
        assert sum(pool.map(save, texts)) == 1
    assert shelf.open("own:one").text in texts


@pytest.mark.parametrize(
    "name",
    [
        *("", ".", "..", "../up", "a/b", "a\\b", ".hidden", "end.", "end ", " start"),
        *("x" * 41, "nul\0", "ü", "a\n"),
    ],
)
def test_a_name_that_could_leave_the_folder_is_refused(shelf: ProgramCatalog, name: str) -> None:
    with pytest.raises(InputError, match="no name for a file"):
        shelf.save(f"own:{name}", BUTTON)
    with pytest.raises(InputError, match="no such program"):
        shelf.open(f"own:{name}")
    assert not shelf.folder.exists()


def test_names_that_differ_in_case_only_do_not_live_side_by_side(shelf: ProgramCatalog) -> None:
    shelf.save("own:One", BUTTON)
    with pytest.raises(InputError, match="there is a program 'One'"):
        shelf.save("own:one", BUTTON)
    assert shelf.free_name("ONE") == "ONE 2"


def test_copies_without_a_name_find_one(shelf: ProgramCatalog) -> None:
    ids = [shelf.copy("shipped:button").program for _ in range(3)]
    assert ids == ["own:mx-red", "own:mx-red 2", "own:mx-red 3"]


def test_what_was_deleted_comes_back_under_a_free_name(shelf: ProgramCatalog) -> None:
    kept = shelf.save("own:one", BUTTON)
    thrown = shelf.delete("own:one", kept.revision)
    assert not [e for e in shelf.entries() if e.id.startswith("own:")]
    shelf.save("own:one", BUTTON)
    assert shelf.restore(thrown).program == "own:one 2"
    with pytest.raises(InputError, match="not in the trash"):
        shelf.restore(thrown)
    again = shelf.open("own:one")
    assert shelf.delete("own:one", again.revision) == "one~1"
    with pytest.raises(InputError, match="no longer there"):
        shelf.save("own:one", BUTTON, again.revision)
