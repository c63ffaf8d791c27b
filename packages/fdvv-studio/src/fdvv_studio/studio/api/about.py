"""The version, project and sources of this studio."""

from __future__ import annotations

from fdvv import extras
from fdvv._version import __version__
from fdvv_studio.studio.contract import Empty, Message, call
from fdvv_studio.studio.studio import Studio


class About(Message):
    """What this studio is.

    project : name of the project's folder. sources : names of the folders of measured switches.
    absent : the pages that are not installed, by the package that brings them.
    """

    version: str
    project: str
    sources: list[str]
    absent: dict[str, list[str]]


@call("studio.about")
def about(studio: Studio, _ask: Empty) -> About:
    """Return names only: the page needs no paths."""
    sources = [source.resolve().name for source in studio.sources]
    return About(__version__, studio.project.resolve().name, sources, extras.absent("pages"))
