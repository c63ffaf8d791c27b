"""What users install: the wheel."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[1]


@pytest.mark.slow
@pytest.mark.timeout(300)
def test_the_wheel_holds_all_it_needs_and_works_without_the_repository(tmp_path: Path) -> None:
    pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "-q"]
    subprocess.run([*pip, "wheel", "--no-deps", "-w", str(tmp_path), str(REPOSITORY)], check=True)
    (wheel,) = tmp_path.glob("fdvv-*.whl")
    names = zipfile.ZipFile(wheel).namelist()
    for needed in (
        "_native/libfdvv.so",
        "_native/fdvv-host",
        "model/builtin/mx-clear.fdvv.json",
        "study/words.toml",
        "study/templates/realism.toml",
        "study/templates/buttons/mx-red.fdvv.json",
        "twin/rigs/default.toml",
        "twin/rigs/light.toml",
        "twin/rigs/paper.toml",
        "twin/fingers/paper.toml",
        "py.typed",
    ):
        assert f"fdvv/{needed}" in names
    place = tmp_path / "place"
    subprocess.run([*pip, "install", "--no-deps", "--target", str(place), str(wheel)], check=True)
    assert os.access(place / "fdvv" / "_native" / "fdvv-host", os.X_OK)
    # the dependencies come from this environment, fdvv itself from the wheel alone
    code = (
        f"import sys; sys.path.insert(0, {str(place)!r}); import fdvv; from fdvv.cli import main; "
        "print(fdvv.__file__); main()"
    )
    run = [sys.executable, "-c", code, "library", "--json"]
    out = subprocess.run(run, capture_output=True, text=True, check=True, cwd=tmp_path).stdout
    where, _, document = out.partition("\n")
    assert Path(where).is_relative_to(place)
    assert "mx-clear" in [button["name"] for button in json.loads(document)["buttons"]]
