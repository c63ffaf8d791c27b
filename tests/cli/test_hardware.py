"""fdvv hardware: what it lists, what it checks, what it says when it cannot."""

import importlib.util
import shutil
import sys
from pathlib import Path

import pytest

from tests.support.command_line import Run

HARDWARE = Path(__file__).resolve().parents[2] / "hardware"
WITHOUT_KERNEL = importlib.util.find_spec("build123d") is None


def test_the_parts_are_listed(fdvv: Run) -> None:
    ran = fdvv("hardware", "parts")
    assert ran.status == 0
    assert "coil-mount" in ran.out


def test_dimensions_are_printed_as_toml_that_reads_back(fdvv: Run, tmp_path: Path) -> None:
    text = fdvv("hardware", "parts", "--dimensions", "--set", "coil_diameter_mm=25").out
    (tmp_path / "mine.toml").write_text(text)
    dimensions = fdvv("hardware", "parts", "--dimensions", "--from", "mine.toml", "--json").json["dimensions"]
    assert dimensions["coil_diameter_mm"]["value"] == 25.0
    assert dimensions["travel_mm"]["source"] == "paper"


def test_a_dimension_that_is_none_is_refused_with_the_nearest(fdvv: Run, tmp_path: Path) -> None:
    ran = fdvv("hardware", "export", str(tmp_path / "out"), "--set", "coil_diametre_mm=25")
    assert ran.status == 2
    assert "did you mean coil_diameter_mm?" in ran.err
    assert not (tmp_path / "out").exists()


def test_dimensions_without_what_they_are_for_are_refused(fdvv: Run) -> None:
    assert fdvv("hardware", "parts", "--set", "travel_mm=4").status == 2


@pytest.mark.skipif(not WITHOUT_KERNEL, reason="the CAD kernel is installed")
def test_without_the_kernel_export_says_in_one_line_what_to_install(fdvv: Run, tmp_path: Path) -> None:
    ran = fdvv("hardware", "export", str(tmp_path / "out"))
    assert ran.status == 1
    assert 'pip install "fdvv-rig[cad]"' in ran.err
    assert not (tmp_path / "out").exists()


def test_a_folder_without_parts_is_refused(fdvv: Run, tmp_path: Path) -> None:
    ran = fdvv("hardware", "check", str(tmp_path))
    assert ran.status == 2
    assert "holds no manifest.json" in ran.err


@pytest.mark.slow
def test_an_open_part_gives_status_1(fdvv: Run, tmp_path: Path) -> None:
    pytest.importorskip("manifold3d", reason="manifold3d is not installed")
    folder = tmp_path / "mine"
    shutil.copytree(HARDWARE, folder, ignore=shutil.ignore_patterns("pictures"))
    path = folder / "parts" / "limiter-arm.stl"
    data = path.read_bytes()
    count = int.from_bytes(data[80:84], "little") - 1
    path.write_bytes(data[:80] + count.to_bytes(4, "little") + data[84 : 84 + 50 * count])
    ran = fdvv("hardware", "check", str(folder))
    assert ran.status == 1
    assert "open at 3 edges" in ran.out
    assert "limiter-arm.stl is not the file that was exported" in ran.out


def test_without_manifold3d_check_says_in_one_line_what_to_install(
    fdvv: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "manifold3d", None)
    ran = fdvv("hardware", "check", str(HARDWARE))
    assert ran.status == 1
    assert "pip install manifold3d" in ran.err
