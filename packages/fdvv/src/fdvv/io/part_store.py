"""Rows written to disk in parts while work is done, and joined in order in one file at the end.

A part is a file, written whole or not at all, so that a killed process loses only what it had not written.
The one file at the end is the same to the byte however the rows were shared out and whatever was killed.
"""

from __future__ import annotations

import contextlib
import io
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fdvv.errors import BuildError
from fdvv.io.files import atomic_stream, write_atomic

if TYPE_CHECKING:
    from pyarrow import Schema, Table

LAYOUT: dict[str, Any] = {"compression": "zstd", "write_page_checksum": True, "store_schema": True}


def need_parquet() -> None:
    """Raise BuildError without the extra `sweep`: asked before long work, not after it."""
    try:
        import pyarrow.parquet  # noqa: F401
    except ImportError as error:
        raise BuildError('tables in Parquet need an extra: pip install "fdvv[sweep]"') from error


def open_parquet(path: Path) -> Any:
    """Open a file, a pyarrow.parquet.ParquetFile; the caller closes it. OSError, ValueError if damaged."""
    import pyarrow.parquet as pq

    # mapped files would count as memory of this process as long as they are open
    return pq.ParquetFile(path, page_checksum_verification=True, memory_map=False, pre_buffer=False)


def read_groups(path: Path, columns: Sequence[str] | None = None) -> Iterator[Table]:
    """Read the row groups of a file one after another. Raises OSError, ValueError if it is damaged."""
    with open_parquet(path) as found:
        for group in range(found.num_row_groups):
            yield found.read_row_group(group, columns=columns and list(columns))


def write_table(path: Path, table: Table) -> None:
    """Write a small table, whole or not at all. Raises OSError."""
    import pyarrow.parquet as pq

    buffer = io.BytesIO()
    pq.write_table(table, buffer, **LAYOUT)
    write_atomic(path, buffer.getvalue())


def write_tables(path: Path, schema: Schema, tables: Iterable[Table]) -> None:
    """Write tables one after another, a row group each, whole or not at all; one is in memory at a time."""
    import pyarrow.parquet as pq

    with atomic_stream(path) as stream, pq.ParquetWriter(stream, schema, **LAYOUT) as writer:
        for table in tables:
            writer.write_table(table, row_group_size=max(1, table.num_rows))


PARTS = "parts"
"""The folder of the parts, there only until the work is done."""
GROUP_rows = 512
"""Rows of a row group of the one file: what is in memory at a time."""
Key = tuple[Any, ...]


class PartStore:
    """The rows of one table in a folder, each known by the values of its key columns.

    Parameters
    ----------
    path : the one file; its folder exists, and this process alone works in it.
    schema : of the rows. A file of another schema, or a damaged one, counts as not there.
    key : names of the key columns.
    mend : remove what a killed process left and what cannot be used; else the folder is only looked at.
    """

    def __init__(self, path: Path, schema: Schema, key: Sequence[str], mend: bool = True) -> None:
        self._path, self._schema, self._key = path, schema, list(key)
        self._parts = path.parent / PARTS
        self._sources: list[tuple[Path, int]] = []
        self._known: dict[Key, tuple[int, int]] = {}
        self._number = 0
        self._mend = mend
        for temporary in path.parent.glob(f".{path.name}.*.tmp") if mend else ():
            temporary.unlink()
        for found in (path, *sorted(self._parts.glob("part-*.parquet"))):
            self._learn(found)

    def __contains__(self, key: Key) -> bool:
        return key in self._known

    def __len__(self) -> int:
        return len(self._known)

    def add(self, table: Table) -> None:
        """Write rows as a part; rows of a known key replace the earlier ones. Raises OSError."""
        self._parts.mkdir(exist_ok=True)
        self._number += 1
        path = self._parts / f"part-{self._number:08}.parquet"
        write_table(path, table.cast(self._schema))
        self._sources.append((path, 0))
        self._take(len(self._sources) - 1, table)

    def finish(self, order: Sequence[Key]) -> bool:
        """Write the one file with the rows of these keys, in this order; return whether it was not there yet.

        Every key must be known. What is not among them is dropped.
        """
        changed = not self._is_finished(order)
        if changed:
            groups = (order[i : i + GROUP_rows] for i in range(0, len(order), GROUP_rows))
            write_tables(self._path, self._schema, (self._gathered(group) for group in groups))
        for part in self._parts.glob("*"):
            part.unlink()
        with contextlib.suppress(FileNotFoundError):
            self._parts.rmdir()
        return changed

    def tables(self, columns: Sequence[str] | None = None) -> Iterator[Table]:
        """Return the rows of the one file, a row group after another."""
        return read_groups(self._path, columns)

    def _is_finished(self, order: Sequence[Key]) -> bool:
        if any(path != self._path for path, _ in self._sources):
            return False
        return self._path.exists() and list(self._known) == list(order) and bool(self._sources or not order)

    def _learn(self, path: Path) -> None:
        """Take the rows of a file into account, or remove a part that cannot be used."""
        stem = path.stem.rpartition("-")[2]
        if path != self._path and stem.isdigit():
            self._number = max(self._number, int(stem))
        try:
            with open_parquet(path) as found:
                if not _same(found.schema_arrow, self._schema):
                    raise ValueError("rows of another meaning")
                for group in range(found.num_row_groups):
                    table = found.read_row_group(group, columns=self._key)
                    self._sources.append((path, group))
                    self._take(len(self._sources) - 1, table)
        except FileNotFoundError:
            return
        except (OSError, ValueError):
            self._refuse(path)

    def _refuse(self, path: Path) -> None:
        """Forget a file and its rows; they are computed again."""
        kept = {i for i, (there, _) in enumerate(self._sources) if there != path}
        self._known = {key: at for key, at in self._known.items() if at[0] in kept}
        if self._mend and path != self._path:
            path.unlink()

    def _take(self, source: int, table: Table) -> None:
        columns = [table.column(name).to_pylist() for name in self._key]
        for row, key in enumerate(zip(*columns, strict=True)):
            self._known.pop(key, None)  # the order of a dict is that of the last writing
            self._known[key] = source, row

    def _gathered(self, keys: Sequence[Key]) -> Table:
        import numpy as np
        import pyarrow as pa

        wanted: dict[int, list[tuple[int, int]]] = {}
        for place, key in enumerate(keys):
            source, row = self._known[key]
            wanted.setdefault(source, []).append((row, place))
        pieces, places = [], []
        for source, rows in wanted.items():
            path, group = self._sources[source]
            with open_parquet(path) as found:
                pieces.append(found.read_row_group(group).take([row for row, _ in rows]))
            places += [place for _, place in rows]
        return pa.concat_tables(pieces).take(np.argsort(places)).combine_chunks()


def _same(found: Schema, wanted: Schema) -> bool:
    """Return whether rows mean the same: columns, types, and what the schema says of itself."""
    return bool(found.equals(wanted)) and dict(found.metadata or {}) == dict(wanted.metadata or {})
