"""The structures of the compiled simulations, as Python reads them from the headers."""

from __future__ import annotations

import ctypes
import re
from pathlib import Path

import pytest

import fdvv._native
from fdvv._native import library
from fdvv._native.structures import structure
from fdvv.twin.button_kernel import BUTTON_COLUMNS, CELL_COLUMNS
from fdvv.twin.rig_kernel import RIG_COLUMNS, TICK_COLUMNS

FOLDER = Path(fdvv._native.__file__).parent
TEXT = "".join((FOLDER / name).read_text() for name in ("rig.h", "button.h", "twin.h"))


@pytest.mark.parametrize(
    ("function", "names"),
    [
        ("fdvv_rig_sizes", ("fdvv_rig_model", "fdvv_rig_grid", None)),
        ("fdvv_twin_sizes", ("fdvv_twin_press_plan", "fdvv_twin_noise", None)),
        ("fdvv_button_sizes", ("fdvv_button_model", "fdvv_button_grid")),
    ],
)
def test_a_structure_has_the_size_the_compiler_gave_it(function: str, names: tuple[str | None, ...]) -> None:
    sizes = [ctypes.c_int64() for _ in names]
    getattr(library(), function)(*(ctypes.byref(size) for size in sizes))
    for size, name in zip(sizes, names, strict=True):
        assert name is None or size.value == ctypes.sizeof(structure(name))


@pytest.mark.parametrize(
    ("last", "count"), [("FDVV_RIG_COLUMNS", RIG_COLUMNS), ("FDVV_RIG_TICK_COLUMNS", TICK_COLUMNS)]
)
def test_a_row_has_as_many_columns_as_the_header_names(last: str, count: int) -> None:
    names = re.search(r"enum \{([^}]*)\b" + last + r"\b", TEXT)
    assert names is not None
    assert len(re.findall(r"FDVV_\w+", names[1].rpartition("enum {")[2])) == count


def test_columns_and_cells_of_the_button_are_as_many_as_the_header_says() -> None:
    assert f"#define FDVV_BUTTON_COLUMNS {BUTTON_COLUMNS}\n" in TEXT
    assert f"#define FDVV_BUTTON_CELL {CELL_COLUMNS}\n" in TEXT
