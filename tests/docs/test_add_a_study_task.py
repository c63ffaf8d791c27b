"""What the page on study tasks shows is a package that `fdvv study` finds, from the plan to the report."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.docs.pages import DOCS, blocks_of, install_example, run

PAGE = DOCS / "how-to" / "add-a-study-task.md"
Run = Callable[[str], str]


@pytest.fixture
def fdvv(tmp_path: Path) -> Run:
    """Return what runs an fdvv command beside the page's package, and returns what it prints."""
    (source,) = (block.text for block in blocks_of(PAGE) if block.language == "python")
    (toml,) = (block.text for block in blocks_of(PAGE) if "entry-points" in block.text)
    environment = install_example(tmp_path, "same.py", source, toml)

    def run_words(words: str) -> str:
        ran = run([sys.executable, "-m", "fdvv", *words.split()], tmp_path, environment)
        assert ran.returncode == 0, ran.stderr
        return ran.stdout

    return run_words


def test_a_study_task_is_one_file_that_runs_from_plan_to_report(fdvv: Run, tmp_path: Path) -> None:
    plan = next(block.text for block in blocks_of(PAGE) if "fdvv-study" in block.text)
    asked = plan[plan.index("[question]") : plan.index("[[items]]")]
    folder, passphrase = tmp_path / "s", tmp_path / "secret.txt"
    folder.mkdir()
    plan = plan.replace('"preference"', '"same-different"').replace(asked, "")
    plan = plan.replace("people = 12", "people = 8").replace("= 0.85", "= 0.6")
    (folder / "study.toml").write_text(plan)
    passphrase.write_text("a long passphrase of a test")
    assert "A and B hide as made and lighter, or one of them twice" in fdvv("study preview s")
    fdvv("study freeze s --passphrase-file secret.txt")
    fdvv("study simulate s --fast --seed 1")
    fdvv("study unseal s --who somebody --why test --passphrase-file secret.txt")
    found = json.loads(fdvv("study analyse s --report report.html --json"))
    choices = found["preference"]
    right, wrong = choices["more"], choices["less"]
    assert found["kind"] == "same-different"
    assert right["name"] == "right"
    assert right["count"] + wrong["count"] == choices["answers"] == found["screening"]["counted"] > 0
    assert right["count"] > wrong["count"]  # a change of force that everybody feels
    assert choices["d_prime"] == []
    assert "same-different" in (tmp_path / "report.html").read_text()
