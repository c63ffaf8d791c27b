"""The package of a rig of one's own: its own tests pass as it is written."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from fdvv.device.own_package import write_package
from fdvv.device.own_rig import find_rig
from fdvv.errors import InputError


def test_the_rig_of_a_new_package_can_be_opened_and_marks_what_to_replace(tmp_path: Path) -> None:
    rig, *others = write_package("my-rig", tmp_path / "new")
    assert rig.read_text().count("REPLACE") == 4
    assert len(rig.read_text().splitlines()) <= 60
    assert find_rig(f"{rig}:Rig")().numbers.name == "my-rig"
    assert all(path.exists() and "$" not in path.read_text() for path in (rig, *others))


@pytest.mark.slow
def test_a_new_package_passes_its_own_tests(tmp_path: Path) -> None:
    write_package("my-rig", tmp_path / "new")
    environment = os.environ | {"PYTHONPATH": str(tmp_path / "new" / "src")}
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "tests"]
    ended = subprocess.run(command, cwd=tmp_path / "new", env=environment, capture_output=True, text=True)
    assert ended.returncode == 0, ended.stdout
    assert "passed" in ended.stdout


@pytest.mark.parametrize("name", ["My Rig", "twin", "class", "../x", "", "emulated"])
def test_a_name_that_cannot_be_used_writes_nothing(name: str, tmp_path: Path) -> None:
    with pytest.raises(InputError):
        write_package(name, tmp_path / "new")
    assert not (tmp_path / "new").exists()


def test_a_folder_that_holds_something_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "mine.txt").write_text("mine")
    with pytest.raises(InputError, match="exists and is not empty"):
        write_package("my-rig", tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["mine.txt"]
