"""Opening buttons by id: what is there, and nothing else."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from fdvv.button.fit import fit_file, measured_files
from fdvv.errors import InputError
from fdvv.model.curve import Stroke
from fdvv.model.file import MODEL_SUFFIX, load_builtin, save_model
from fdvv_studio.library.catalog import Catalog, own_files, source_files
from tests.support.catalog_rows import write_folder


@pytest.fixture
def shelf(tmp_path: Path) -> Catalog:
    write_folder(tmp_path / "bench", {"x.csv": 0, "y.csv": 10})
    save_model(load_builtin("mx-red"), tmp_path / "project" / "buttons" / f"mine{MODEL_SUFFIX}")
    return Catalog(tmp_path / "project", [tmp_path / "bench"])


def test_every_origin_opens(shelf: Catalog) -> None:
    assert shelf.model("builtin:mx-clear") == load_builtin("mx-clear")
    assert shelf.model("own:mine") == load_builtin("mx-red")
    measured = next(file for file in shelf.scan() if file.id.startswith("measured:"))
    assert shelf.model(measured.id) == fit_file(measured.path).model


@pytest.mark.parametrize(
    "button_id",
    [
        *("own:../buttons/mine", f"own:mine{MODEL_SUFFIX}", "own:", "", "mine", "builtin:", "builtin:../x"),
        *("measured:../x.csv", "measured:0000000000000000", "/etc/passwd", "own:mine\0"),
    ],
)
def test_what_is_no_id_opens_nothing(shelf: Catalog, button_id: str) -> None:
    with pytest.raises(InputError, match="no button is called"):
        shelf.model(button_id)


def test_a_changed_file_is_read_anew_and_one_that_came_is_found(shelf: Catalog, tmp_path: Path) -> None:
    path = tmp_path / "project" / "buttons" / f"mine{MODEL_SUFFIX}"
    assert shelf.model("own:mine").name == "mx-red"
    save_model(load_builtin("mx-blue"), path)
    assert shelf.model("own:mine").name == "mx-blue"
    save_model(load_builtin("mx-black"), path.with_name(f"new{MODEL_SUFFIX}"))
    assert shelf.model("own:new").name == "mx-black"
    path.unlink()
    with pytest.raises(InputError):
        shelf.model("own:mine")


def test_curves_are_the_means_themselves_not_a_fit(shelf: Catalog) -> None:
    measured = next(file for file in shelf.scan() if file.id.startswith("measured:"))
    raw, fitted = shelf.curves(measured.id), shelf.model(measured.id)
    x = np.linspace(0.3, 3.8, 200)
    gap = raw.force_cN(x, 1.0) - fitted.force_cN(x, 1.0)
    assert 0 < np.abs(gap).max() < 1.0
    assert raw.of(Stroke.PRESS)[0].degree == 1


def test_nothing_but_buttons_of_the_source_is_read(tmp_path: Path) -> None:
    secret = tmp_path / "secret.csv"
    secret.write_text("password")
    (tmp_path / "bench").mkdir()
    shelf = Catalog(tmp_path / "project", [tmp_path / "bench"])
    assert shelf.scan() == ()
    assert list((tmp_path / "bench").iterdir()) == []
    assert not (tmp_path / "project").exists()


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


def test_folders_of_one_name_are_distinguished(tmp_path: Path) -> None:
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
        save_model(load_builtin("mx-red"), tmp_path / f"{name}{MODEL_SUFFIX}")
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
