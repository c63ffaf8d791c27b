"""The mirror of the compiled structures."""

from __future__ import annotations

import ctypes
import dataclasses
import re
from pathlib import Path

import fdvv._native
from fdvv._native import library
from fdvv.twin._kernel import COLUMNS, Grid, Plant, _Grid, _Model

HEADER = (Path(fdvv._native.__file__).parent / "fdvv.h").read_text()


def fields_in_header(struct: str) -> list[str]:
    """Name the numbers of a structure, those of structures inside it in their place."""
    body = HEADER[: HEADER.index(f"}} {struct};")].rpartition("typedef struct {")[2]
    names: list[str] = []
    for kind, name in re.findall(r"(double|int64_t|fdvv_\w+) (\w+);", body):
        names += fields_in_header(kind) if kind.startswith("fdvv_") else [name]
    return names


def test_both_structures_have_the_fields_of_the_header_in_order() -> None:
    assert fields_in_header("fdvv_twin_model") == [field.name for field in dataclasses.fields(Plant)]
    assert fields_in_header("fdvv_twin_grid") == [field.name for field in dataclasses.fields(Grid)]


def test_both_structures_have_the_size_the_compiler_gave_them() -> None:
    model, grid = ctypes.c_int64(), ctypes.c_int64()
    library().fdvv_twin_sizes(ctypes.byref(model), ctypes.byref(grid))
    assert (model.value, grid.value) == (ctypes.sizeof(_Model), ctypes.sizeof(_Grid))


def test_the_columns_of_a_row_are_as_many_as_the_header_says() -> None:
    assert f"#define FDVV_TWIN_COLUMNS {COLUMNS}\n" in HEADER
