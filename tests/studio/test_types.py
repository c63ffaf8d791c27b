"""The page's types are those of the server's messages."""

from __future__ import annotations

from tests.test_docs import tool


def test_the_pages_types_are_those_of_the_messages() -> None:
    types = tool("make_studio_types")
    assert types.TARGET.read_text() == types.reference(), "run python tools/make_studio_types.py"
