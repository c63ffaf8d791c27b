"""The mirror of the compiled structures."""

from __future__ import annotations

import ctypes
import dataclasses
import re
from pathlib import Path

import pytest

import fdvv._native
from fdvv.core import OUTPUTS
from fdvv.twin._kernel import (
    COLUMNS,
    TICK_COLUMNS,
    GestureTimes,
    Grid,
    GridCounts,
    Model,
    NoiseArrays,
    Plant,
    _Plan,
    doors,
)

FOLDER = Path(fdvv._native.__file__).parent
TEXT = "".join((FOLDER / name).read_text() for name in ("fdvv.h", "rig.h", "twin.h"))


def fields_in_header(struct: str) -> list[str]:
    """Name the numbers of a structure, those of structures inside it in their place."""
    body = TEXT[: TEXT.index(f"}} {struct};")].rpartition("typedef struct {")[2]
    names: list[str] = []
    for kind, name in re.findall(r"(double|int64_t|fdvv_\w+) \*?(\w+);", body):
        names += fields_in_header(kind) if kind.startswith("fdvv_") else [name]
    return names


def test_every_structure_has_the_fields_of_the_header_in_order() -> None:
    assert fields_in_header("fdvv_rig_model") == [field.name for field in dataclasses.fields(Plant)]
    assert fields_in_header("fdvv_rig_grid") == [field.name for field in dataclasses.fields(Grid)]
    assert fields_in_header("fdvv_gesture") == list(GestureTimes.NAMES)
    plan = [field[0] for field in _Plan._fields_][1:]
    assert fields_in_header("fdvv_twin_press_plan") == [*GestureTimes.NAMES, *plan]
    assert fields_in_header("fdvv_twin_noise") == [field[0] for field in NoiseArrays._fields_]


def test_every_structure_has_the_size_the_compiler_gave_it() -> None:
    sizes = [ctypes.c_int64() for _ in range(6)]
    doors().fdvv_rig_sizes(*(ctypes.byref(size) for size in sizes[:3]))
    doors().fdvv_twin_sizes(*(ctypes.byref(size) for size in sizes[3:]))
    ours = [ctypes.sizeof(part) for part in (Model, GridCounts, _Plan, NoiseArrays)] + [OUTPUTS.itemsize]
    assert [size.value for size in sizes[:2] + sizes[3:]] == ours


@pytest.mark.parametrize(("last", "count"), [("FDVV_RIG_COLUMNS", COLUMNS), ("FDVV_RIG_TOLD", TICK_COLUMNS)])
def test_a_row_has_as_many_columns_as_the_header_names(last: str, count: int) -> None:
    names = re.search(r"enum \{([^}]*)\b" + last + r"\b", TEXT)
    assert names is not None
    assert len(re.findall(r"FDVV_\w+", names[1].rpartition("enum {")[2])) == count
