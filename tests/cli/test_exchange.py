"""fdvv export and import, as a person runs them."""

from pathlib import Path

import pytest

from fdvv.model.file import load_builtin, load_model
from tests.support.command_line import Run


def test_the_formats_are_listed(fdvv: Run) -> None:
    ran = fdvv("export", "--list")
    assert ran.status == 0
    for name in ("mjcf", "smartknob", "ahap", "haptic", "hjif", "bluepylons-csv"):
        assert name in ran.out


def test_a_button_is_exported_and_its_losses_are_listed(fdvv: Run, tmp_path: Path) -> None:
    ran = fdvv("export", "mx-clear", "-o", "a.xml")
    assert ran.status == 0
    assert "lost: " in ran.out
    assert "friction_cN" in ran.out
    assert (tmp_path / "a.xml").read_text().startswith('<mujoco model="mx-clear">')


def test_out_and_in_again(fdvv: Run, tmp_path: Path) -> None:
    assert fdvv("export", "rubber-dome", "-o", "a.csv").status == 0
    ran = fdvv("import", "a.csv", "--name", "dome", "-o", "dome.fdvv.json")
    assert ran.status == 0
    assert "dome, from plain-csv: 10 curves, 0 vibrations" in ran.out
    found = load_model(tmp_path / "dome.fdvv.json")
    assert found.velocities_mm_s("press") == load_builtin("rubber-dome").velocities_mm_s("press")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("export", "mx-clear", "-o", "a.txt"), "tells no format"),
        (("export", "mx-clear", "--to", "ahap", "-o", "a.csv"), "end it in .ahap"),
        (("export", "nobody", "-o", "a.csv"), "no such file or built-in button"),
        (("import", "gone.csv", "-o", "b.fdvv.json"), "does not exist"),
        (("import", "empty", "-o", "b.txt"), "end it in .fdvv.json"),
    ],
)
def test_mistakes_are_reported_in_one_line_and_leave_nothing(
    fdvv: Run, tmp_path: Path, arguments: tuple[str, ...], message: str
) -> None:
    (tmp_path / "empty").touch()
    ran = fdvv(*arguments)
    assert ran.status == 2
    assert ran.out == ""
    assert ran.err.count("\n") == 1
    assert message in ran.err
    assert [p.name for p in tmp_path.iterdir()] == ["empty"]


def test_an_import_does_not_overwrite_its_file(fdvv: Run, tmp_path: Path) -> None:
    fdvv("export", "mx-red", "--to", "csv", "-o", "a.csv")
    (tmp_path / "a.csv").rename(tmp_path / "a.fdvv.json")
    ran = fdvv("import", "a.fdvv.json", "-o", "a.fdvv.json")
    assert ran.status == 2
    assert "is the file itself" in ran.err
