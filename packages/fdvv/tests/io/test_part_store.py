"""Rows part by part: none is lost, whatever is killed, and the file at the end is always the same."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.io.part_store import PARTS, GROUP_rows, PartStore

SCHEMA = pa.schema([("n", pa.int64()), ("text", pa.string())], metadata={"version": "1"})


def rows(*numbers: int, word: str = "row") -> pa.Table:
    return pa.table({"n": list(numbers), "text": [f"{word} {n}" for n in numbers]}, schema=SCHEMA)


def store(folder: Path) -> PartStore:
    return PartStore(folder / "all.parquet", SCHEMA, ("n",))


def keys(*numbers: int) -> list[tuple[int]]:
    return [(n,) for n in numbers]


pytestmark = pytest.mark.usefixtures("hasty_disk")


@settings(max_examples=8, deadline=None)
@given(st.permutations(range(12)), st.lists(st.integers(1, 11), max_size=4, unique=True), st.data())
def test_the_file_is_the_same_however_rows_were_shared_out_and_stopped(
    tmp_path_factory: pytest.TempPathFactory, order: list[int], cuts: list[int], data: st.DataObject
) -> None:
    folder = tmp_path_factory.mktemp("store")
    made = store(folder)
    for piece in np.split(order, sorted(cuts)):
        made.add(rows(*piece.tolist()))
        if data.draw(st.booleans()):
            made = store(folder)  # as another process would find it
    assert made.finish(keys(*range(12)))
    plain = folder / "plain"
    plain.mkdir()
    at_once = store(plain)
    at_once.add(rows(*range(12)))
    at_once.finish(keys(*range(12)))
    assert (folder / "all.parquet").read_bytes() == (plain / "all.parquet").read_bytes()
    assert pq.read_table(folder / "all.parquet").column("n").to_pylist() == list(range(12))
    assert not (folder / PARTS).exists()


def test_what_is_wanted_is_there_in_its_order_and_nothing_else(tmp_path: Path) -> None:
    made = store(tmp_path)
    made.add(rows(*range(2000)))
    wanted = [1999, 3, 700, *range(10, 1500)]
    made.finish(keys(*wanted))
    found = pq.ParquetFile(tmp_path / "all.parquet")
    assert found.read().column("n").to_pylist() == wanted
    assert found.read().column("text").to_pylist()[0] == "row 1999"
    assert max(found.metadata.row_group(i).num_rows for i in range(found.num_row_groups)) <= GROUP_rows


def test_a_later_row_stands_for_an_earlier_one_of_the_same_key(tmp_path: Path) -> None:
    made = store(tmp_path)
    made.add(rows(1, 2))
    made.add(rows(2, word="newer"))
    store(tmp_path).finish(keys(1, 2))
    assert pq.read_table(tmp_path / "all.parquet").column("text").to_pylist() == ["row 1", "newer 2"]


def test_what_stands_already_is_not_written_again(tmp_path: Path) -> None:
    made = store(tmp_path)
    made.add(rows(1, 2, 3))
    assert made.finish(keys(1, 2, 3))
    before = (tmp_path / "all.parquet").stat()
    assert not store(tmp_path).finish(keys(1, 2, 3))
    after = (tmp_path / "all.parquet").stat()
    assert (after.st_ino, after.st_mtime_ns) == (before.st_ino, before.st_mtime_ns)
    assert store(tmp_path).finish(keys(1, 3))
    assert len(store(tmp_path)) == 2


@pytest.mark.parametrize("at", [0.1, 0.5, 0.95])
def test_a_damaged_part_counts_as_not_there(tmp_path: Path, at: float) -> None:
    made = store(tmp_path)
    made.add(rows(1, 2))
    made.add(rows(*range(3, 50)))
    path = sorted((tmp_path / PARTS).iterdir())[1]
    content = bytearray(path.read_bytes())
    del content[int(at * len(content)) :]
    path.write_bytes(content)
    again = store(tmp_path)
    assert (1,) in again
    assert (3,) not in again
    again.add(rows(*range(3, 50)))
    again.finish(keys(*range(1, 50)))
    assert pq.read_table(tmp_path / "all.parquet").num_rows == 49


def test_rows_of_another_meaning_are_not_taken(tmp_path: Path) -> None:
    made = store(tmp_path)
    made.add(rows(1))
    made.finish(keys(1))
    other = PartStore(tmp_path / "all.parquet", SCHEMA.with_metadata({"version": "2"}), ("n",))
    assert len(other) == 0


def test_looking_only_leaves_the_folder_as_it_is(tmp_path: Path) -> None:
    store(tmp_path).add(rows(1))
    (tmp_path / PARTS / "part-00000002.parquet").write_bytes(b"torn")
    (tmp_path / ".all.parquet.x.tmp").write_bytes(b"torn")
    before = sorted(path.name for path in tmp_path.rglob("*"))
    assert len(PartStore(tmp_path / "all.parquet", SCHEMA, ("n",), mend=False)) == 1
    assert sorted(path.name for path in tmp_path.rglob("*")) == before
