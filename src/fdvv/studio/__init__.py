"""The studio: a page in the browser over the workflows, served on this machine."""

from fdvv.studio._app import create_app
from fdvv.studio._contract import Call, Channel, ChannelKind, Tell
from fdvv.studio._guard import Door
from fdvv.studio._kept_token import kept_token
from fdvv.studio._parts import Parts, load_parts
from fdvv.studio._serve import door_of, listen, serve
from fdvv.studio._studio import Studio

__all__ = [
    "Call",
    "Channel",
    "ChannelKind",
    "Door",
    "Parts",
    "Studio",
    "Tell",
    "create_app",
    "door_of",
    "kept_token",
    "listen",
    "load_parts",
    "serve",
]
