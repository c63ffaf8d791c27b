"""What differs between two runs of the same code, and what stands for it."""

from __future__ import annotations

import re
from collections.abc import Iterable
from datetime import UTC, datetime
from pathlib import Path

VARYING = {
    "crc32": "of a line that holds a time",
    "versions": "of fdvv, Python and NumPy",
    "pressing_s": "how long the presses took by the clock of the wall",
    "stamp": "of a measured file: size and time",
}
"""Fields whose values differ from run to run, and why. Their presence counts."""
EPOCH_s = 1.6e9
"""Larger numbers of seconds are times of the wall."""
VARYING_TEXT = {
    r"\d{4}-\d\d-\d\d[T ]\d\d:\d\d(:\d\d(\.\d+)?)?(Z|[+-]\d\d:?\d\d)?": "<time>",
    r"(?<=[\"#])[a-z][0-9a-f]{10}(?=[\")])": "<name>",  # Matplotlib names what it draws at random
    r"\b[0-9a-f]{4}(-[0-9a-f]{4}){3}\b": "<fingerprint>",  # of a study, which has random keys
    r"(?<=report\.html, )\d+ s": "<duration>",
    r"\b24\d{5}\.\d+\b": "<day>",  # a DXF's Julian date
    r"\{[0-9A-F]{8}(-[0-9A-F]{4}){3}-[0-9A-F]{12}\}": "<id>",  # a DXF's name
}


class Normaliser:
    """Replaces what differs between two runs of the same code.

    paths : by what stands for them. fields : of JSON, whose values vary too.
    """

    def __init__(self, paths: dict[str, Path], fields: Iterable[str] = ()) -> None:
        self._fields = {*VARYING, *fields}
        self._names = sorted(((str(path), f"<{name}>") for name, path in paths.items()), key=longest_first)
        self._names.append((datetime.now(UTC).date().isoformat(), "<today>"))

    def text(self, text: str) -> str:
        for pattern, name in VARYING_TEXT.items():
            text = re.sub(pattern, name, text)
        for path, name in self._names:
            text = text.replace(path, name)
        return text

    def value(self, value: object) -> object:
        if isinstance(value, dict):
            return {
                self.text(key): f"<{key}>" if self._varies(key, item) else self.value(item)
                for key, item in value.items()
            }
        if isinstance(value, list):
            return [self.value(item) for item in value]
        return self.text(value) if isinstance(value, str) else value

    def _varies(self, key: str, value: object) -> bool:
        of_the_wall = key.endswith("_s") and isinstance(value, int | float) and value > EPOCH_s
        return key in self._fields or of_the_wall


def longest_first(named: tuple[str, str]) -> int:
    return -len(named[0])
