"""A library of measured files: built, brought up to date, killed, searched."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from fdvv.errors import BuildError, InputError
from fdvv.model.file import load_builtin, save_model
from fdvv.parallel.open import open_executor
from fdvv_studio.library.build import (
    BUTTONS,
    LibraryBuilt,
    LibraryWork,
    build_library,
    read_button,
    read_manifest,
)
from fdvv_studio.library.catalog import Catalog, source_files
from fdvv_studio.library.figures import row_of_file, row_of_model
from fdvv_studio.library.index import CatalogIndex
from fdvv_studio.library.library import Library, library_query
from fdvv_studio.library.row import NUMBERS as SHELF_NUMBERS
from fdvv_studio.library.search import SearchQuery
from fdvv_studio.library.table import COLUMNS as LIBRARY_COLUMNS
from fdvv_studio.library.table import library_schema
from tests.support.buttons import write_cycle
from tests.support.catalog_rows import write_folder
from tests.support.deadly_work import DeadlyReader
from tests.support.executors import Here

REFERENCE = Path(__file__).resolve().parents[4] / "docs" / "reference" / "library-files.md"
NAMES = {"reds/light red.csv": 0.0, "reds/dark red.csv": 3.0, "blues/navy.csv": 25.0, "plain.csv": 12.0}


def built(source: Path, library: Path, read: DeadlyReader | None = None) -> LibraryBuilt:
    work = LibraryWork((source.resolve(),), read) if read else None
    return build_library([source], library, Here(), work=work)


@pytest.fixture(scope="module")
def source(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = write_folder(tmp_path_factory.mktemp("source") / "switches", NAMES)
    (folder / "broken.csv").write_text("displacement_mm,force_cN\n1,2\n")
    (folder / "other.json").write_text('{"format": "fdvv-session"}')
    save_model(load_builtin("mx-clear"), folder / "clear.fdvv.json")
    return folder


@pytest.fixture(scope="module")
def library(source: Path, tmp_path_factory: pytest.TempPathFactory) -> Library:
    folder = tmp_path_factory.mktemp("library") / "library"
    found = built(source, folder)
    assert (found.files, found.buttons, found.refused, found.read) == (7, 5, 1, 7)
    return Library(folder)


def test_rows_are_those_of_the_studios_library(library: Library, source: Path) -> None:
    files = {file.id: file for file in source_files([source])}
    measured = [row for row in library.rows if row.name != "mx-clear"]
    assert len(measured) == 4
    for row in measured:
        assert row == row_of_file(files[row.id].path, row.id, files[row.id].collection)


def test_every_figure_can_be_read_again_from_the_curves_that_are_kept(library: Library) -> None:
    for row in library.rows:
        again = row_of_model(library.model(row.id), row.id, row.origin)
        for name in SHELF_NUMBERS:
            kept, read = getattr(row, name), getattr(again, name)
            assert (kept is None) == (read is None), (row.name, name)
            if kept is not None and row.name != "mx-clear":
                assert read == pytest.approx(kept, rel=1e-3, abs=2e-3), (row.name, name)


def test_a_refused_file_is_kept_with_its_reason_and_another_kind_without(library: Library) -> None:
    ((place, reason),) = library.refused()
    assert place == "switches/broken.csv"
    assert "give" in reason


def test_the_columns_of_the_file_are_those_of_the_code_and_of_the_document(library: Library) -> None:
    import pyarrow.parquet as pq

    found = pq.read_schema(library.folder / BUTTONS)
    names = [column.name for column in LIBRARY_COLUMNS]
    assert found.names == names == library_schema().names
    lines = REFERENCE.read_text().splitlines()
    table_rows = {line.split("|")[1].strip(): line for line in lines if line.startswith("| `")}
    for column in LIBRARY_COLUMNS:
        assert column.type in table_rows[f"`{column.name}`"], column.name
        assert column.meaning in table_rows[f"`{column.name}`"], column.name


def test_pandas_reads_the_file_and_its_curves(library: Library) -> None:
    pandas = pytest.importorskip("pandas")
    table = pandas.read_parquet(library.folder / BUTTONS)
    buttons = table[table.state == "button"]
    assert len(buttons) == 5
    assert set(buttons.kind) == {"tactile"}
    curve = buttons.iloc[0].curves[0]
    x = curve["start_mm"] + curve["step_mm"] * np.arange(len(curve["force_cN"]))
    assert x[-1] >= buttons.iloc[0].travel_mm - 0.05


def test_nothing_is_read_again_that_did_not_change(tmp_path: Path) -> None:
    folder = tmp_path / "switches"
    write_folder(folder, NAMES)
    library, log = tmp_path / "library", tmp_path / "log"
    log.mkdir()
    built(folder, library, DeadlyReader(read_button, log=log))
    assert len(list(log.iterdir())) == 4
    before = (library / BUTTONS).read_bytes()
    again = built(folder, library, DeadlyReader(read_button, ".csv"))  # would kill this process
    assert (again.read, again.kept, again.gone) == (0, 4, 0)
    assert (library / BUTTONS).read_bytes() == before
    write_cycle(folder / "plain.csv", added_cN=30.0, seed=9)
    (folder / "blues/navy.csv").unlink()
    changed = built(folder, library)
    assert (changed.files, changed.read, changed.kept, changed.gone) == (3, 1, 2, 2)
    assert {row.name for row in Library(library).rows} == {"light red", "dark red", "plain"}


def test_a_build_that_is_stopped_goes_on_and_ends_the_same(
    source: Path, library: Library, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("fdvv_studio.library.build.FILES", 2)

    def stop(done: int, _whole: int) -> None:
        if done == 4:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        build_library([source], tmp_path / "library", Here(), stop)
    with pytest.raises(InputError, match="is not finished"):
        Library(tmp_path / "library")
    found = built(source, tmp_path / "library")
    assert (found.read, found.kept) == (3, 4)
    assert (tmp_path / "library" / BUTTONS).read_bytes() == (library.folder / BUTTONS).read_bytes()


def test_a_folder_of_something_else_is_left_alone(source: Path, library: Library, tmp_path: Path) -> None:
    (tmp_path / "letter.txt").write_text("mine")
    with pytest.raises(InputError, match="is not empty and no library"):
        built(source, tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["letter.txt"]
    other = write_folder(tmp_path / "others", {"a.csv": 0.0})
    with pytest.raises(InputError, match="a library of switches, which would be dropped"):
        built(other, library.folder)
    (tmp_path / "empty").mkdir()
    with pytest.raises(InputError, match=r"no \.csv"):
        built(tmp_path / "empty", tmp_path / "new")
    assert not (tmp_path / "new").exists()


def test_a_worker_that_does_not_see_the_folder_ends_the_build(source: Path) -> None:
    file = next(source_files([source]))
    with pytest.raises(FileNotFoundError, match="share the folder with every worker"):
        LibraryWork((source / "elsewhere",))((file,))


def test_without_the_extra_one_line_says_what_to_install(
    source: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    monkeypatch.setitem(sys.modules, "pyarrow.parquet", None)
    with pytest.raises(BuildError, match=r'pip install "fdvv\[sweep\]"'):
        built(source, tmp_path / "library")
    assert not (tmp_path / "library").exists()


def test_words_and_conditions_are_found_together(library: Library) -> None:
    hits, mended = library.find(library_query("red peak_cN>=50"))
    assert {hit.row.name for hit in hits} == {"light red", "dark red"}
    assert not mended
    hits, mended = library.find(library_query("nevy"))
    assert [hit.row.name for hit in hits] == ["navy"]
    assert mended == ("nevy",)
    peaks = [hit.row.peak_cN for hit in library.find(library_query("", "peak_cN", descending=True))[0]]
    assert peaks == sorted((p for p in peaks if p), reverse=True)


def test_the_nearest_is_the_one_that_differs_least(library: Library, tmp_path: Path) -> None:
    near = write_cycle(tmp_path / "asked.csv", added_cN=1.0, seed=5)
    for by in ("all", "curve"):
        assert [h.row.name for h in library.like(str(near), by, 2)] == ["light red", "dark red"]
    assert library.like("mx-clear", count=1)[0].row.name == "mx-clear"
    red = next(row for row in library.rows if row.name == "light red")
    hits = library.like(red.id)
    assert hits[0].row.name == "dark red"
    assert [hit.row.id for hit in library.like("switches/reds/light red.csv")] == [hit.row.id for hit in hits]
    distances = [hit.distance_JND for hit in hits]
    assert distances == sorted(d for d in distances if d is not None)
    # buttons that were only asked about are never found
    assert len(library.find(SearchQuery())[0]) == len(library.rows) == 5


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("peak>=50", "did you mean peak_"),
        ("kind=soft", "linear,tactile"),
        ("peak_cN>=heavy", "is not a number"),
        ("peak_cN >= 50", "neither a word nor a condition"),
    ],
)
def test_an_impossible_condition_is_refused_with_the_possible_ones(text: str, said: str) -> None:
    with pytest.raises(InputError, match=said):
        library_query(text)


def test_conditions_of_one_column_hold_together() -> None:
    assert library_query("peak_cN>=50 peak_cN<=60 kind=clicky,dome?").ranges == {"peak_cN": (50.0, 60.0)}
    assert library_query("travel_mm=..3.5").ranges == {"travel_mm": (None, 3.5)}
    (low, high) = library_query("peak_cN>50").ranges["peak_cN"]
    assert low is not None
    assert 50 < low < 50.001
    assert high is None


@pytest.fixture
def deadly(tmp_path: Path) -> Path:
    return write_folder(tmp_path / "switches", {**NAMES, "bomb.csv": 1.0, "fine.csv": 2.0})


@pytest.mark.slow
def test_a_file_that_ends_its_reader_is_refused_and_costs_no_other(
    deadly: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("fdvv.parallel.executor.TRIES", 1)
    with open_executor(processes=2) as executor:
        work = LibraryWork((deadly,), DeadlyReader(read_button, "bomb"))
        found = build_library([deadly], tmp_path / "library", executor, work=work)
    assert (found.buttons, found.refused) == (5, 1)
    ((place, reason),) = Library(tmp_path / "library").refused()
    assert place == "switches/bomb.csv"
    assert "every process that took it ended" in reason


RUN = """
import sys
from pathlib import Path
import fdvv_studio.library.build as build
from tests.support.deadly_work import DeadlyReader
from fdvv.parallel.open import open_executor
from fdvv_studio.library.build import LibraryWork, read_button
if __name__ == "__main__":
    source, library = map(Path, sys.argv[1:])
    build.FILES = 2
    with open_executor(processes=2) as executor:
        build.build_library(
            [source], library, executor, lambda done, _: print(done, flush=True),
            LibraryWork((source,), DeadlyReader(read_button, slow_s=0.02)),
        )
"""


@pytest.mark.slow
def test_a_build_killed_at_random_moments_loses_nothing(tmp_path: Path) -> None:
    source = write_folder(tmp_path / "many", {f"{i // 6}/switch {i:02}.csv": 0.5 * i for i in range(36)})
    script, library = tmp_path / "run.py", tmp_path / "library"
    script.write_text(RUN)
    random, done, kills = np.random.default_rng(4), 0, 0
    while True:
        command = [sys.executable, str(script), str(source), str(library)]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, start_new_session=True) as process:
            assert process.stdout is not None
            first = int(process.stdout.readline() or done)
            assert first >= done  # what was reported as done is still there
            lines = int(random.integers(0, 3))  # of 18: by progress, so that five kills fit on any machine
            for line in process.stdout:
                done = int(line)
                lines -= 1
                if kills < 5 and lines < 0:
                    time.sleep(random.uniform(0.0, 0.03))
                    os.killpg(process.pid, signal.SIGKILL)
                    kills += 1
                    break
            process.stdout.read()
            if process.wait() == 0:
                break
    assert kills == 5
    plain = tmp_path / "plain"
    build_library([source], plain, Here())
    assert (library / BUTTONS).read_bytes() == (plain / BUTTONS).read_bytes()
    assert {path.name for path in library.iterdir()} == {path.name for path in plain.iterdir()}


@pytest.mark.slow
@pytest.mark.parametrize("options", [{"processes": 2}, {"workers": 2}], ids=["processes", "dask"])
def test_whoever_builds_it_the_library_is_the_same(
    source: Path, library: Library, tmp_path: Path, options: dict[str, int], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("fdvv_studio.library.build.FILES", 2)
    with open_executor(options.get("processes"), options.get("workers")) as executor:
        build_library([source], tmp_path / "library", executor)
    assert (tmp_path / "library" / BUTTONS).read_bytes() == (library.folder / BUTTONS).read_bytes()
    assert read_manifest(tmp_path / "library") == library.manifest


@pytest.mark.shared
@pytest.mark.slow
def test_real_measurements_become_a_library_in_which_makes_find_each_other(
    shared_data: Path, tmp_path: Path
) -> None:
    folders = [shared_data / name for name in ("tg-tidy", "haata", "bluepylons")]
    found = build_library(folders, tmp_path / "library", Here())
    assert found.buttons > 60
    assert {Path(place).name for place, _ in Library(tmp_path / "library").refused()} >= {
        "KBDfans-Mito-Gateron-Laser-60g.ods",
        "JWK-Twilight-stock.ods",
    }
    nearest = Library(tmp_path / "library").like("mx-clear", count=3)
    assert all("Clear" in hit.row.name for hit in nearest)


def test_a_shelf_with_a_library_of_its_folder_reads_nothing(
    library: Library, source: Path, tmp_path: Path
) -> None:
    def index(name: str, *libraries: Path) -> CatalogIndex:
        shelf = Catalog(tmp_path / name, [source])
        return CatalogIndex(shelf, tmp_path / f"{name}.jsonl", workers=0, libraries=libraries)

    plain, known = index("plain"), index("known", library.folder)
    plain.scan()
    known._read = lambda *_: pytest.fail("a file was read")  # type: ignore[method-assign]
    known.scan()
    assert known.status.rows == plain.status.rows
    assert known.status.refused == plain.status.refused
