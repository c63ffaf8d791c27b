"""What the how-to pages show is what runs, in an empty folder."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest
from tests.test_tutorials import REPOSITORY, blocks, environment, run, steps

SWITCH = REPOSITORY / "docs" / "how-to" / "from-a-model-to-a-switch.md"
__all__ = ["environment"]


@pytest.mark.slow
@pytest.mark.timeout(240)
def test_a_model_becomes_a_switch_as_the_page_shows(tmp_path: Path, environment: dict[str, str]) -> None:
    for extra in ("matplotlib", "ezdxf"):
        pytest.importorskip(extra)
    for language, text in blocks(SWITCH):
        if language == "console":
            for command, _ in steps(text):
                ran = run([sys.executable, "-m", *command], tmp_path, environment)
                assert ran.returncode == 0, ran.stderr
        elif language == "python":
            ran = run([sys.executable, "-W", "error", "-c", text], tmp_path, environment)
            assert ran.returncode == 0, ran.stderr
            assert ran.stdout.endswith("True\n")
    told = json.loads((tmp_path / "switch" / "mechanism.json").read_text())
    assert told["met"] is True
    page = SWITCH.read_text()
    assert all(f"`{path.name}`" in page for path in (tmp_path / "switch").iterdir())
