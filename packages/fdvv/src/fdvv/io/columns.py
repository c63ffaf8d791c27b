"""Arrays as text in JSON, exact to the bit.

``"<i2[120,3]:…"``: the kind of number, the shape where there is more than one axis, and base64 of zlib of
the numbers, row after row, lowest byte first. Kinds: ``|i1 <i2 <i4 <i8`` whole numbers of so many bytes,
``|u1 <u2 <u4 <u8`` those without a sign, ``<f4 <f8`` floats (IEEE 754), ``?`` true or false in a byte.
"""

from __future__ import annotations

import base64
import re
import zlib
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import numpy.typing as npt
from msgspec import Meta

KINDS = ("?", "|i1", "|u1", "<i2", "<u2", "<i4", "<u4", "<i8", "<u8", "<f4", "<f8")
"""Kinds of number that an array may hold, as NumPy writes them."""
if TYPE_CHECKING:
    Packed = npt.NDArray[Any]
    PackedFloats = npt.NDArray[np.float64]
else:  # as a file holds such a field; its record makes an array of it
    Packed = PackedFloats = Annotated[
        str,
        Meta(
            pattern=r"^(\?|\|[iu]1|<[iu][248]|<f[48])(\[\d+(,\d+)+\])?:",
            description="kind, shape, base64 of zlib of the numbers",
        ),
    ]
_HEAD = re.compile(r"([^\[:]+)(?:\[(\d+(?:,\d+)+)\])?\Z", re.ASCII)


def pack_column(column: npt.NDArray[Any]) -> str:
    """Write an array as text. Raises ValueError for a kind of number that is not in KINDS."""
    column = np.asarray(column)
    kind = "?" if column.dtype == np.bool_ else column.dtype.newbyteorder("<").str
    if kind not in KINDS or column.ndim == 0:
        raise ValueError(f"a column cannot hold {column.dtype} with {column.ndim} axes")
    shape = f"[{','.join(map(str, column.shape))}]" if column.ndim > 1 else ""
    data = zlib.compress(np.ascontiguousarray(column, dtype=kind).tobytes())
    return f"{kind}{shape}:{base64.b64encode(data).decode()}"


def unpack_fields(record: object, *names: str) -> None:
    """Make arrays of those fields of a frozen record that are text. Raises ValueError."""
    for name in names:
        if isinstance(text := getattr(record, name), str):
            object.__setattr__(record, name, unpack_column(text))


def unpack_column(text: str) -> npt.NDArray[Any]:
    """Read an array; it cannot be written to. Raises ValueError on text that is none."""
    head, found, data = text.partition(":")
    match = _HEAD.match(head)
    if not found or match is None or match[1] not in KINDS:
        raise ValueError(f"no column begins {head[:20]!r}")
    try:
        column = np.frombuffer(zlib.decompress(base64.b64decode(data, validate=True)), match[1])
    except zlib.error as error:
        raise ValueError(f"a column is damaged: {error}") from None
    return column.reshape([int(n) for n in match[2].split(",")]) if match[2] else column
