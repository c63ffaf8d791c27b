"""The version, project and sources of this studio."""

from __future__ import annotations

from fdvv._version import __version__
from fdvv_studio.studio.contract import Empty, Message, call
from fdvv_studio.studio.studio import Studio


class About(Message):
    """What this studio is.

    project : name of the project's folder. sources : names of the folders of measured switches.
    """

    version: str
    project: str
    sources: list[str]


@call("studio.about")
def about(studio: Studio, _ask: Empty) -> About:
    """Return names only: the page needs no paths."""
    return About(__version__, studio.project.resolve().name, [s.resolve().name for s in studio.sources])
