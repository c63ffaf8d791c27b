"""A studio's application, asked as its own page asks."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from starlette.testclient import TestClient

from fdvv.studio import Studio, create_app, door_of

HOST, PORT, TOKEN = "127.0.0.1", 8377, "a-token-of-a-test"
ORIGIN = f"http://{HOST}:{PORT}"
LIVE = f"ws://{HOST}:{PORT}/live"


@pytest.fixture
def own_studio(tmp_path: Path) -> Studio:
    """A studio with an empty project."""
    return Studio(tmp_path / "project")


@pytest.fixture
def stranger(own_studio: Studio) -> Iterator[TestClient]:
    """Someone on this machine who does not have the token."""
    app = create_app(own_studio, door_of(HOST, PORT, TOKEN))
    with TestClient(app, base_url=ORIGIN, follow_redirects=False) as client:
        yield client


@pytest.fixture
def client(stranger: TestClient) -> TestClient:
    """The studio's own page."""
    stranger.get("/", params={"token": TOKEN})
    stranger.headers["origin"] = ORIGIN
    return stranger
