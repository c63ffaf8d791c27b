"""A person's own buttons: edited, kept, never lost."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from threading import Thread

import pytest

from fdvv.errors import InputError, ModelError
from fdvv.model.file import load_builtin, load_model, save_model
from fdvv.model.model import FDVVModel
from fdvv_studio.project.documents import MOST_OPEN, ChangeConflict, ChangeSaved, DocumentStore
from fdvv_studio.project.history import EditMade, PinMade, RedoMade, UndoMade, UnpinMade
from fdvv_studio.project.patch import patch_between, record_of

CLEAR = load_builtin("mx-clear")


@pytest.fixture
def drafts(tmp_path: Path) -> Iterator[DocumentStore]:
    made = DocumentStore(tmp_path / "project")
    yield made
    made.close()


def edit(
    drafts: DocumentStore, name: str, change: dict[str, object], joins: bool = False
) -> ChangeSaved | ChangeConflict:
    """Edit the newest revision of a button."""
    return drafts.change(name, drafts.open(name).revision, made(drafts, name, change, joins=joins))


def made(
    drafts: DocumentStore, name: str, change: dict[str, object], change_id: str = "", joins: bool = False
) -> EditMade:
    record = drafts.open(name).history.record
    patch = patch_between(record, {**record, **change})
    return EditMade(change_id or f"edit-{os.urandom(4).hex()}", "set something", patch, joins, 1.5)


def model_path(drafts: DocumentStore, name: str) -> Path:
    return drafts.project / "buttons" / f"{name}.fdvv.json"


def on_file(drafts: DocumentStore, name: str) -> FDVVModel:
    return load_model(model_path(drafts, name))


def reopened(drafts: DocumentStore) -> DocumentStore:
    drafts.close()
    return DocumentStore(drafts.project)


def test_a_created_button_is_a_model_file_under_its_name(drafts: DocumentStore) -> None:
    assert drafts.create("My button", CLEAR) == "My button"
    assert on_file(drafts, "My button") == CLEAR.renamed("My button")
    [file] = drafts.list()
    assert (file.name, drafts.open("My button").revision) == ("My button", 0)


def test_an_edit_is_on_file_and_in_the_history_after_a_restart(drafts: DocumentStore) -> None:
    drafts.create("a", CLEAR)
    assert edit(drafts, "a", {"travel_mm": 3.5}) == ChangeSaved(1)
    assert edit(drafts, "a", {"reset_mm": None}) == ChangeSaved(2)
    before = drafts.open("a")
    drafts = reopened(drafts)
    assert drafts.open("a") == before
    assert (on_file(drafts, "a").travel_mm, on_file(drafts, "a").reset_mm) == (3.5, None)
    assert [step.label for step in before.history.steps] == ["set something"] * 2
    drafts.close()


def test_undo_and_redo_survive_a_restart(drafts: DocumentStore) -> None:
    drafts.create("a", CLEAR)
    for travel_mm in (3.9, 3.8, 3.7):
        edit(drafts, "a", {"travel_mm": travel_mm})
    assert drafts.change("a", 3, UndoMade("u", 2)) == ChangeSaved(4)
    drafts = reopened(drafts)
    assert on_file(drafts, "a").travel_mm == 3.9
    assert drafts.change("a", 4, RedoMade("r", 1)) == ChangeSaved(5)
    assert on_file(drafts, "a").travel_mm == 3.8
    state = drafts.open("a")
    assert (state.history.done, len(state.history.steps)) == (2, 3)
    edit(drafts, "a", {"travel_mm": 3.0})
    assert len(drafts.open("a").history.steps) == 3
    with pytest.raises(InputError, match="there are 0 steps to redo, not 1"):
        drafts.change("a", 6, RedoMade("r2", 1))
    with pytest.raises(InputError, match="there are 3 steps to undo, not 4"):
        drafts.change("a", 6, UndoMade("u2", 4))
    drafts.close()


def test_edits_that_join_are_one_step(drafts: DocumentStore) -> None:
    drafts.create("a", CLEAR)
    edit(drafts, "a", {"travel_mm": 3.9})
    edit(drafts, "a", {"travel_mm": 3.8}, joins=True)
    assert len(drafts.open("a").history.steps) == 1
    drafts.change("a", 2, UndoMade("u", 1))
    assert drafts.open("a").history.record == drafts.open("a").history.opening


def test_a_change_that_is_sent_again_is_not_made_twice(drafts: DocumentStore) -> None:
    drafts.create("a", CLEAR)
    change = made(drafts, "a", {"travel_mm": 3.5}, "once")
    assert drafts.change("a", 0, change) == ChangeSaved(1)
    edit(drafts, "a", {"reset_mm": 1.0})
    assert drafts.change("a", 0, change) == ChangeSaved(1)
    drafts = reopened(drafts)
    assert drafts.change("a", 0, change) == ChangeSaved(1)
    assert drafts.open("a").revision == 2
    drafts.close()


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"travel_mm": 1.0}, r"actuation_mm must lie within the travel of 1\.0 mm"),
        ({"travel_mm": "wide"}, "Expected `float`"),
        ({"curves": []}, r"at least one curve|of length >= 1"),
        ({"interpolation": "spline"}, "Invalid enum value 'spline'"),
    ],
)
def test_an_edit_that_would_break_the_model_is_refused_in_one_line(
    drafts: DocumentStore, change: dict[str, object], reason: str
) -> None:
    drafts.create("a", CLEAR)
    before = drafts.open("a")
    with pytest.raises((InputError, ModelError), match=reason) as error:
        edit(drafts, "a", change)
    assert "\n" not in str(error.value)
    assert drafts.open("a") == before
    assert on_file(drafts, "a") == CLEAR.renamed("a")
    assert edit(drafts, "a", {"travel_mm": 3.5}) == ChangeSaved(1)


def test_a_patch_of_another_model_is_refused(drafts: DocumentStore) -> None:
    drafts.create("a", CLEAR)
    red = record_of(load_builtin("mx-red"))
    patch = patch_between(red, {**red, "travel_mm": 3.5, "name": "b"})
    with pytest.raises(ModelError, match="the edit does not fit the model: its name is another"):
        drafts.change("a", 0, EditMade("x", "wrong", patch, False, 0.0))


def test_a_pin_keeps_the_state_it_was_made_in(drafts: DocumentStore) -> None:
    drafts.create("a", CLEAR)
    edit(drafts, "a", {"travel_mm": 3.5})
    drafts.change("a", 1, PinMade("p", "softer"))
    edit(drafts, "a", {"travel_mm": 3.2})
    drafts = reopened(drafts)
    [pin] = drafts.open("a").history.pins
    assert (pin.label, pin.model["travel_mm"]) == ("softer", 3.5)
    drafts.change("a", 3, UnpinMade("q", 0))
    assert drafts.open("a").history.pins == ()
    with pytest.raises(InputError, match="there is no pin 1"):
        drafts.change("a", 4, UnpinMade("q2", 0))
    drafts.close()


def test_a_model_file_put_there_by_hand_is_a_button(drafts: DocumentStore) -> None:
    path = drafts.project / "buttons" / "found.fdvv.json"
    save_model(CLEAR, path)
    text = path.read_text()
    assert [file.name for file in drafts.list()] == ["found"]
    assert drafts.open("found").history.record == record_of(CLEAR)
    assert path.read_text() == text
    assert edit(drafts, "found", {"travel_mm": 3.5}) == ChangeSaved(1)


@pytest.mark.parametrize("at_work", [True, False], ids=["while it is open", "while it is closed"])
def test_a_model_file_changed_by_hand_becomes_an_edit(drafts: DocumentStore, at_work: bool) -> None:
    drafts.create("a", CLEAR)
    edit(drafts, "a", {"travel_mm": 3.5})
    stale = made(drafts, "a", {"travel_mm": 3.2})
    if not at_work:
        drafts.close()
    save_model(replace(on_file(drafts, "a"), actuation_mm=1.0), model_path(drafts, "a"))
    assert isinstance(drafts.change("a", 1, stale), ChangeConflict)
    state = drafts.open("a")
    assert (state.revision, state.history.steps[-1].label) == (2, "changed outside")
    assert (state.history.record["actuation_mm"], state.history.record["travel_mm"]) == (1.0, 3.5)
    drafts.change("a", 2, UndoMade("u", 1))
    assert on_file(drafts, "a").actuation_mm == CLEAR.actuation_mm


def test_an_earlier_state_put_back_by_hand_is_an_edit_too(drafts: DocumentStore) -> None:
    drafts.create("a", CLEAR)
    old = model_path(drafts, "a").read_text()
    edit(drafts, "a", {"travel_mm": 3.5})
    drafts.close()
    model_path(drafts, "a").write_text(old)
    draft = drafts.project / "drafts" / "a.draft.jsonl"
    os.utime(draft, ns=(0, model_path(drafts, "a").stat().st_mtime_ns - 1))
    assert drafts.open("a").history.record["travel_mm"] == CLEAR.travel_mm
    assert drafts.open("a").revision == 2


def test_a_model_file_that_a_killed_process_left_behind_is_mended(drafts: DocumentStore) -> None:
    drafts.create("a", CLEAR)
    old, path = model_path(drafts, "a").read_text(), model_path(drafts, "a")
    edit(drafts, "a", {"travel_mm": 3.5})
    drafts.close()
    path.write_text(old)
    draft = drafts.project / "drafts" / "a.draft.jsonl"
    os.utime(path, ns=(0, draft.stat().st_mtime_ns - 1))
    assert drafts.open("a").revision == 1
    assert on_file(drafts, "a").travel_mm == 3.5


@pytest.mark.parametrize("damage", ["gone", "broken"])
def test_a_model_file_that_is_gone_or_broken_is_made_again_and_a_broken_one_kept(
    drafts: DocumentStore, damage: str
) -> None:
    drafts.create("a", CLEAR)
    edit(drafts, "a", {"travel_mm": 3.5})
    drafts.close()
    path = model_path(drafts, "a")
    if damage == "gone":
        path.unlink()
    else:
        path.write_text("{")
    assert drafts.open("a").revision == 1
    assert load_model(path).travel_mm == 3.5
    kept = list((drafts.project / "trash").rglob("*.fdvv.json"))
    assert [p.read_text() for p in kept] == (["{"] if damage == "broken" else [])


def test_a_draft_that_is_damaged_before_its_end_is_refused_in_one_line(drafts: DocumentStore) -> None:
    drafts.create("a", CLEAR)
    edit(drafts, "a", {"travel_mm": 3.5})
    drafts.close()
    draft = drafts.project / "drafts" / "a.draft.jsonl"
    lines = draft.read_bytes().splitlines(keepends=True)
    draft.write_bytes(lines[0].replace(b"travel", b"trovel", 1) + lines[1])
    with pytest.raises(InputError, match=r"line 1: the record is damaged; move the journal away"):
        drafts.open("a")
    draft.unlink()
    assert drafts.open("a").history.record["travel_mm"] == 3.5


def test_a_renamed_button_keeps_its_history(drafts: DocumentStore) -> None:
    drafts.create("a", CLEAR)
    edit(drafts, "a", {"travel_mm": 3.5})
    assert drafts.rename("a", "A") == "A"
    state = drafts.open("A")
    assert [step.label for step in state.history.steps] == ["set something", "rename to A"]
    assert on_file(drafts, "A").name == "A"
    assert [file.name for file in drafts.list()] == ["A"]
    with pytest.raises(InputError, match="no such button of your own"):
        drafts.open("a")


def test_a_deleted_button_is_in_the_trash_with_its_history(drafts: DocumentStore) -> None:
    drafts.create("a", CLEAR)
    edit(drafts, "a", {"travel_mm": 3.5})
    drafts.delete("a")
    assert drafts.list() == []
    kept = sorted(path.name for path in (drafts.project / "trash").rglob("*.*") if path.is_file())
    assert kept == ["a.draft.jsonl", "a.fdvv.json"]
    drafts.create("a", CLEAR)
    assert drafts.open("a").revision == 0
    drafts.delete("a")
    assert len(list((drafts.project / "trash").iterdir())) == 2


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("", "is empty"),
        ("x" * 61, "is longer than 60 characters"),
        (".hidden", "must begin with a letter or digit"),
        ("../up", "must begin with a letter or digit"),
        ("a/b", "have only letters, digits, spaces"),
        ("a\0b", "have only letters, digits, spaces"),
        ("a\nb", "have only letters, digits, spaces"),
        ("a:b", "have only letters, digits, spaces"),
        ("_a", "must begin with a letter or digit"),
        (" a", "must begin with a letter or digit"),
        ("a ", "must not end with a space or a point"),
        ("a.", "must not end with a space or a point"),
        ("NUL", "is reserved by an operating system"),
        ("𠀀" * 51, "is longer than 200 bytes"),
        ("com1.x", "is reserved by an operating system"),
        ("TAKEN", "there is a button 'taken' already"),
    ],
)
def test_a_name_that_is_no_safe_file_name_is_refused(drafts: DocumentStore, name: str, reason: str) -> None:
    drafts.create("taken", CLEAR)
    drafts.create("other", CLEAR)
    with pytest.raises(InputError, match=reason) as error:
        drafts.create(name, CLEAR)
    assert "\n" not in str(error.value)
    with pytest.raises(InputError, match=reason):
        drafts.rename("other", name)
    assert {file.name for file in drafts.list()} == {"taken", "other"}
    assert sorted(p.name for p in drafts.project.iterdir()) == ["buttons", "drafts"]


def test_a_name_that_was_never_listed_is_never_a_path(drafts: DocumentStore, tmp_path: Path) -> None:
    drafts.create("a", CLEAR)
    save_model(CLEAR, tmp_path / "secret.fdvv.json")
    for name in ("../../secret", "../buttons/a", "a.fdvv.json", str(tmp_path / "secret")):
        with pytest.raises(InputError, match="no such button of your own"):
            drafts.open(name)


@pytest.mark.parametrize(
    ("wanted", "name"),
    [
        ("mx/clear?", "mx-clear"),
        ("..", "button"),
        ("NUL", "button NUL"),
        ("a", "a 2"),
        ("é" * 99, "é" * 54),
        ("𠀀" * 99, "𠀀" * 48),
    ],
)
def test_a_free_name_is_near_the_wanted_one_and_can_be_created(
    drafts: DocumentStore, wanted: str, name: str
) -> None:
    drafts.create("A", CLEAR)
    assert drafts.free_name(wanted) == name
    assert drafts.create(name, CLEAR) == name


def test_one_process_at_a_time_holds_a_project(drafts: DocumentStore) -> None:
    drafts.create("a", CLEAR)
    other = DocumentStore(drafts.project)
    assert [file.name for file in other.list()] == ["a"]
    with pytest.raises(InputError, match="another studio works on this project; close it first"):
        other.open("a")
    drafts.close()
    assert other.open("a").revision == 0
    other.close()


@pytest.mark.skipif(not Path("/proc/self/fd").exists(), reason="the system does not list open files")
def test_buttons_used_long_ago_are_closed_and_go_on_where_they_were(drafts: DocumentStore) -> None:
    names = [drafts.create(f"button {number}", CLEAR) for number in range(MOST_OPEN + 8)]
    for name in names:
        assert isinstance(edit(drafts, name, {"travel_mm": 4.2}), ChangeSaved)
    for _ in range(3):
        drafts.open(names[8])
        drafts.open(names[-1])
    held = [entry for entry in Path("/proc/self/fd").iterdir() if is_journal(entry)]
    assert len(held) <= MOST_OPEN
    for name in names:
        state = drafts.open(name)
        assert state.revision == 1
        assert load_model(drafts.project / "buttons" / f"{name}.fdvv.json").travel_mm == 4.2


def is_journal(entry: Path) -> bool:
    try:
        target = entry.readlink()
    except OSError:
        return False
    return target.parent.name == "drafts" and not target.name.startswith(".")


def test_threads_that_edit_at_once_lose_nothing(drafts: DocumentStore) -> None:
    drafts.create("a", CLEAR)
    kept: list[int] = []

    def work(which: int) -> None:
        for i in range(5):
            while True:
                answer = edit(drafts, "a", {"reset_mm": 0.1 * which + 0.01 * i})
                if isinstance(answer, ChangeSaved):
                    kept.append(answer.revision)
                    break

    threads = [Thread(target=work, args=(which,)) for which in (1, 2, 3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sorted(kept) == list(range(1, 16))
    assert len(drafts.open("a").history.steps) == 15
