"""fdvv library."""

from __future__ import annotations

import csv
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from fdvv.cli.main import cli
from fdvv.errors import InputError
from tests.support.command_line import tactile_csv


def invoke(*arguments: str) -> Result:
    return CliRunner().invoke(cli, ["library", *arguments])


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    found = tmp_path_factory.mktemp("switches")
    text = tactile_csv(found / "red.csv").read_text()
    (found / "navy.csv").write_text(text)
    (found / "broken.csv").write_text("nothing\n")
    return found


@pytest.fixture(scope="module")
def library(folder: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("library") / "library"
    result = invoke("build", str(folder), "--output", str(path), "--processes", "1", "--json")
    assert result.exit_code == 0, result.output
    report = json.loads(result.stdout)
    assert (report["files"], report["buttons"], report["refused"], report["read"]) == (3, 2, 1, 3)
    return path


def test_the_built_in_buttons_are_listed_with_and_without_a_subcommand() -> None:
    assert invoke().stdout == invoke("list").stdout
    assert invoke("--json").stdout == invoke("list", "--json").stdout
    assert "mx-clear" in invoke().stdout


def test_a_search_tells_figures_and_units_as_a_table_json_and_csv(library: Path, tmp_path: Path) -> None:
    table = invoke("search", str(library), "navy", "peak_cN>=1")
    assert table.exit_code == 0
    assert "navy" in table.stdout
    assert table.stdout.endswith("1 found\n")
    path = tmp_path / "hits.csv"
    report = json.loads(invoke("search", str(library), "--json", "-o", str(path)).stdout)
    assert (report["buttons"], report["found"]) == (2, 2)
    assert {hit["name"] for hit in report["hits"]} == {"red", "navy"}
    with path.open() as stream:
        rows = list(csv.DictReader(stream))
    assert [float(row["travel_mm"]) for row in rows] == [hit["travel_mm"] for hit in report["hits"]]


def test_the_nearest_are_listed_with_their_distance(library: Path, folder: Path) -> None:
    report = json.loads(invoke("like", str(library), str(folder / "red.csv"), "-n", "1", "--json").stdout)
    assert len(report["hits"]) == 1
    assert report["hits"][0]["distance_JND"] == pytest.approx(0.0, abs=1e-3)
    assert (
        invoke("like", str(library), "mx-clear", "--by", "landmarks").stdout.splitlines()[0].split()[3]
        == "JND"
    )


def test_refused_files_are_listed_with_their_reason(library: Path) -> None:
    assert "broken.csv: " in invoke("refused", str(library)).stdout
    (refused,) = json.loads(invoke("refused", str(library), "--json").stdout)["refused"]
    assert refused["place"].endswith("broken.csv")
    assert refused["reason"]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["search", "LIBRARY", "peek_cN>=3"], "did you mean peak_cN"),
        (["search", "LIBRARY", "--sort", "colour"], "no such column"),
        (["search", "FOLDER"], "library.json"),
        (["like", "LIBRARY", "nothing.csv"], "no built-in and no file"),
        (["build", "FOLDER", "-o", "FOLDER"], "is not empty and no library"),
        (["build", "FOLDER", "-o", "NEW", "--workers", "1", "--processes", "1"], "exclude each other"),
        (["search", "LIBRARY", "-o", "hits.txt"], "end it in .csv"),
    ],
)
def test_impossible_requests_are_refused_in_one_line(
    library: Path, folder: Path, tmp_path: Path, arguments: list[str], said: str
) -> None:
    names = {"LIBRARY": library, "FOLDER": folder, "NEW": tmp_path / "new"}
    result = invoke(*(str(names.get(a, a)) for a in arguments))
    assert said in (str(result.exception) if isinstance(result.exception, InputError) else result.stderr)
    assert not (tmp_path / "new").exists()


@pytest.mark.slow
def test_ctrl_c_says_what_is_kept_and_the_same_command_goes_on(tmp_path: Path) -> None:
    source, library = tmp_path / "many", tmp_path / "library"
    source.mkdir()
    text = tactile_csv(source / "000.csv").read_text()
    for i in range(1, 400):
        (source / f"{i:03}.csv").write_text(text)
    command = [sys.executable, "-m", "fdvv", "library", "build", str(source), "-o", str(library)]
    process = subprocess.Popen(
        [*command, "--processes", "1"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    until = time.monotonic() + 50
    while not list(library.glob("parts/part-*.parquet")) and time.monotonic() < until:
        time.sleep(0.02)
    os.kill(process.pid, signal.SIGINT)
    out, err = process.communicate()
    assert (process.returncode, out) == (130, b"")
    assert err == f"fdvv: interrupted; what is done is kept in {library}, the same command goes on\n".encode()
    report = json.loads(subprocess.run([*command, "--json"], capture_output=True, check=True).stdout)
    assert report["kept"] >= 64
    assert report["buttons"] == 400
