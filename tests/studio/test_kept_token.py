"""An address that outlives restarts: its token is drawn once, and nobody else can read it."""

from __future__ import annotations

import signal
import stat
from pathlib import Path

import httpx2
import pytest
from tests.studio.running import RunningStudio

from fdvv.errors import InputError
from fdvv.studio import kept_token


def test_a_token_is_drawn_once_and_for_its_owner_alone(tmp_path: Path) -> None:
    token = kept_token(tmp_path / "project")
    assert len(token) == 32
    assert kept_token(tmp_path / "project") == token
    assert kept_token(tmp_path / "other") != token
    mode = (tmp_path / "project" / ".studio-token").stat().st_mode
    assert stat.S_IMODE(mode) == 0o600
    assert (tmp_path / "project" / ".gitignore").read_text() == ".studio-token\n"


def test_a_token_that_others_can_read_or_that_is_none_is_refused(tmp_path: Path) -> None:
    kept_token(tmp_path)
    path = tmp_path / ".studio-token"
    path.chmod(0o640)
    with pytest.raises(InputError, match="others on this machine can read it"):
        kept_token(tmp_path)
    path.chmod(0o600)
    path.write_text("")
    with pytest.raises(InputError, match="holds no token"):
        kept_token(tmp_path)
    path.unlink()
    path.symlink_to(tmp_path / "elsewhere")
    with pytest.raises(InputError, match="no plain file"):
        kept_token(tmp_path)


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
