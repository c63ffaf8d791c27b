"""Parts of the laboratory that come as packages of their own, found by their entry points."""

from __future__ import annotations

from functools import cache
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Literal

from fdvv.errors import BuildError

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

Kind = Literal[
    "commands",
    "command_help",
    "device_commands",
    "engines",
    "methods",
    "devices",
    "rigs",
    "presenters",
    "tasks",
    "exchange_formats",
    "kinds",
    "pages",
]
"""What a package can add: a click command of ``fdvv`` or of ``fdvv device``, the first lines of its commands'
help by their names, an engine of ``fdvv optimize``, a way for ``fdvv compensate`` to learn a rig, a board in
lockstep or a device, the physics of a rig of one's own, what presents the rounds of ``fdvv optimize`` to a
person, a task of studies, a format of ``fdvv export``, a kind of journal that ``fdvv check`` knows, a module
with calls and channels of the studio."""

KNOWN = MappingProxyType(
    {
        ("commands", "library"): "fdvv-studio",
        ("commands", "press"): "fdvv-studio",
        ("commands", "studio"): "fdvv-studio",
        ("commands", "optimize"): "fdvv-people",
        ("commands", "study"): "fdvv-people",
        ("commands", "serve"): "fdvv-campaigns",
        ("commands", "sweep"): "fdvv-campaigns",
        ("commands", "hardware"): "fdvv-rig",
        ("commands", "mechanism"): "fdvv-switch",
        ("device_commands", "strip"): "fdvv-strip",
        ("engines", "botorch"): "fdvv-botorch",
        ("engines", "preference-botorch"): "fdvv-botorch",
        ("devices", "emulated"): "fdvv-m0",
        ("devices", "moteus"): "fdvv-drives",
        ("devices", "odrive"): "fdvv-drives",
        ("devices", "simplefoc"): "fdvv-drives",
        ("presenters", "strip"): "fdvv-strip",
        ("pages", "optimize"): "fdvv-people",
        ("pages", "studies"): "fdvv-people",
        ("exchange_formats", "mjcf"): "fdvv-haptics",
        ("exchange_formats", "smartknob"): "fdvv-haptics",
        ("exchange_formats", "ahap"): "fdvv-haptics",
        ("exchange_formats", "haptic"): "fdvv-haptics",
        ("exchange_formats", "hjif"): "fdvv-haptics",
    }
)
"""The package that brings a name, installed or not: what an error tells a person to install."""


@cache
def installed(kind: Kind) -> MappingProxyType[str, EntryPoint]:
    """Return the entry points of the installed extras by name; imports none of them."""
    # imports the email package, for metadata: only where an extra may be meant
    from importlib.metadata import entry_points

    return MappingProxyType({entry.name: entry for entry in entry_points(group=f"fdvv.{kind}")})


def names(kind: Kind) -> tuple[str, ...]:
    """Return the names of a kind: the known ones, installed or not, then those of other packages."""
    known = [name for group, name in KNOWN if group == kind]
    return tuple(dict.fromkeys([*known, *sorted(installed(kind))]))


def absent(kind: Kind) -> dict[str, list[str]]:
    """Return the known names of a kind that are not installed, by the package that brings them."""
    found: dict[str, list[str]] = {}
    for (group, name), package in KNOWN.items():
        if group == kind and name not in installed(kind):
            found.setdefault(package, []).append(name)
    return found


def load(kind: Kind, name: str) -> Any:
    """Import what an extra adds under a name.

    Raises BuildError if the extra is not installed, KeyError if no extra is known to have the name.
    """
    if entry := installed(kind).get(name):
        return entry.load()
    package = KNOWN[kind, name]
    raise BuildError(f"{name} is not installed; it comes with {package}: pip install {package}")
