"""The studio's application, as the tests of its other pages have it, and how its studies are asked."""

from __future__ import annotations

from collections.abc import Callable
from functools import partialmethod
from typing import Any

import pytest
from starlette.testclient import TestClient

from fdvv_people.study.admin.study import Study
from tests.browser.study_screens import CHEAP, NAME
from tests.studio.conftest import client, own_studio, stranger

__all__ = ["client", "own_studio", "stranger"]


@pytest.fixture(autouse=True)
def _in_haste(monkeypatch: pytest.MonkeyPatch) -> None:
    """Codes of these tests need not be slow to guess, nor what is kept outlive a power cut."""
    monkeypatch.setattr("os.fsync", lambda _file: None)
    monkeypatch.setattr(Study, "enrol", partialmethod(Study.enrol, cost=CHEAP))


@pytest.fixture
def ask(client: TestClient) -> Callable[..., Any]:
    """Ask about the study as the operator, by default its own part, and return the answer."""

    def answer(name: str, /, **question: Any) -> Any:
        path = name if "." in name else f"studies.{name}"
        found = client.post(f"/api/{path}", json={"study": NAME, **question}).json()
        assert "error" not in found, found
        return found

    return answer
