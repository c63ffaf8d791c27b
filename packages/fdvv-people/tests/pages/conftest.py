"""The studio's application, as the tests of its other pages have it."""

from tests.studio.conftest import client, own_studio, stranger

__all__ = ["client", "own_studio", "stranger"]
