"""What the generated structures share: packing, unpacking, ranges."""

from __future__ import annotations

import dataclasses
import struct
from dataclasses import dataclass
from itertools import islice
from typing import Any, ClassVar, Self

from fdvv.errors import ModelError

Limits = dict[str, tuple[int, int]]
Reals = dict[str, tuple[float, float]]


@dataclass(frozen=True, kw_only=True)
class Record:
    """A structure of the protocol; checked once at construction (ModelError)."""

    FORMAT: ClassVar[str] = "<"
    LIMITS: ClassVar[Limits] = {}
    REALS: ClassVar[Reals] = {}
    """Ranges of the fields in single precision."""
    RUNS: ClassVar[dict[str, int]] = {}
    """How many numbers a field has that is a tuple of them."""

    def __post_init__(self) -> None:
        for name, (low, high) in (self.LIMITS | self.REALS).items():
            value, count = getattr(self, name), self.RUNS.get(name)
            if count is not None and len(value) != count:
                raise ModelError(f"{type(self).__name__}: {name} has {count} numbers, got {len(value)}")
            if not all(low <= number <= high for number in (value if count else (value,))):
                raise ModelError(f"{type(self).__name__}: {name} must be {low} to {high}, got {value}")

    @classmethod
    def length_bytes(cls) -> int:
        """Count the bytes on the wire."""
        return struct.calcsize(cls.FORMAT)

    def pack(self) -> bytes:
        """Return the bytes on the wire."""
        numbers: list[Any] = []
        for field in dataclasses.fields(self):
            value = getattr(self, field.name)
            numbers += value if field.name in self.RUNS else (value,)
        return struct.pack(self.FORMAT, *numbers)

    @classmethod
    def unpack(cls, data: bytes) -> Self:
        """Read from exactly length_bytes() bytes; ModelError if there are fewer or more, or out of range."""
        if len(data) != cls.length_bytes():
            raise ModelError(f"{cls.__name__} has {cls.length_bytes()} bytes, got {len(data)}")
        numbers = iter(struct.unpack(cls.FORMAT, data))
        values: dict[str, Any] = {}
        for field in dataclasses.fields(cls):
            count = cls.RUNS.get(field.name)
            values[field.name] = tuple(islice(numbers, count)) if count else next(numbers)
        return cls(**values)
