"""The studio: a person's project, the catalogue of buttons, live presses and the page in the browser.

The names below are the public face, imported when first used. Every other module may be imported too, and may
change (docs/explanation/stability.md).
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from fdvv_studio.library.library import Library

__version__ = "0.1.0"

_HOME = {
    "Library": "fdvv_studio.library.library",
}

__all__ = ["Library", "__version__"]


def __getattr__(name: str) -> Any:
    """Import a public name when it is first used."""
    if name not in _HOME:
        raise AttributeError(f"module 'fdvv_studio' has no attribute {name!r}")
    value = globals()[name] = getattr(importlib.import_module(_HOME[name]), name)
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
