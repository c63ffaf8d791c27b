"""What the page on ways to learn shows is a package that `fdvv compensate` finds."""

from __future__ import annotations

import json
import sys
from pathlib import Path

from tests.docs.pages import DOCS, blocks_of, install_example, run

PAGE = DOCS / "how-to" / "add-a-way-to-learn.md"


def test_a_way_to_learn_is_one_file_that_the_command_finds(tmp_path: Path) -> None:
    method, make = (block.text for block in blocks_of(PAGE) if block.language == "python")
    (toml,) = (block.text for block in blocks_of(PAGE) if block.language == "toml")
    # what the page tries it with is no part of it
    environment = install_example(
        tmp_path, "half.py", f"{method.partition('device, model =')[0]}\n{make}", toml
    )
    words = "compensate mx-clear --velocity 100 --method half-the-error --rounds 2 --session s --json"
    command = [sys.executable, "-m", "fdvv", *words.split()]
    ran = run(command, tmp_path, environment)
    assert ran.returncode == 0, ran.stderr
    assert json.loads(ran.stdout)["method"] == "half the error"
    refused = run([*command, "--literal"], tmp_path, environment)
    assert "belongs to the method paper" in refused.stderr
