"""Only the page of this studio may talk to it."""

from __future__ import annotations

import signal
import stat
from pathlib import Path

import httpx2
import pytest
from starlette.testclient import TestClient
from starlette.websockets import WebSocketDisconnect

from fdvv.errors import InputError
from fdvv_studio.studio.auth import opening_file, project_token
from tests.studio.conftest import LIVE, ORIGIN, TOKEN
from tests.studio.running import RunningStudio

ABOUT = "/api/studio.about"


def test_the_printed_address_gives_a_cookie_that_scripts_cannot_read(stranger: TestClient) -> None:
    answer = stranger.get("/", params={"token": TOKEN})
    assert answer.status_code == 303
    assert answer.headers["location"] == "/"
    cookie = answer.headers["set-cookie"].lower()
    assert "httponly" in cookie
    assert "samesite=strict" in cookie
    assert stranger.get("/").status_code == 200


def test_opened_from_a_file_the_address_leads_on_by_a_page_of_its_own(stranger: TestClient) -> None:
    """A browser sends no strict cookie where another site, as a file is, led here."""
    answer = stranger.get("/", params={"token": TOKEN}, headers={"sec-fetch-site": "cross-site"})
    assert answer.status_code == 200
    assert 'content="0;url=/"' in answer.text
    assert TOKEN not in answer.text
    assert stranger.get("/").status_code == 200


def test_what_a_browser_is_started_with_holds_no_token(tmp_path: Path) -> None:
    for project in (tmp_path, tmp_path / "not-there-yet"):
        with opening_file(project) as written:
            page = written(f"http://127.0.0.1:1/?token={TOKEN}")
            assert TOKEN not in page.as_uri()
            assert TOKEN in page.read_text()
            assert stat.S_IMODE(page.stat().st_mode) == 0o600
        assert not page.exists()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("path", ["/", "/studio.js", "/icon.svg", "/nothing"])
def test_without_the_token_nothing_is_served(stranger: TestClient, path: str) -> None:
    answer = stranger.get(path)
    assert answer.status_code == 403
    assert "whole address" in answer.text


@pytest.mark.parametrize("token", ["", "wrong", TOKEN[:-1], TOKEN + "x", "ÿ"])
def test_a_wrong_token_opens_nothing(stranger: TestClient, token: str) -> None:
    assert stranger.get("/", params={"token": token}).status_code == 403
    assert not stranger.cookies


def test_a_program_may_use_the_token_as_a_bearer(stranger: TestClient) -> None:
    answer = stranger.post(ABOUT, json={}, headers={"authorization": f"Bearer {TOKEN}"})
    assert answer.status_code == 200


@pytest.mark.parametrize(
    "origin",
    ["http://evil.example", "null", "http://127.0.0.1:1", "https://127.0.0.1:8377", "http://localhost:8377"],
)
def test_another_sites_page_is_refused(client: TestClient, origin: str) -> None:
    answer = client.post(ABOUT, json={}, headers={"origin": origin})
    assert answer.status_code == 403
    assert client.get("/", headers={"origin": origin}).status_code == 403


def test_a_cookie_without_an_origin_changes_nothing(client: TestClient) -> None:
    del client.headers["origin"]
    assert client.post(ABOUT, json={}).status_code == 403
    assert client.get("/").status_code == 200


def test_a_request_that_the_browser_calls_foreign_is_refused(client: TestClient) -> None:
    assert client.get("/", headers={"sec-fetch-site": "cross-site"}).status_code == 403
    assert client.get("/", headers={"sec-fetch-site": "same-site"}).status_code == 403


@pytest.mark.parametrize("host", ["evil.example", "127.0.0.1", "127.0.0.1:80", "evil.example:8377", ""])
def test_a_name_that_was_made_to_point_here_is_refused(client: TestClient, host: str) -> None:
    headers = {"host": host, "origin": f"http://{host}"}
    assert client.get("/", headers=headers).status_code == 403
    assert client.get("/", params={"token": TOKEN}, headers=headers).status_code == 403


def test_every_answer_keeps_the_page_to_itself(client: TestClient) -> None:
    for answer in (client.get("/"), client.get("/nothing"), client.post(ABOUT, json={})):
        policy = answer.headers["content-security-policy"]
        assert "default-src 'none'" in policy
        assert "frame-ancestors 'none'" in policy
        assert "unsafe" not in policy
        assert answer.headers["x-content-type-options"] == "nosniff"


@pytest.mark.parametrize("origin", ["http://evil.example", None])
def test_the_live_connection_is_refused_to_others(client: TestClient, origin: str | None) -> None:
    del client.headers["origin"]
    headers = {"origin": origin} if origin else {}
    with pytest.raises(WebSocketDisconnect), client.websocket_connect(LIVE, headers=headers):
        pass


def test_the_live_connection_is_refused_without_the_token(stranger: TestClient) -> None:
    with (
        pytest.raises(WebSocketDisconnect) as refused,
        stranger.websocket_connect(LIVE, headers={"origin": ORIGIN}),
    ):
        pass
    assert refused.value.code == 4401


def test_a_token_is_drawn_once_and_for_its_owner_alone(tmp_path: Path) -> None:
    token = project_token(tmp_path / "project")
    assert len(token) == 32
    assert project_token(tmp_path / "project") == token
    assert project_token(tmp_path / "other") != token
    mode = (tmp_path / "project" / ".studio-token").stat().st_mode
    assert stat.S_IMODE(mode) == 0o600
    assert (tmp_path / "project" / ".gitignore").read_text() == ".studio-token\n"


def test_a_token_that_others_can_read_or_that_is_none_is_refused(tmp_path: Path) -> None:
    project_token(tmp_path)
    path = tmp_path / ".studio-token"
    path.chmod(0o640)
    with pytest.raises(InputError, match="others on this machine can read it"):
        project_token(tmp_path)
    path.chmod(0o600)
    path.write_text("")
    with pytest.raises(InputError, match="holds no token"):
        project_token(tmp_path)
    path.unlink()
    path.symlink_to(tmp_path / "elsewhere")
    with pytest.raises(InputError, match="no plain file"):
        project_token(tmp_path)


@pytest.mark.slow
def test_a_page_that_was_opened_before_a_restart_goes_on_after_it(tmp_path: Path) -> None:
    first = RunningStudio(tmp_path / "project", more=("--keep-address",))
    port = int(first.base.rpartition(":")[2])
    with httpx2.Client(base_url=first.base, headers={"origin": first.base}) as tablet:
        tablet.get("/", params={"token": first.token})
        first.stop(signal.SIGKILL)
        again = RunningStudio(tmp_path / "project", port=port, more=("--keep-address",))
        assert again.token == first.token
        assert tablet.post("/api/studio.about", json={}).status_code == 200
        again.stop()
        fresh = RunningStudio(tmp_path / "project", port=port)
        assert fresh.token != first.token
        assert tablet.post("/api/studio.about", json={}).status_code == 403
        fresh.stop()
