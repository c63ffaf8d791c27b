"""Which files the shelf finds, and the ids it knows them by."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from tests.workflow.shelves import write_folder

from fdvv.model import SUFFIX, load_builtin, save_model
from fdvv.workflow import measured_files
from fdvv.workflow._shelf_files import own_files, source_files


def places(*folders: Path) -> list[str]:
    return [file.place for file in source_files(folders)]


def test_the_same_files_are_found_as_a_fit_of_the_folder_takes(tmp_path: Path) -> None:
    folder = write_folder(tmp_path / "a", {"x.csv": 0, "deep/y.CSV": 0, ".hidden/z.csv": 0, "README.csv": 0})
    assert places(folder) == [f"a/{path.relative_to(folder)}" for path in measured_files(folder)]


def test_an_id_outlives_a_move_of_the_folder_and_tells_no_path(tmp_path: Path) -> None:
    first = write_folder(tmp_path / "here" / "bench", {"x.csv": 0})
    before = [file.id for file in source_files([first])]
    (tmp_path / "there").mkdir()
    (tmp_path / "here" / "bench").rename(tmp_path / "there" / "bench")
    assert [file.id for file in source_files([tmp_path / "there" / "bench"])] == before
    assert len(before[0]) == len("measured:") + 16


def test_folders_of_one_name_are_told_apart(tmp_path: Path) -> None:
    one = write_folder(tmp_path / "1" / "bench", {"x.csv": 0})
    two = write_folder(tmp_path / "2" / "bench", {"x.csv": 0})
    assert places(one, two) == ["bench/x.csv", "bench (2)/x.csv"]
    assert len({file.id for file in source_files([one, two])}) == 2


def test_a_folder_within_another_is_listed_once(tmp_path: Path) -> None:
    outer = write_folder(tmp_path / "outer", {"inner/x.csv": 0})
    assert places(outer / "inner", outer, outer) == ["outer/inner/x.csv"]


def test_a_pair_is_one_button_and_either_half_changes_its_stamp(tmp_path: Path) -> None:
    folder = write_folder(
        tmp_path / "pairs", {"A.downstroke.csv": 0, "A.upstroke.csv": 0, "B.upstroke.csv": 0}
    )
    found = list(source_files([folder]))
    assert [file.path.name for file in found] == ["A.downstroke.csv", "B.upstroke.csv"]
    os.utime(folder / "A.upstroke.csv", (1, 1))
    assert next(iter(source_files([folder]))).stamp != found[0].stamp
    assert found[0].again() != found[0]


def test_what_is_not_there_is_empty_and_links_out_of_a_folder_are_not_walked(tmp_path: Path) -> None:
    folder = write_folder(tmp_path / "a", {"x.csv": 0})
    (folder / "loop").symlink_to(folder)
    assert places(folder, tmp_path / "nowhere") == ["a/x.csv"]


def test_own_models_lie_in_the_folder_itself(tmp_path: Path) -> None:
    for name in ("b", "a", "deep/c"):
        save_model(load_builtin("mx-red"), tmp_path / f"{name}{SUFFIX}")
    (tmp_path / "notes.csv").write_text("1")
    assert [file.id for file in own_files(tmp_path)] == ["own:a", "own:b"]
    assert list(own_files(tmp_path / "none")) == []


@pytest.mark.skipif(os.name != "posix", reason="names of bytes")
def test_a_name_that_is_no_text_is_found_too(tmp_path: Path) -> None:
    folder = write_folder(tmp_path / "a", {"x.csv": 0})
    (folder / "x.csv").rename(folder / os.fsdecode(b"\xff.csv"))
    (found,) = source_files([folder])
    assert found.place.encode()
    assert found.path.is_file()
