"""The clients for other languages drive a real server."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
from pathlib import Path

import pytest
from click.testing import CliRunner

from fdvv.cli.main import cli
from fdvv_campaigns.serve.clients import CLIENTS
from tests.serve.running import Client, RunningServer
from tests.support.checkout import REPOSITORY

CLIENT_FILES = REPOSITORY / "packages/fdvv-campaigns/src/fdvv_campaigns/serve/clients"
HERE = Path(__file__).parent
NODE = shutil.which("node")


def _node(script: str, *words: str) -> subprocess.Popen[str]:
    if NODE is None:
        if os.environ.get("CI"):
            pytest.fail("node is missing; make web-tools installs it")
        pytest.skip("node is not installed (make web-tools)")
    version = int(
        subprocess.run([NODE, "--version"], capture_output=True, text=True).stdout[1:].split(".")[0]
    )
    flags = ["--experimental-websocket"] if version < 22 else []
    command = [NODE, *flags, "--no-warnings", str(HERE / script), *words]
    return subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )


def _ended(process: subprocess.Popen[str]) -> list[str]:
    out, err = process.communicate(timeout=40)
    assert (process.returncode, err) == (0, "")
    return out.splitlines()


FOUND = [
    "refused token",
    "pending True",
    "best True 5",
    "no device you have opened no device",
    "events actuation down reset up",
]


def test_the_client_in_javascript_does_all_of_it(server: RunningServer, run: str) -> None:
    pytest.importorskip("sklearn")
    assert _ended(_node("_check.mjs", server.address, server.token, run)) == FOUND


def test_the_client_in_javascript_comes_back_after_the_server_was_killed(tmp_path: Path, run: str) -> None:
    server = RunningServer(tmp_path / "project")
    process = _node("_check_killed.mjs", server.address, server.token, run)
    assert process.stdout is not None
    assert process.stdin is not None
    assert process.stdout.readline() == "asked\n"
    server.stop(signal.SIGKILL)
    assert process.stdout.readline() == "lost\n"
    process.stdin.write("go on\n")  # it reports while nobody is there
    process.stdin.flush()
    again = RunningServer(tmp_path / "project", server.port)
    assert _ended(process) == ["connected", "done 1 of 1", "device lost FdvvLost"]
    assert Client(again).call("optimize.resume", run=run)["done"] == 1
    again.stop()


@pytest.mark.slow
def test_the_client_in_c_sharp_does_all_of_it(server: RunningServer, run: str, tmp_path: Path) -> None:
    pytest.importorskip("sklearn")
    if not (shutil.which("mcs") and shutil.which("mono")):
        pytest.skip("mono is not installed (Debian: mono-mcs mono-runtime)")
    program = tmp_path / "check.exe"
    sources = [str(CLIENT_FILES / "FdvvClient.cs"), str(HERE / "_check.cs")]
    subprocess.run(["mcs", "-langversion:7.2", "-warnaserror", f"-out:{program}", *sources], check=True)
    command = ["mono", str(program), server.address, server.token, run]
    ran = subprocess.run(command, capture_output=True, text=True, timeout=60)
    # a handler that fails is reported, and the client goes on
    found = [FOUND[0], "handler failed", *FOUND[1:]]
    assert (ran.returncode, ran.stdout.splitlines()) == (0, found), ran.stderr


@pytest.mark.slow
def test_the_example_for_unity_compiles_against_the_parts_of_unity_that_it_uses(tmp_path: Path) -> None:
    if not shutil.which("mcs"):
        pytest.skip("mono is not installed (Debian: mono-mcs mono-runtime)")
    sources = [str(CLIENT_FILES / name) for name in CLIENTS["unity"]] + [str(HERE / "_unity.cs")]
    command = ["mcs", "-langversion:7.2", "-target:library", f"-out:{tmp_path / 'example.dll'}", *sources]
    assert subprocess.run(command, capture_output=True, text=True).stdout == ""


@pytest.mark.parametrize("language", CLIENTS)
def test_a_client_is_copied_with_its_example_and_replaces_nothing(language: str, tmp_path: Path) -> None:
    asked = ["serve", "--client", language, str(tmp_path / "Assets")]
    assert CliRunner().invoke(cli, asked, catch_exceptions=False).exit_code == 0
    for name in CLIENTS[language]:
        assert (tmp_path / "Assets" / name).read_text() == (CLIENT_FILES / name).read_text()
    refused = CliRunner().invoke(cli, asked)
    assert "is there already" in str(refused.exception)
