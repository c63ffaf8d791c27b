"""fdvv studio as a person starts it: what it opens, and with what."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from threading import Event
from urllib.parse import unquote, urlparse

import pytest

from tests.support.command_line import Run

ADDRESS = "http://127.0.0.1:8377/?token=a-secret"


@pytest.mark.parametrize("there", [True, False])
def test_the_browser_is_opened_on_a_file_and_its_arguments_hold_no_token(
    fdvv: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, there: bool
) -> None:
    opened: list[str] = []
    came = Event()

    def browser(url: str) -> None:
        opened.extend((url, Path(unquote(urlparse(url).path)).read_text()))
        came.set()

    def serve(_studio: object, _host: str, _port: int, ready: Callable[..., None], _keep: bool) -> None:
        ready([ADDRESS])
        assert came.wait(10)

    monkeypatch.setattr("fdvv_studio.cli.studio.webbrowser.open", browser)
    monkeypatch.setattr("fdvv_studio.studio.server.serve", serve)
    if there:
        (tmp_path / "work").mkdir()
    ran = fdvv("studio", "--project", "work")
    assert ran.status == 0, ran.err
    assert ADDRESS in ran.out
    url, text = opened
    assert "a-secret" not in url
    assert ADDRESS in text
    assert (tmp_path / "work").exists() == there
    assert not there or list((tmp_path / "work").iterdir()) == []
