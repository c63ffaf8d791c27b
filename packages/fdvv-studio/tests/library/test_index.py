"""The index: reads once, keeps what it read, follows what comes and goes, tells what it refuses."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from threading import Event

import pytest

from fdvv.model.file import MODEL_SUFFIX, builtin_names, load_builtin, save_model
from fdvv_studio.library.catalog import Catalog, own_files
from fdvv_studio.library.index import CatalogIndex, IndexStatus, ReadAnswer, ReadRequest, RowReader
from fdvv_studio.library.row import Origin
from tests.support.buttons import write_cycle
from tests.support.catalog_rows import write_folder


@pytest.fixture
def bench(tmp_path: Path) -> Path:
    folder = write_folder(tmp_path / "bench", {"a.csv": 0, "b.csv": 5, "deep/c.csv": 9})
    (folder / "bad.csv").write_text("text,of,no,kind\n1,2,3,4\n")
    return folder


def indexed(tmp_path: Path, *sources: Path) -> CatalogIndex:
    index = CatalogIndex(
        Catalog(tmp_path / "project", sources), tmp_path / "project" / "cache.jsonl", workers=0
    )
    index.scan()
    return index


def measured(stand: IndexStatus) -> list[str]:
    return [row.name for row in stand.rows if row.origin is not Origin.BUILTIN]


def test_a_scan_reads_every_file_or_says_why_not(tmp_path: Path, bench: Path) -> None:
    stand = indexed(tmp_path, bench).status
    assert stand.ended
    assert (stand.done, stand.total) == (4, 4)
    assert measured(stand) == ["a", "b", "c"]
    assert [row.name for row in stand.rows if row.origin is Origin.BUILTIN] == list(builtin_names())
    (refused,) = stand.refused
    assert refused.place == "bench/bad.csv"
    assert "no header names a displacement" in refused.reason
    assert str(tmp_path) not in refused.reason


def test_a_restart_reads_nothing_that_did_not_change(tmp_path: Path, bench: Path) -> None:
    first = indexed(tmp_path, bench).status
    status = (bench / "a.csv").stat()
    (bench / "a.csv").write_bytes(b"x" * status.st_size)
    os.utime(bench / "a.csv", ns=(status.st_atime_ns, status.st_mtime_ns))
    again = indexed(tmp_path, bench).status
    assert again.rows == first.rows
    assert again.refused == first.refused


def test_what_comes_goes_and_changes_is_followed(tmp_path: Path, bench: Path) -> None:
    index = indexed(tmp_path, bench)
    before = index.status
    (bench / "b.csv").unlink()
    write_cycle(bench / "new.csv")
    write_cycle(bench / "bad.csv")
    (bench / "a.csv").write_text("now,it,is,bad\n1,2,3,4\n")
    index.scan()
    assert sorted(measured(index.status)) == ["bad", "c", "new"]
    assert [one.place for one in index.status.refused] == ["bench/a.csv"]
    assert index.status.epoch == before.epoch + 1
    assert measured(indexed(tmp_path, bench).status) == ["bad", "c", "new"]


def test_a_rescan_without_changes_keeps_everything_as_it_is(tmp_path: Path, bench: Path) -> None:
    index = indexed(tmp_path, bench)
    before = index.status
    index.scan()
    assert index.status is before


@pytest.mark.parametrize("damage", ["half", "noise", "other version", "not text"])
def test_a_damaged_cache_costs_a_reading_and_nothing_else(tmp_path: Path, bench: Path, damage: str) -> None:
    expected = indexed(tmp_path, bench).status.rows
    cache = tmp_path / "project" / "cache.jsonl"
    whole = cache.read_bytes()
    cache.write_bytes(
        {
            "half": whole[: len(whole) // 2],
            "noise": whole.replace(b'"travel_mm":', b'"travel_mm":"x', 1),
            "other version": whole.replace(b'"version":1', b'"version":0'),
            "not text": os.urandom(1000),
        }[damage]
    )
    found = indexed(tmp_path, bench).status
    assert sorted(row.id for row in found.rows) == sorted(row.id for row in expected)
    assert {row.id: row for row in found.rows} == {row.id: row for row in expected}


def test_a_cache_that_cannot_be_written_is_reported_and_harms_nothing(tmp_path: Path, bench: Path) -> None:
    (tmp_path / "project").write_text("a file where the folder should be")
    stand = indexed(tmp_path, bench).status
    assert measured(stand) == ["a", "b", "c"]
    assert "cannot be written" in stand.trouble


def test_own_models_and_models_of_sources_are_rows(tmp_path: Path, bench: Path) -> None:
    save_model(load_builtin("mx-red"), tmp_path / "project" / "buttons" / f"mine{MODEL_SUFFIX}")
    save_model(load_builtin("mx-blue"), bench / f"published{MODEL_SUFFIX}")
    (tmp_path / "project" / "buttons" / f"broken{MODEL_SUFFIX}").write_text("{}")
    (bench / "receipt.json").write_text('{"format": "fdvv-receipt"}')
    stand = indexed(tmp_path, bench).status
    rows = {row.id: row for row in stand.rows}
    assert rows["own:mine"].origin is Origin.OWN
    assert rows["own:mine"].licence == load_builtin("mx-red").provenance.licence
    assert "mx-blue" in measured(stand)
    assert [one.place for one in stand.refused] == ["own:broken", "bench/bad.csv"]


def test_the_background_tells_and_stops(tmp_path: Path, bench: Path) -> None:
    ended = Event()

    def tell(stand: IndexStatus) -> None:
        if stand.ended:
            ended.set()

    index = CatalogIndex(Catalog(tmp_path / "project", [bench]), tmp_path / "cache.jsonl", tell, workers=1)
    index.start()
    assert ended.wait(30)
    assert measured(index.status) == ["a", "b", "c"]
    ended.clear()
    write_cycle(bench / "new.csv")
    index.rescan()
    assert ended.wait(30)
    assert "new" in measured(index.status)
    index.close()
    index.close()


@pytest.fixture
def reader() -> Iterator[RowReader]:
    reader = RowReader()
    yield reader
    reader.close()


def read_by(reader: RowReader, path: Path) -> ReadAnswer:
    return reader.read(ReadRequest(os.fsencode(path), "measured:0", "", Origin.MEASURED))


def test_a_reader_that_died_is_started_again(tmp_path: Path, reader: RowReader) -> None:
    path = write_cycle(tmp_path / "good.csv")
    assert read_by(reader, path).row is not None
    assert reader._process is not None
    reader._process.kill()
    reader._process.wait()
    assert read_by(reader, path).row is not None


def test_a_file_that_takes_too_long_is_given_up(tmp_path: Path) -> None:
    (tmp_path / "long.csv").write_text("mm,cN\n" + "".join(f"{i / 1e5},{i / 1e3}\n" for i in range(300_000)))
    reader = RowReader(longest_s=0.02)
    assert "took over 0.02 s" in read_by(reader, tmp_path / "long.csv").reason
    assert reader._process is None


def test_a_button_deleted_while_the_folder_is_listed_is_passed_over(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("gone.fdvv.json", "here.fdvv.json"):
        (tmp_path / name).write_text("{}")
    listed = os.scandir

    def listed_then_deleted(folder: Path | str) -> list[os.DirEntry[str]]:
        with listed(folder) as entries:
            found = list(entries)
        (tmp_path / "gone.fdvv.json").unlink(missing_ok=True)
        return found

    monkeypatch.setattr(os, "scandir", listed_then_deleted)
    assert [file.id for file in own_files(tmp_path)] == ["own:here"]
