"""The file of a study, TOML that people write: reading it, and what is said of a broken one."""

from __future__ import annotations

import difflib
import re
import tomllib
from typing import Any

import msgspec

from fdvv.errors import InputError
from fdvv.study._plan import (
    Claim,
    Exclusion,
    Item,
    Page,
    Question,
    Rating,
    Staircase,
    Stimulus,
    StudyPlan,
)
from fdvv.study._plan_check import plan_problems

REMEDY = "see docs/reference/study-file.md, or begin with fdvv study new"
LIMIT_bytes = 1_000_000
TEXTS = ("title", "text", "question", "low", "high")

_PARTS: dict[str, type[msgspec.Struct]] = {
    "items": Item,
    "stimuli": Stimulus,
    "reference": Stimulus,
    "ratings": Rating,
    "pages": Page,
    "questions": Question,
    "staircase": Staircase,
    "exclusion": Exclusion,
    "claim": Claim,
}
"""What stands under a field's name, to tell which names it may hold."""


def read_plan_text(text: str, source: object) -> StudyPlan:
    """Read the TOML text of a study; `check_plan` tells whether it makes sense too.

    InputError names source, the place in it, and what to do: what is no TOML, an unknown or missing field, a
    value of the wrong kind or outside its range.
    """
    if len(text) > LIMIT_bytes:
        raise InputError(source, "whole file", f"longer than {LIMIT_bytes} characters", REMEDY)
    try:
        data = tomllib.loads(text.removeprefix("\ufeff"))
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise _not_toml(source, error) from error
    _check_head(data, source)
    try:
        return msgspec.convert(data, StudyPlan)
    except (msgspec.ValidationError, RecursionError) as error:
        raise _refused(data, source, error) from error


def check_plan(plan: StudyPlan, source: object) -> None:
    """Refuse a plan that cannot be run or analysed as it says. InputError tells all that is wrong."""
    problems = plan_problems(plan)
    if problems:
        place, _, reason = problems[0].partition(": ")
        more = f" (and {len(problems) - 1} more: {' | '.join(problems[1:])})" if problems[1:] else ""
        raise InputError(source, place, reason + more, REMEDY)


def _not_toml(source: object, error: Exception) -> InputError:
    """Take line and column out of the words of the parser."""
    found = re.fullmatch(r"(.*) \(at (.*)\)", str(error), re.DOTALL)
    reason, place = (found[1], found[2]) if found else (str(error), "whole file")
    return InputError(source, place, f"not valid TOML ({reason})", REMEDY)


def _check_head(data: dict[str, Any], source: object) -> None:
    """Refuse what is some other file, and versions to come, before anything is said of its fields."""
    if data.get("format", "fdvv-study") != "fdvv-study":
        reason = f'{data["format"]!r:.60} is not a study (it must be "fdvv-study")'
        raise InputError(source, "format", reason, REMEDY)
    if data.get("version", 1) != 1:
        reason = f"version {data['version']!r:.40}, this fdvv reads version 1"
        raise InputError(source, "version", reason, "install the fdvv that wrote it, or a newer one")


def _refused(data: dict[str, Any], source: object, error: Exception) -> InputError:
    """Say in the words of the file what msgspec refused."""
    reason, _, path = str(error).partition(" - at ")
    keys = re.findall(r"[A-Za-z_][\w-]*|\[\d*\]|\[\.\.\.\]", path.strip("`").removeprefix("$"))
    reason = (
        reason.replace("Object", "this table").replace("`object`", "a table").replace("`array`", "a list")
    )
    return InputError(source, _place(data, keys), reason, _remedy(reason, keys))


def _place(data: Any, keys: list[str]) -> str:
    """Write a place as items[2] ('MX Red'), stimuli[1] ('FD'): counted from 1, with the name if any."""
    told = []
    for key in keys:
        number = re.fullmatch(r"\[(\d+)\]", key)
        if not number:
            told.append(key)
            data = data.get(key) if isinstance(data, dict) else None
            continue
        index = int(number[1])
        data = data[index] if isinstance(data, list) and index < len(data) else None
        name = data.get("name") if isinstance(data, dict) else None
        told[-1:] = [f"{told[-1] if told else ''}[{index + 1}]" + (f" ({name!r:.62})" if name else "")]
    return ", ".join(told) or "whole file"


def _remedy(reason: str, keys: list[str]) -> str:
    """Tell what was probably meant."""
    unknown = re.search(r"unknown field `(.*)`", reason)
    if unknown:
        return _near(unknown[1], keys)
    if "Expected a table, got `str`" in reason and keys and keys[-1] in TEXTS:
        return f'give it by language, as {keys[-1]}.en = "…"'
    return REMEDY


def _near(name: str, keys: list[str]) -> str:
    """Name the field that was meant, or all there are."""
    words = [key for key in keys if not key.startswith("[")]
    kind = _PARTS.get(words[-1], StudyPlan) if words else StudyPlan
    known = [field.name for field in msgspec.structs.fields(kind)]
    near = difflib.get_close_matches(name, known, 1, 0.6)
    return f'did you mean "{near[0]}"?' if near else f"known are {', '.join(known)}"
