"""A studio's application, asked as its own page asks."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from starlette.testclient import TestClient

from fdvv_studio.studio.contract import Call, ChannelKind
from fdvv_studio.studio.parts import PartLoader, Parts
from fdvv_studio.studio.server import address_of, create_app
from fdvv_studio.studio.studio import Studio

HOST, PORT, TOKEN = "127.0.0.1", 8377, "a-token-of-a-test"
ORIGIN = f"http://{HOST}:{PORT}"
LIVE = f"ws://{HOST}:{PORT}/live"


class GivenParts(PartLoader):
    """Parts that a test brings along."""

    def __init__(self, calls: dict[str, Call], channels: dict[str, ChannelKind]) -> None:
        super().__init__(())
        self._parts = Parts(calls, channels)


@pytest.fixture
def own_studio(tmp_path: Path) -> Studio:
    """A studio with an empty project."""
    return Studio(tmp_path / "project")


@pytest.fixture
def stranger(own_studio: Studio) -> Iterator[TestClient]:
    """Someone on this machine who does not have the token."""
    app = create_app(own_studio, address_of([HOST], PORT, TOKEN))
    with TestClient(app, base_url=ORIGIN, follow_redirects=False) as client:
        yield client


@pytest.fixture
def client(stranger: TestClient) -> TestClient:
    """The studio's own page."""
    stranger.get("/", params={"token": TOKEN})
    stranger.headers["origin"] = ORIGIN
    return stranger
