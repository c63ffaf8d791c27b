"""Messages about the studio itself."""

from __future__ import annotations

from msgspec import Struct


class AboutAsk(Struct, frozen=True, forbid_unknown_fields=True):
    """Ask what this studio is."""


class About(Struct, frozen=True, forbid_unknown_fields=True):
    """What this studio is.

    project : name of the project's folder. sources : names of the folders of measured switches.
    """

    version: str
    project: str
    sources: list[str]
