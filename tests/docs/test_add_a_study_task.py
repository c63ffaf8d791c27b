"""What the page on study tasks shows is a package that `fdvv study` finds, from the plan to the report."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.docs.pages import DOCS, blocks_of

PAGE = DOCS / "how-to" / "add-a-study-task.md"
Run = Callable[[str], str]


@pytest.fixture
def run(tmp_path: Path) -> Run:
    """Return what runs an fdvv command beside the page's package, and returns what it prints."""
    (source,) = (block.text for block in blocks_of(PAGE) if block.language == "python")
    entry_points = [block.text for block in blocks_of(PAGE) if "entry-points" in block.text]
    assert source.count("\n") <= 150
    package, about = tmp_path / "my_package", tmp_path / "my_package-1.dist-info"
    package.mkdir()
    about.mkdir()
    (package / "same.py").write_text(source)
    ((group, entries),) = tomllib.loads(entry_points[0])["project"]["entry-points"].items()
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: my-package\nVersion: 1\n")
    lines = [f"[{group}]", *(f"{name} = {place}" for name, place in entries.items())]
    (about / "entry_points.txt").write_text("\n".join(lines))
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(map(str, (tmp_path, *sys.path)))}

    def run(words: str) -> str:
        ran = subprocess.run(
            [sys.executable, "-m", "fdvv", *words.split()],
            cwd=tmp_path, env=environment, capture_output=True, text=True, check=False,
        )  # fmt: skip
        assert ran.returncode == 0, ran.stderr
        return ran.stdout

    return run


def test_a_study_task_is_one_file_that_runs_from_plan_to_report(run: Run, tmp_path: Path) -> None:
    plan = next(block.text for block in blocks_of(PAGE) if "fdvv-study" in block.text)
    asked = plan[plan.index("[question]") : plan.index("[[items]]")]
    folder, passphrase = tmp_path / "s", tmp_path / "secret.txt"
    folder.mkdir()
    plan = plan.replace('"preference"', '"same-different"').replace(asked, "")
    plan = plan.replace("people = 12", "people = 8").replace("= 0.85", "= 0.6")
    (folder / "study.toml").write_text(plan)
    passphrase.write_text("a long passphrase of a test")
    assert "A and B hide as made and lighter, or one of them twice" in run("study preview s")
    run("study freeze s --passphrase-file secret.txt")
    run("study simulate s --fast --seed 1")
    run("study unseal s --who somebody --why test --passphrase-file secret.txt")
    found = json.loads(run("study analyse s --report report.html --json"))
    choices = found["preference"]
    right, wrong = choices["more"], choices["less"]
    assert found["kind"] == "same-different"
    assert right["name"] == "right"
    assert right["count"] + wrong["count"] == choices["answers"] == found["screening"]["counted"] > 0
    assert right["count"] > wrong["count"]  # a change of force that everybody feels
    assert choices["d_prime"] == []
    assert "same-different" in (tmp_path / "report.html").read_text()
