"""A person's programs are kept whole, under safe names, and never overwritten by surprise."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import pytest

from fdvv.errors import InputError
from fdvv.program.file import program_from_json, program_to_json
from fdvv.program.library import load_shipped, programs
from fdvv_studio.project.programs import ProgramCatalog

BUTTON = program_to_json(load_shipped("button"))


@pytest.fixture
def shelf(tmp_path: Path) -> ProgramCatalog:
    return ProgramCatalog(tmp_path)


def test_a_new_project_lists_the_shipped_programs(shelf: ProgramCatalog) -> None:
    entries = shelf.entries()
    assert [e.id for e in entries] == [f"shipped:{r.name}" for r in programs()]
    assert all(e.summary and e.states and not e.problem for e in entries)
    assert not shelf.folder.exists()


@pytest.mark.parametrize("recipe", programs(), ids=lambda r: r.name)
def test_a_shipped_program_is_copied_with_all_it_does(shelf: ProgramCatalog, recipe: object) -> None:
    name = recipe.name  # type: ignore[attr-defined]
    kept = shelf.copy(f"shipped:{name}", "mine")
    shipped = load_shipped(name)
    assert replace(shelf.program("own:mine"), name=shipped.name) == shipped
    assert shelf.open("own:mine") == kept


def test_a_saved_program_is_there_for_the_next_shelf(shelf: ProgramCatalog, tmp_path: Path) -> None:
    first = shelf.save("own:one", BUTTON)
    changed = program_to_json(replace(load_shipped("button"), travel_mm=1.5))
    second = shelf.save("own:one", changed, first.revision)
    assert second.revision != first.revision
    assert ProgramCatalog(tmp_path).open("own:one") == second
    assert program_from_json(second.text).travel_mm == 1.5


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
        "",
        ".",
        "..",
        "../up",
        "a/b",
        "a\\b",
        ".hidden",
        "end.",
        "end ",
        " start",
        "x" * 41,
        "nul\0",
        "ü",
        "a\n",
    ],
)
def test_a_name_that_could_leave_the_folder_is_refused(shelf: ProgramCatalog, name: str) -> None:
    with pytest.raises(InputError, match="no name for a file"):
        shelf.save(f"own:{name}", BUTTON)
    with pytest.raises(InputError, match="no such program"):
        shelf.open(f"own:{name}")
    assert not shelf.folder.exists()


@pytest.mark.parametrize("program_id", ["shipped:nothing", "own:nothing", "nothing", "", "builtin:mx-red"])
def test_an_unknown_id_is_one_line(shelf: ProgramCatalog, program_id: str) -> None:
    with pytest.raises(InputError):
        shelf.open(program_id)


def test_names_that_differ_in_case_only_do_not_live_side_by_side(shelf: ProgramCatalog) -> None:
    shelf.save("own:One", BUTTON)
    with pytest.raises(InputError, match="there is a program 'One'"):
        shelf.save("own:one", BUTTON)
    assert shelf.free_name("ONE") == "ONE 2"


def test_shipped_programs_stay_as_they_are(shelf: ProgramCatalog) -> None:
    with pytest.raises(InputError, match="copy it first"):
        shelf.save("shipped:button", BUTTON)
    with pytest.raises(InputError, match="copy it first"):
        shelf.delete("shipped:button", "")


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


def test_a_broken_file_is_listed_with_what_is_wrong(shelf: ProgramCatalog) -> None:
    kept = shelf.save("own:good", BUTTON)
    (shelf.folder / "bad.fdvv-program.json").write_text(kept.text.replace('"travel_mm"', '"travel"'))
    (shelf.folder / ".half.fdvv-program.json").write_text("{")
    own = {e.id: e for e in shelf.entries() if e.id.startswith("own:")}
    assert list(own) == ["own:bad", "own:good"]
    assert "travel" in own["own:bad"].problem
    assert own["own:good"].problem == ""


def test_a_file_beyond_all_measure_is_refused(shelf: ProgramCatalog) -> None:
    with pytest.raises(InputError, match="at most 2 MB"):
        shelf.save("own:large", BUTTON + " " * 2_000_000)
    assert not shelf.folder.exists()
