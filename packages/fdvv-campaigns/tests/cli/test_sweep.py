"""fdvv sweep. Simulated."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.support.command_line import Run

PLAN = """
format = "fdvv-sweep"
version = 1
measure = "press"
[factors]
button = ["mx-clear", "mx-red"]
[settings]
presses = 1
"""


@pytest.fixture
def plan(tmp_path: Path) -> Path:
    path = tmp_path / "plan.toml"
    path.write_text(PLAN)
    return path


@pytest.mark.slow
def test_results_are_printed_as_json_and_as_a_table_that_say_simulated(
    fdvv: Run, plan: Path, tmp_path: Path
) -> None:
    command = (plan, "--output", str(tmp_path / "run"), "--processes", "1")
    first = fdvv("sweep", *command, "--json")
    assert first.status == 0, first.err
    summary = first.json
    assert summary["simulated"]
    assert (summary["cells"], summary["failed"], summary["worked"]) == (2, 0, 2)
    assert Path(summary["results"]).is_file()
    assert [row["value"] for row in summary["summary"][0]["rows"]] == ["mx-clear", "mx-red"]
    again = fdvv("sweep", *command)
    assert "2 cells (simulated), 0 failed" in again.out
    assert "closing_ms by button" in again.out


@pytest.mark.slow
def test_a_preview_tells_what_it_would_try(fdvv: Run, plan: Path) -> None:
    assert "button (2): mx-clear, mx-red" in fdvv("sweep", plan, "--preview").out


def test_a_preview_tells_cells_and_time_and_writes_nothing(fdvv: Run, plan: Path, tmp_path: Path) -> None:
    preview = fdvv("sweep", plan, "--preview", "--processes", "2", "--json").json
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
def test_options_that_cannot_be_are_refused(fdvv: Run, plan: Path, options: list[str], said: str) -> None:
    result = fdvv("sweep", plan, *options)
    assert result.status == 2
    assert said in result.err


def test_a_file_that_is_no_plan_is_refused(fdvv: Run, tmp_path: Path) -> None:
    path = tmp_path / "other.toml"
    path.write_text("[coil]\n")
    result = fdvv("sweep", path, "--preview")
    assert result.status == 2
    assert "not a plan of a sweep" in result.err
