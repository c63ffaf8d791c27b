"""Damaged files of every format: a valid curve or one line of refusal, nothing else."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from fdvv.errors import InputError
from fdvv.formats.force.average import average_by_velocity
from fdvv.formats.force.read import read_force_file
from tests.formats import conftest as files
from tests.support.campaign import pick
from tests.support.damage import DAMAGES, Damage

pytestmark = pytest.mark.campaign


def examples(usual: int) -> settings:
    """Draw so many examples in a usual run."""
    shared = [HealthCheck.function_scoped_fixture]
    return settings(max_examples=pick(usual, 2000), deadline=None, suppress_health_check=shared)


def check(path: Path) -> None:
    """Read a file: what comes out is valid, or one line says why nothing does."""
    refused = ""
    try:
        file = read_force_file(path)
    except InputError as error:
        refused = str(error)
    if refused:
        assert "\n" not in refused
        assert refused.startswith(str(path))
        return
    assert file.cycles
    assert all("\n" not in warning for warning in file.warnings)
    # a MeasuredCurve cannot be built wrong; that there is at least one is to be checked
    assert all(cycle.press is not None or cycle.release is not None for cycle in file.cycles)
    means = average_by_velocity(file)
    assert all(mean.used for mean in means)
    assert sum(len(mean.used) + len(mean.left_out) for mean in means) == len(file.cycles)


@pytest.mark.parametrize("name", files.TEXTS)
@given(damages=st.lists(DAMAGES, min_size=1, max_size=3))
@examples(60)
def test_a_mutilated_text_file_is_read_or_refused(name: str, tmp_path: Path, damages: list[Damage]) -> None:
    filename, text, _ = files.TEXTS[name]
    data = text().encode()
    for damage in damages:
        data = damage(data)
    check(files.write(tmp_path, filename, data))


@given(damages=st.lists(DAMAGES, min_size=1, max_size=2), inside=st.booleans())
@examples(60)
def test_a_mutilated_spreadsheet_is_read_or_refused(
    tmp_path: Path, damages: list[Damage], inside: bool
) -> None:
    rows = "".join(
        "<table:table-row>" + "".join(files._cell(value) for value in row) + "</table:table-row>\n"
        for row in files.raw_rows("A")[:120]
    ).encode()
    if inside:
        for damage in damages:
            rows = damage(rows)
    data = files.ods_from_xml(rows.decode("utf-8", errors="replace"))
    if not inside:
        for damage in damages:
            data = damage(data)
    check(files.write(tmp_path, "a.ods", data))


@given(data=st.binary(max_size=300))
@examples(150)
def test_any_bytes_at_all_are_read_or_refused(tmp_path: Path, data: bytes) -> None:
    check(files.write(tmp_path, "a.csv", data))


HEADERS = [
    "x_mm,force_cN",
    "x,force_N",
    "Press 1, x;y",
    "force,displacement,judge,name",
    "time_s,x_um,F_gf,closed",
]
CELL = st.one_of(st.floats(width=32).map(repr), st.sampled_from(["", "a", "1,5", '"', "NaN", "1e400", "-0"]))


@given(header=st.sampled_from(HEADERS), rows=st.lists(st.lists(CELL, max_size=5), max_size=40))
@examples(150)
def test_any_numbers_under_a_header_are_read_or_refused(
    tmp_path: Path, header: str, rows: list[list[str]]
) -> None:
    check(files.write(tmp_path, "a.csv", "\n".join([header, *(",".join(row) for row in rows)])))


def test_a_spreadsheet_whose_elements_are_not_closed_is_refused(tmp_path: Path) -> None:
    # the spreadsheet library would go on for ever
    path = files.write(tmp_path, "a.ods", files.ods_from_xml("<table:table-row><table:table-cell>"))
    with pytest.raises(InputError, match="not well formed"):
        read_force_file(path)
