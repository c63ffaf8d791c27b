"""Tables in Parquet: written whole or not at all, each page with a checksum."""

from __future__ import annotations

import io
import os
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fdvv.errors import BuildError
from fdvv.files import write_atomic

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


def write_table(path: Path, table: Table) -> None:
    """Write a small table, whole or not at all. OSError."""
    import pyarrow.parquet as pq

    buffer = io.BytesIO()
    pq.write_table(table, buffer, **LAYOUT)
    write_atomic(path, buffer.getvalue())


def write_tables(path: Path, schema: Schema, tables: Iterable[Table]) -> None:
    """Write tables one after another, a row group each, whole or not at all; one is in memory at a time."""
    import pyarrow.parquet as pq

    handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.", suffix=".tmp")
    try:
        with os.fdopen(handle, "wb") as stream:
            with pq.ParquetWriter(stream, schema, **LAYOUT) as writer:
                for table in tables:
                    writer.write_table(table, row_group_size=max(1, table.num_rows))
            stream.flush()
            os.fsync(stream.fileno())
        umask = os.umask(0)
        os.umask(umask)
        Path(name).chmod(0o666 & ~umask)  # mkstemp makes files private
        Path(name).replace(path)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise
