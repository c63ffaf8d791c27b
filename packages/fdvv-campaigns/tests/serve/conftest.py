"""A server for tests that leave it as it was."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.serve.running import Client, RunningServer

PAGE = "http://localhost:8000"


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RunningServer]:
    running = RunningServer(tmp_path_factory.mktemp("serve") / "project", more=("--origin", PAGE))
    yield running
    assert "Traceback" not in running.stop()


@pytest.fixture
def client(server: RunningServer) -> Iterator[Client]:
    one = Client(server)
    yield one
    one.close()


@pytest.fixture
def run(request: pytest.FixtureRequest) -> str:
    """A name that no other test has."""
    return "run-" + "".join(c if c.isalnum() else "-" for c in request.node.name)[-50:]


def folder_of(server: RunningServer, run: str) -> Path:
    return server.project / "serve" / run
