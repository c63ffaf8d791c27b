from __future__ import annotations

import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fdvv.errors import InputError
from fdvv.formats.force import read as reading
from fdvv.formats.force.read import read_force_file
from fdvv.formats.force.types import ForceFile
from tests.formats import conftest as files


def read(folder: Path, x: Any, force: Any) -> ForceFile:
    rows = [f"{a!r},{b!r}" for a, b in zip(np.asarray(x).tolist(), np.asarray(force).tolist(), strict=True)]
    return read_force_file(files.write(folder, "p.csv", "\n".join(["x_mm,force_cN", *rows])))


def fine_run() -> tuple[Any, Any]:
    """A click bar on a 5 um grid: climbs 30 cN over 0.8 mm, drops it between two samples."""
    x = np.round(np.arange(0.0, 3.5001, 0.005), 4)
    force = np.where(x < 0.05, 0.0, 40.0 + 5.0 * x) + 800.0 * np.maximum(x - 3.3, 0.0)
    force = force + np.where((x > 1.0) & (x < 1.8), (x - 1.0) * 37.5, 0.0)
    return np.concatenate((x, x[::-1])), np.concatenate((force, np.maximum(force[::-1] - 4.0, 0.0)))


def test_the_drop_of_a_click_bar_is_left_alone(tmp_path: Path) -> None:
    x, force = fine_run()
    file = read(tmp_path, x, force)
    assert file.warnings == ()
    assert np.diff(files.press(file).force_cN).min() == pytest.approx(-29.8, abs=0.2)
    assert files.press(file).displacement_mm.size == 701


def test_a_spike_is_left_out_and_reported(tmp_path: Path) -> None:
    x, force = fine_run()
    force[400:402] = -200.0
    file = read(tmp_path, x, force)
    (warning,) = file.warnings
    assert (
        "press of run from 2.000 to 2.005 mm: the force leaps to -200.0 cN and back; 2 samples were"
        in warning
    )
    assert files.press(file).force_cN.min() == 0.0
    assert files.press(file).displacement_mm.size == 699


def test_a_probe_that_sticks_is_distinguished_from_a_click(tmp_path: Path) -> None:
    x, force = fine_run()
    climb = slice(120, 160)  # 0.6 to 0.8 mm, 500 cN/mm
    force[climb] += 500.0 * (x[climb] - x[119])
    file = read(tmp_path, x, force)
    (warning,) = file.warnings
    assert "the probe stuck, the force climbs to 144.0 cN" in warning
    assert files.press(file).force_cN[(x[:701] < 0.9)[: files.press(file).force_cN.size]].max() < 50.0


def test_a_stiff_tact_switch_keeps_its_snap(tmp_path: Path) -> None:
    x = np.round(np.arange(0.0, 0.5, 0.005), 4)
    force = np.where(x < 0.03, 0.0, np.where(x < 0.25, 700.0 * (x - 0.03), 90.0 + 900.0 * (x - 0.25)))
    both = np.concatenate((x, x[::-1])), np.concatenate((force, force[::-1] * 0.9))
    assert read(tmp_path, *both).warnings == ()


def test_a_lost_tare_at_the_end_is_cut_off(tmp_path: Path) -> None:
    x, force = files.run()
    x = np.concatenate((x, np.full(30, -0.1)))
    force = np.concatenate((force, np.full(30, -16.0)))
    file = read(tmp_path, x, force)
    assert file.warnings == (
        "release of run, ends at -16.0 cN in the air, the tare was lost; 30 samples were left out",
    )


def test_text_cells_are_left_out_with_their_place_and_number(tmp_path: Path) -> None:
    lines = files.tidy().split("\n")
    lines[10] = "--,0.2,0,Oak"
    lines[20] = "nan,0.4,0,Oak"
    file = read_force_file(files.write(tmp_path, "a.csv", "\n".join(lines)))
    assert file.warnings == ("line 11, column 1: '--' is no usable number; 2 such rows of 302 were left out",)


def test_text_in_a_spreadsheet_is_left_out_too(tmp_path: Path) -> None:
    rows = files.raw_rows("A")
    rows[7][2] = "no data"
    file = read_force_file(files.write(tmp_path, "a.ods", files.ods(rows)))
    assert file.warnings == (
        "row 8, column 3: 'no data' is no usable number; 1 such rows of 302 were left out",
    )


def test_a_stage_that_wavers_keeps_every_sample_where_it_was(tmp_path: Path) -> None:
    x, force = files.run()
    x[60:64] -= 0.06
    file = read(tmp_path, x, force)
    # 60 um against the stage, 20 um of which it would have advanced
    assert "wavers back by up to 0.040 mm" in file.warnings[0]
    kept = files.press(file)
    pairs = set(zip(kept.displacement_mm.tolist(), kept.force_cN.tolist(), strict=True))
    assert pairs == set(zip(np.round(x[:151], 9).tolist(), force[:151].tolist(), strict=True))


def test_a_missing_stretch_is_reported_and_not_made_up(tmp_path: Path) -> None:
    x, force = files.run()
    keep = ~((x > 1.0) & (x < 1.9) & (np.arange(x.size) < 151))
    file = read(tmp_path, x[keep], force[keep])
    assert "press of run: displacement jumps by 0.90 mm, from 1.00 to 1.90 mm" in file.warnings[0]
    assert files.press(file).displacement_mm.size == int(keep[:151].sum())


def test_a_stray_position_is_left_out(tmp_path: Path) -> None:
    x, force = files.run()
    x[50] = 40.0
    file = read(tmp_path, x, force)
    assert "run, sample 51: displacement jumps to 40.000 mm and back; 1 sample was left out" in file.warnings
    assert files.press(file).displacement_mm.max() == 3.0


def test_axes_that_point_the_other_way_are_turned(tmp_path: Path) -> None:
    x, force = files.run()
    height = read(tmp_path, 10.0 - x, force)
    assert "displacement counts outwards" in height.warnings[0]
    np.testing.assert_allclose(files.press(height).displacement_mm, files.stroke()[0] - 10.0)
    pull = read(tmp_path, x, -force)
    assert "counts a push as negative" in pull.warnings[0]
    np.testing.assert_allclose(files.press(pull).force_cN, files.stroke()[1])


@pytest.mark.parametrize(("edges", "message"), [(7, "the contact chatters, 7 edges"), (0, "never closed")])
def test_a_contact_without_one_edge_gives_no_point(edges: int, message: str, tmp_path: Path) -> None:
    x, force = files.run()
    contact = np.zeros(x.size, dtype=int)
    for i in range(edges):
        contact[80 + 3 * i : 200] = 1 - contact[80 + 3 * i]
    rows = [f"{round(1000 * a)},{b},{c}" for a, b, c in zip(x, force, contact, strict=True)]
    file = read_force_file(files.write(tmp_path, "a.csv", "\n".join(["x_um,force_gf,actuated", *rows])))
    assert file.cycles[0].actuation_mm is None
    assert any(message in warning for warning in file.warnings)


def test_a_copied_release_is_anchored_at_its_release_point(tmp_path: Path) -> None:
    file = read_force_file(files.write(tmp_path, "a.json", files.tester_json()))
    release = file.cycles[0].release
    assert release is not None
    # the tester had already stepped back once when it took the first sample
    np.testing.assert_allclose(release.displacement_mm, files.stroke()[0] - 0.02, atol=1e-12)
    assert release.force_cN[-1] > release.force_cN[5]
    assert "anchored at the release point (sample 81 at 1.38 mm)" in file.warnings[0]


def test_a_copied_release_without_its_point_is_refused_aloud(tmp_path: Path) -> None:
    text = files.tester_json().replace("releasePoint", "elsewhere")
    file = read_force_file(files.write(tmp_path, "a.json", text))
    assert file.cycles[0].release is None
    assert "the release was refused" in file.warnings[0]


def test_a_slipped_position_counter_is_put_back(tmp_path: Path) -> None:
    text = files.haata(shifts=(0.0, 0.0, 0.0, 0.0)).split("\r\n")
    for i in range(1, len(text) - 1):
        cells = text[i].split(",")
        if cells[4] != '""':
            cells[4] = f'"{float(cells[4].strip(chr(34))) + 2.0:.3f}"'
        # the release begins on the slipped scale, then leaps off the stop with the force still held
        if i in (1, 2):
            cells[6], cells[7] = f'"{5.0 + 0.01 * i}"', '"225"'
        text[i] = ",".join(cells)
    file = read_force_file(files.write(tmp_path, "a.csv", "\r\n".join(text)))
    warnings = [warning for warning in file.warnings if "slipped" in warning]
    assert len(warnings) == 1
    assert warnings[0].startswith("Press 2: the position counter slipped by 2.00 mm")
    assert files.press(file, 1).displacement_mm[5] == pytest.approx(0.12, abs=1e-9)


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"", "it is empty"),
        (b"\x89PNG\r\n\x1a\n" + bytes(50), "it is a PNG image"),
        (bytes(range(256)) * 8, "it is a binary file"),
        (b"hello\nworld\n", "no header names a displacement and a force"),
        (b"{", "not JSON"),
        (b'{"a": 1}', "JSON without down_x and down_y"),
        (b"[" * 100_000, "not JSON"),
        (b"PK\x03\x04 broken", "the .ods archive is damaged"),
        (b"x_mm,force_cN\n1,2\n", "only 1 of 1 rows hold numbers"),
        (b"x_mm,force_cN\n" + b"1,2\n" * 50, "no stroke in it"),
        (b"0.0000,1.0000\n0.0050,2.0000\n", "two columns without a header"),
    ],
)
def test_what_cannot_be_read_is_refused_in_one_line(content: bytes, reason: str, tmp_path: Path) -> None:
    path = files.write(tmp_path, "a.csv", content)
    with pytest.raises(InputError, match=reason) as caught:
        read_force_file(path)
    assert str(caught.value).startswith(str(path))
    assert "\n" not in str(caught.value)


def test_a_missing_file_a_folder_and_an_impossible_path_are_refused(tmp_path: Path) -> None:
    for path in (tmp_path / "none.csv", tmp_path, "a\x00b.csv"):
        with pytest.raises(InputError):
            read_force_file(path)


def test_a_huge_file_is_not_even_opened(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reading, "LARGEST_FILE", 1000)
    with pytest.raises(InputError, match="at most"):
        read_force_file(files.write(tmp_path, "a.csv", files.tidy()))


def test_zip_bombs_are_refused_before_they_unfold(tmp_path: Path) -> None:
    cell = (
        '<table:table-cell table:number-columns-repeated="9000" office:value-type="float" office:value="1"/>'
    )
    row = f'<table:table-row table:number-rows-repeated="1000000">{cell}</table:table-row>'
    with pytest.raises(InputError, match="repeats unfold"):
        read_force_file(files.write(tmp_path, "a.ods", files.ods_from_xml(row)))
    with zipfile.ZipFile(tmp_path / "b.ods", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("content.xml", bytes(70 * 2**20))
    with pytest.raises(InputError, match="it unpacks to 70 MiB"):
        read_force_file(tmp_path / "b.ods")
    with zipfile.ZipFile(tmp_path / "c.ods", "w") as archive:
        archive.writestr("word.xml", b"x")
    with pytest.raises(InputError, match="but no"):
        read_force_file(tmp_path / "c.ods")
