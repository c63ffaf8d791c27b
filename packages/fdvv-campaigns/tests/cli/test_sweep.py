"""fdvv sweep. Simulated."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from fdvv.cli.main import cli
from fdvv.errors import InputError

PLAN = """
format = "fdvv-sweep"
version = 1
measure = "press"
[factors]
button = ["mx-clear", "mx-red"]
[settings]
presses = 1
"""


def invoke(*arguments: str) -> Result:
    return CliRunner().invoke(cli, ["sweep", *arguments])


@pytest.fixture
def plan(tmp_path: Path) -> Path:
    path = tmp_path / "plan.toml"
    path.write_text(PLAN)
    return path


@pytest.mark.slow
def test_results_are_printed_as_json_and_as_a_table_that_say_simulated(plan: Path, tmp_path: Path) -> None:
    command = (str(plan), "--output", str(tmp_path / "run"), "--processes", "1")
    first = invoke(*command, "--json")
    assert first.exit_code == 0, first.output
    summary = json.loads(first.stdout)
    assert summary["simulated"]
    assert (summary["cells"], summary["failed"], summary["worked"]) == (2, 0, 2)
    assert Path(summary["results"]).is_file()
    assert [row["value"] for row in summary["summary"][0]["rows"]] == ["mx-clear", "mx-red"]
    again = invoke(*command)
    assert "2 cells (simulated), 0 failed" in again.stdout
    assert "closing_ms by button" in again.stdout


@pytest.mark.slow
def test_a_preview_tells_what_it_would_try(plan: Path) -> None:
    assert "button (2): mx-clear, mx-red" in invoke(str(plan), "--preview").stdout


def test_a_preview_tells_cells_and_time_and_writes_nothing(plan: Path, tmp_path: Path) -> None:
    preview = json.loads(invoke(str(plan), "--preview", "--processes", "2", "--json").stdout)
    assert (preview["cells"], preview["done"], preview["processes"], preview["failed"]) == (2, 0, 2, [])
    assert preview["estimated_s"] == pytest.approx(preview["cell_s"])
    assert [path.name for path in tmp_path.iterdir()] == ["plan.toml"]


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ([], "needs --output FOLDER, or --preview"),
        (["-o", "run", "--workers", "1", "--cluster", "tcp://127.0.0.1:1"], "exclude each other"),
    ],
)
def test_options_that_cannot_be_are_refused(plan: Path, options: list[str], said: str) -> None:
    result = invoke(str(plan), *options)
    assert result.exit_code == 2
    assert said in result.stderr


def test_a_file_that_is_no_plan_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "other.toml"
    path.write_text("[coil]\n")
    result = invoke(str(path), "--preview")
    assert isinstance(result.exception, InputError)
    assert "not a plan of a sweep" in str(result.exception)
