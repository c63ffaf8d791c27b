"""What this studio is."""

from __future__ import annotations

from fdvv import __version__
from fdvv.studio._contract import Call, ChannelKind
from fdvv.studio._messages_studio import About, AboutAsk
from fdvv.studio._studio import Studio


def about(studio: Studio, _ask: AboutAsk) -> About:
    """Tell names only: the page needs no paths."""
    return About(__version__, studio.project.resolve().name, [s.resolve().name for s in studio.sources])


CALLS = (Call("studio.about", AboutAsk, About, about),)
CHANNELS: tuple[ChannelKind, ...] = ()
