"""What the generated structures share: packing, unpacking, ranges."""

from __future__ import annotations

import dataclasses
import struct
from dataclasses import dataclass
from typing import ClassVar, Self

from fdvv.errors import ModelError

Limits = dict[str, tuple[int, int]]


@dataclass(frozen=True, kw_only=True)
class Record:
    """A structure of the protocol; checked once at construction (ModelError)."""

    FORMAT: ClassVar[str] = "<"
    LIMITS: ClassVar[Limits] = {}

    def __post_init__(self) -> None:
        for name, (low, high) in self.LIMITS.items():
            value = getattr(self, name)
            if not low <= value <= high:
                raise ModelError(f"{type(self).__name__}: {name} must be {low} to {high}, got {value}")

    @classmethod
    def length_bytes(cls) -> int:
        """Count the bytes on the wire."""
        return struct.calcsize(cls.FORMAT)

    def pack(self) -> bytes:
        """Return the bytes on the wire."""
        return struct.pack(self.FORMAT, *(getattr(self, f.name) for f in dataclasses.fields(self)))

    @classmethod
    def unpack(cls, data: bytes) -> Self:
        """Read from exactly length_bytes() bytes; ModelError if there are fewer or more, or out of range."""
        if len(data) != cls.length_bytes():
            raise ModelError(f"{cls.__name__} has {cls.length_bytes()} bytes, got {len(data)}")
        names = (field.name for field in dataclasses.fields(cls))
        return cls(**dict(zip(names, struct.unpack(cls.FORMAT, data), strict=True)))
