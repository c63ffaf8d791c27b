"""Values as text of which a difference can be read: long lists by what describes them, and a digest."""

from __future__ import annotations

import base64
import hashlib
import json
import math
import re
import zlib
from collections import Counter
from collections.abc import Sequence
from itertools import chain
from typing import Any

SHORT_list = 8
LINE_letters = 100
TABLE_rows = 3
REPEAT_lines = 3
TEXT_letters = 1000
DIGITS = 12

PACKED = re.compile(r"(<[fi][248]):([\w+/=]+)")
"""Of an array, as recordings hold it: its kind, and its bytes compressed."""

Number = int | float


def digest(value: object) -> str:
    """Return a mark of a value: it differs where one bit does."""
    data = value if isinstance(value, bytes) else json.dumps(value, ensure_ascii=False).encode()
    return "#" + hashlib.sha256(data).hexdigest()[:DIGITS]


def lines_of(value: object) -> list[str]:
    """Return a value of JSON as indented lines, keys in their order."""
    if isinstance(value, dict):
        lines = (entry_lines(key, lines_of(item), is_plain(item)) for key, item in value.items())
        return list(chain.from_iterable(lines)) or ["{}"]
    if isinstance(value, list):
        return list_lines(value)
    return [scalar(value)]


def entry_lines(key: str, lines: list[str], plain: bool) -> list[str]:
    """Return the lines of a key and its value. plain : a line of the value follows its key."""
    if plain and len(lines) == 1:
        return [f"{key}: {lines[0]}"]
    return [f"{key}:", *(f"  {line}" for line in lines)]


def is_plain(value: object) -> bool:
    """Return whether a value in one line needs no line of its own: it has no keys."""
    if isinstance(value, list):
        return not any(isinstance(item, dict | list) for item in value) or flat_numbers(value) is not None
    return not isinstance(value, dict) or not value


def list_lines(values: list[Any]) -> list[str]:
    """Return a list: in a line where it is short, by column where it is a table, else item by item."""
    if len(values) >= TABLE_rows and values.count(values[0]) == len(values):
        first, *others = lines_of(values[0])
        return [f"{len(values)} x {first}", *(f"  {line}" for line in others)]
    if not any(isinstance(value, dict | list) for value in values):
        return [flat_list(values)]
    if (numbers := flat_numbers(values)) and len(numbers) > SHORT_list:
        return [f"{len(values)} lists of {describe_numbers(numbers)}"]
    if not all(isinstance(value, dict) and value for value in values):
        return [line for value in values for line in item_lines(lines_of(value))]
    forms: dict[tuple[str, ...], list[dict[str, Any]]] = {}
    for value in values:
        forms.setdefault(tuple(value), []).append(value)
    if len(forms) == 1 and len(values) >= TABLE_rows:
        return table_lines(values)
    if len(values) < TABLE_rows * len(forms):
        return [line for value in values for line in item_lines(lines_of(value))]
    order = digest([list(value) for value in values])
    tables = [line for records in forms.values() for line in item_lines(table_lines(records))]
    return [f"{len(values)} records of {len(forms)} forms {order}:", *tables]


def table_lines(records: Sequence[dict[str, Any]]) -> list[str]:
    """Return records with the same fields by column."""
    lines = [f"{len(records)} records:"]
    for name in records[0]:
        values = [record[name] for record in records]
        lines += entry_lines(name, list_lines(values), is_plain(values))
    return lines


def item_lines(lines: list[str]) -> list[str]:
    return [f"- {lines[0]}", *(f"  {line}" for line in lines[1:])]


def flat_list(values: list[Any]) -> str:
    """Return a list of scalars in one line."""
    line = f"[{', '.join(map(scalar, values))}]"
    if len(values) <= SHORT_list and len(line) <= LINE_letters:
        return line
    if all(is_number(value) or value is None for value in values):
        return describe_numbers(values)
    counted = Counter(map(scalar, values))
    kinds = ", ".join(f"{text} x{count}" for text, count in counted.most_common(4))
    return f"{len(values)} values, {len(counted)} different: {kinds} {digest(values)}"


def describe_numbers(values: Sequence[Number | None]) -> str:
    """Return how many numbers there are, first, last, their root mean square and their digest."""
    known = [value for value in values if value is not None and math.isfinite(value)]
    count = f"{len(values)} numbers" + (f" ({len(known)} finite)" if len(known) < len(values) else "")
    if not known:
        return f"{count} {digest(values)}"
    # scaled, so that no square overflows
    scale = max(map(abs, known)) or 1.0
    rms = scale * math.sqrt(math.fsum((value / scale) ** 2 for value in known) / len(known))
    return f"{count}: {known[0]:.12g} ... {known[-1]:.12g}, rms {rms:.12g} {digest(values)}"


def flat_numbers(values: Sequence[Any]) -> list[Number | None] | None:
    """Return the numbers in lists of lists, in their order; None where anything else is in them."""
    numbers: list[Number | None] = []
    for value in values:
        inner = flat_numbers(value) if isinstance(value, list) else None
        if inner is not None:
            numbers += inner
        elif is_number(value) or value is None:
            numbers.append(value)
        else:
            return None
    return numbers


def is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def scalar(value: object) -> str:
    """Return a scalar as JSON, a long text by its beginning."""
    if isinstance(value, str) and (packed := PACKED.fullmatch(value)):
        return describe_numbers(unpack(*packed.groups()))
    if isinstance(value, str) and len(value) > TEXT_letters:
        return f"{json.dumps(value[:80], ensure_ascii=False)}... {len(value)} letters {digest(value)}"
    return json.dumps(value, ensure_ascii=False, default=str)


def unpack(kind: str, text: str) -> list[Number | None]:
    """Return the numbers of a compressed array: another zlib compresses them otherwise."""
    import numpy as np

    numbers: list[Number | None] = np.frombuffer(zlib.decompress(base64.b64decode(text)), kind).tolist()
    return numbers


def shorten_repeats(lines: list[str]) -> list[str]:
    """Return lines in which a block that was there before is a line, with its digest."""
    shortened, seen, number = [], set[str](), 0
    while number < len(lines):
        line = lines[number]
        indent = len(line) - len(line.lstrip())
        end = number + 1
        while line and end < len(lines) and lines[end].startswith(" " * (indent + 1)):
            end += 1
        block = "\n".join(text[indent:] for text in lines[number:end])
        if end - number > REPEAT_lines and block in seen:
            shortened.append(f"{line} ... as before {digest(block)}")
            number = end
        else:
            seen.add(block)
            shortened.append(line)
            number += 1
    return shortened
