"""The mirror of the compiled button's structures."""

from __future__ import annotations

import ctypes
import dataclasses
import re
from pathlib import Path

import fdvv._native
from fdvv._native import library
from fdvv.twin._kernel_button import CELL, COLUMNS, PAIRS, ButtonGrid, ButtonPlant, _Grid, _Model

FOLDER = Path(fdvv._native.__file__).parent
HEADER = "".join((FOLDER / name).read_text() for name in ("fdvv.h", "button.h"))


def fields_in_header(struct: str) -> list[str]:
    """Name the numbers of a structure, those of structures inside it in their place."""
    body = HEADER[: HEADER.index(f"}} {struct};")].rpartition("typedef struct {")[2]
    names: list[str] = []
    for kind, name in re.findall(r"(double|int64_t|fdvv_\w+) (\w+)(?:\[2\])?;", body):
        names += fields_in_header(kind) if kind.startswith("fdvv_") else [name]
    return names


def test_both_structures_have_the_fields_of_the_header_in_order() -> None:
    assert fields_in_header("fdvv_button_model") == [f.name for f in dataclasses.fields(ButtonPlant)]
    assert fields_in_header("fdvv_button_grid") == [f.name for f in dataclasses.fields(ButtonGrid)]
    assert tuple(re.findall(r"double (\w+)\[2\];", HEADER)) == PAIRS


def test_both_structures_have_the_size_the_compiler_gave_them() -> None:
    model, grid = ctypes.c_int64(), ctypes.c_int64()
    library().fdvv_button_sizes(ctypes.byref(model), ctypes.byref(grid))
    assert (model.value, grid.value) == (ctypes.sizeof(_Model), ctypes.sizeof(_Grid))


def test_columns_and_cells_are_as_many_as_the_header_says() -> None:
    assert f"#define FDVV_BUTTON_COLUMNS {COLUMNS}\n" in HEADER
    assert f"#define FDVV_BUTTON_CELL {CELL}\n" in HEADER
