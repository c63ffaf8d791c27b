"""What the page on ways to learn shows is a package that `fdvv compensate` finds."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tomllib
from pathlib import Path

from tests.docs.pages import DOCS, blocks_of

PAGE = DOCS / "how-to" / "add-a-way-to-learn.md"
WHOLE_lines = 150
"""Of a way to learn, most."""


def test_a_way_to_learn_is_one_file_that_the_command_finds(tmp_path: Path) -> None:
    method, make = (block.text for block in blocks_of(PAGE) if block.language == "python")
    (toml,) = (block.text for block in blocks_of(PAGE) if block.language == "toml")
    package, about = tmp_path / "my_package", tmp_path / "my_package-1.dist-info"
    package.mkdir()
    about.mkdir()
    # what the page tries it with is no part of it
    source = f"{method.partition('device, model =')[0]}\n{make}"
    assert source.count("\n") <= WHOLE_lines
    (package / "half.py").write_text(source)
    ((group, entries),) = tomllib.loads(toml)["project"]["entry-points"].items()
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: my-package\nVersion: 1\n")
    lines = [f"[{group}]", *(f"{name} = {place}" for name, place in entries.items())]
    (about / "entry_points.txt").write_text("\n".join(lines))
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(map(str, (tmp_path, *sys.path)))}
    words = "compensate mx-clear --velocity 100 --method half-the-error --rounds 2 --session s --json"
    ran = subprocess.run(
        [sys.executable, "-m", "fdvv", *words.split()],
        cwd=tmp_path, env=environment, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert ran.returncode == 0, ran.stderr
    assert json.loads(ran.stdout)["method"] == "half the error"
    refused = subprocess.run(
        [sys.executable, "-m", "fdvv", *words.split(), "--literal"],
        cwd=tmp_path, env=environment, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert "belongs to the method paper" in refused.stderr
