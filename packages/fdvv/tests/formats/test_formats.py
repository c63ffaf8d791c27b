from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from fdvv.errors import InputError
from fdvv.formats.force.read import find_force_files, read_force_file
from fdvv.units import GRAM_FORCE_cN
from tests.formats import conftest as files


@pytest.mark.parametrize("name", files.TEXTS)
def test_a_file_of_each_format_is_known_by_its_content(name: str, tmp_path: Path) -> None:
    text = files.TEXTS[name].text
    suffix = ".downstroke.csv" if name == "stroke-pair" else ".txt"
    file = read_force_file(files.write(tmp_path, f"anything{suffix}", text()))
    assert file.format == name


@pytest.mark.parametrize("name", [name for name in files.TEXTS if name not in ("stroke-pair", "tester-json")])
def test_both_strokes_come_out_as_they_were_measured(name: str, tmp_path: Path) -> None:
    filename, text, scale_cN = files.TEXTS[name]
    file = read_force_file(files.write(tmp_path, filename, text()))
    x, force = files.stroke()
    lighter = np.round(np.maximum(force - 3.0, 0.0), 1)
    for measured, felt in ((file.cycles[0].press, force), (file.cycles[0].release, lighter)):
        assert measured is not None
        np.testing.assert_allclose(measured.displacement_mm, x, atol=1e-12)
        np.testing.assert_allclose(measured.force_cN, felt * scale_cN, atol=1e-9)


@pytest.mark.parametrize("name", [name for name in files.TEXTS if name not in ("stroke-pair", "tester-json")])
def test_blank_lines_at_the_top_count_in_the_line_numbers_of_warnings(name: str, tmp_path: Path) -> None:
    filename, text, _ = files.TEXTS[name]
    lines = text().splitlines()
    lines[49] = re.sub("[^,]+", "--", lines[49])
    for blank in (0, 3, 41):
        data = "\n".join([*[" "] * blank, *lines])
        warnings = read_force_file(files.write(tmp_path, filename, data)).warnings
        assert warnings[0].startswith(f"line {50 + blank}, column ")


def test_blank_lines_at_the_top_count_in_the_line_numbers_of_refusals(tmp_path: Path) -> None:
    for name, text, line in (("a.json", '{"down_x": [1,\n}', 5), ("b.csv", '"Press 1, x","Press 1, y"\n', 5)):
        with pytest.raises(InputError, match=f"line {line}"):
            read_force_file(files.write(tmp_path, name, "\n\n\n" + text))


@pytest.mark.parametrize("layout", ["A", "B", "C"])
def test_each_layout_of_spreadsheet_gives_the_same_run(layout: str, tmp_path: Path) -> None:
    file = read_force_file(files.write(tmp_path, "Oak.ods", files.ods(files.raw_rows(layout))))
    (cycle,) = file.cycles
    x, force = files.stroke()
    np.testing.assert_allclose(files.press(file).displacement_mm, x, atol=1e-12)
    np.testing.assert_allclose(files.press(file).force_cN, force * GRAM_FORCE_cN, atol=1e-9)
    assert (cycle.actuation_mm, cycle.reset_mm) == ((None, None) if layout == "C" else (1.5, 1.4))


def test_either_half_of_a_stroke_pair_brings_the_other(tmp_path: Path) -> None:
    down = files.write(tmp_path, "Oak.downstroke.csv", files.downstroke())
    up = files.write(tmp_path, "Oak.upstroke.csv", files.upstroke())
    assert find_force_files(tmp_path) == [down]
    for path in (down, up):
        file = read_force_file(path)
        assert (file.name, file.format, len(file.cycles)) == ("Oak", "stroke-pair", 1)
        release = file.cycles[0].release
        assert release is not None
        assert files.press(file).force_cN[-1] > release.force_cN[-1]


def test_a_lone_half_says_that_the_other_is_missing(tmp_path: Path) -> None:
    file = read_force_file(files.write(tmp_path, "Oak.upstroke.csv", files.upstroke()))
    assert file.cycles[0].press is None
    assert file.warnings == ("Oak.downstroke.csv is not there; the file holds the release only",)


def test_a_published_table_gives_one_cycle_per_velocity(tmp_path: Path) -> None:
    press = files.write(tmp_path, "fig_press.csv", files.velocities())
    files.write(tmp_path, "fig_release.csv", files.velocities())
    file = read_force_file(press)
    speeds = [(c.press and c.press.velocity_mm_s, c.release and c.release.velocity_mm_s) for c in file.cycles]
    assert speeds == [(0.5, 0.5), (50.0, 50.0)]
    _, force = files.stroke()
    np.testing.assert_allclose(files.press(file, 1).force_cN, np.round(force * 1.1, 3), atol=1e-12)


def test_timestamps_give_the_speed_of_the_stroke(tmp_path: Path) -> None:
    file = read_force_file(files.write(tmp_path, "log.csv", files.buddyog()))
    assert files.press(file).velocity_mm_s == pytest.approx(0.02 / 0.136, rel=0.01)


@pytest.mark.parametrize(
    ("header", "x_scale", "force_scale", "separator"),
    [
        ("displacement_mm,force_cN", 1.0, 1.0, ","),
        ("Travel [µm];Load (N)", 1000.0, 0.01, ";"),
        ("x (um)\tF (mN)", 1000.0, 10.0, "\t"),
        ("distance (m),force/g", 0.001, 1 / GRAM_FORCE_cN, ","),
        ("position in inches,force ozf", 1 / 25.4, 1 / (28.349523125 * GRAM_FORCE_cN), ","),
        ("depth_mm force_gf", 1.0, 1 / GRAM_FORCE_cN, " "),
    ],
)
def test_units_in_the_header_are_converted(
    header: str, x_scale: float, force_scale: float, separator: str, tmp_path: Path
) -> None:
    x, force = files.run()
    rows = [
        f"{a * x_scale!r}{separator}{b * force_scale!r}"
        for a, b in zip(x.tolist(), force.tolist(), strict=True)
    ]
    file = read_force_file(files.write(tmp_path, "p.csv", "\n".join([header, *rows])))
    np.testing.assert_allclose(files.press(file).displacement_mm, files.stroke()[0], atol=1e-8)
    np.testing.assert_allclose(files.press(file).force_cN, files.stroke()[1], atol=1e-9)
    assert file.warnings == ()


def test_a_decimal_comma_is_read_where_semicolons_separate(tmp_path: Path) -> None:
    x, force = files.run()
    rows = [f"{a};{b}".replace(".", ",") for a, b in zip(x.tolist(), force.tolist(), strict=True)]
    file = read_force_file(files.write(tmp_path, "p.csv", "\r\n".join(["Weg x (mm);Force (cN)", *rows])))
    np.testing.assert_allclose(files.press(file).force_cN, files.stroke()[1])


def test_a_length_without_unit_is_guessed_aloud_and_a_force_never(tmp_path: Path) -> None:
    x, force = files.run()
    rows = "\n".join(f"{a},{b}" for a, b in zip(1000 * x, force, strict=True))
    file = read_force_file(files.write(tmp_path, "a.csv", "travel,force_cN\n" + rows))
    assert "read as um" in file.warnings[0]
    with pytest.raises(InputError, match="force column 'force' has no unit"):
        read_force_file(files.write(tmp_path, "b.csv", "travel_mm,force\n" + rows))


def test_a_run_of_three_presses_gives_three_cycles(tmp_path: Path) -> None:
    x, force = files.run()
    rows = [f"{a},{b}" for a, b in zip(np.tile(x, 3), np.tile(force, 3), strict=True)]
    file = read_force_file(files.write(tmp_path, "p.csv", "\n".join(["x_mm,force_cN", *rows])))
    assert [cycle.label for cycle in file.cycles] == ["cycle 1", "cycle 2", "cycle 3"]
    for cycle in range(3):
        np.testing.assert_allclose(files.press(file, cycle).force_cN, files.stroke()[1])


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_marked_encodings_read_the_same(encoding: str, tmp_path: Path) -> None:
    path = files.write(tmp_path, "oak.csv", files.tidy().replace("Oak", "Öak").encode(encoding))
    file = read_force_file(path)
    assert (file.name, file.warnings) == ("Öak", ())


def test_latin_1_is_read_with_a_warning(tmp_path: Path) -> None:
    file = read_force_file(
        files.write(tmp_path, "oak.csv", files.tidy().replace("Oak", "Öak").encode("latin-1"))
    )
    assert file.name == "Öak"
    assert "not UTF-8" in file.warnings[0]


def test_candidates_leave_out_readmes_hidden_and_other_files(tmp_path: Path) -> None:
    for name in ("b.csv", "a.ods", "README.txt", "LICENSE-CC.txt", ".hidden.csv", "c.png", "d.JSON"):
        files.write(tmp_path / "sub", name, "x")
    found = [path.name for path in find_force_files(tmp_path)]
    assert found == ["a.ods", "b.csv", "d.JSON"]
    with pytest.raises(InputError, match="no such folder"):
        find_force_files(tmp_path / "nowhere")


def test_a_table_with_a_header_says_its_own_units_whatever_its_file_is_called(tmp_path: Path) -> None:
    rows = "".join(f"{0.1 * i:.4f},{30 + i:.4f}\n" for i in range(30))
    path = tmp_path / "x.downstroke.csv"
    path.write_text("displacement_mm,force_cN\n" + rows)
    read = read_force_file(path)
    assert read.format == "plain-csv"
    assert files.press(read).force_cN[0] == 30.0
