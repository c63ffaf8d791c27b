"""What can go wrong, as one small tree.

FdvvError
├── InputError    a file or value from a person cannot be used (exit status 2)
├── ModelError    numbers that do not make a curve or a model
│   └── SettingError  a setting that does not go with another
├── FitError      a curve cannot be fitted as asked
├── DeviceError   a device refused, failed or went away
│   └── PartFaultError  a part of its rig is broken or wired wrongly
├── WorkerError   work in another process failed
└── BuildError    this installation lacks a part (compiled library, optional extra)
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

NEAR_ratio = 0.5
"""How alike a misspelt name and a known one are at least (``difflib``)."""


class FdvvError(Exception):
    """Base of every error that fdvv raises on purpose; its text is one line for a person."""


class InputError(FdvvError):
    """A file or a value from a person cannot be used.

    Parameters
    ----------
    source : the file or option it came from.
    place : where in it ("line 12, column 2", "$.curves[3].knots_mm", "whole file").
    reason : what is wrong, with the value received.
    remedy : what to do about it.
    details : more for programs, as ``--json`` prints it.
    """

    def __init__(
        self,
        source: object,
        place: str,
        reason: str,
        remedy: str,
        details: Mapping[str, object] | None = None,
    ) -> None:
        self.details = dict(details or {})
        self.source, self.place, self.reason, self.remedy = str(source), place, reason, remedy
        super().__init__(" ".join(f"{source}: {place}: {reason}; {remedy}".split()))


class ModelError(FdvvError, ValueError):
    """Numbers that do not make a curve, a surface or a model; says what was received."""


class SettingError(ModelError):
    """A setting that does not go with another, or with what is worked on.

    Parameters
    ----------
    name : of the setting. reason, remedy : as of `InputError`, which a door makes of it under its own name.
    """

    def __init__(self, name: str, reason: str, remedy: str) -> None:
        self.name, self.reason, self.remedy = name, reason, remedy
        super().__init__(f"{name} {reason}; {remedy}")

    def as_option(self) -> InputError:
        """Return what a command says of it: the option has the setting's name."""
        return InputError(f"--{self.name.replace('_', '-')}", "option", self.reason, self.remedy)


class FitError(FdvvError, ValueError):
    """A curve cannot be fitted as asked; says what was received and what is needed."""


class DeviceError(FdvvError):
    """A device refused, failed or went away; says which and why."""


@dataclass(frozen=True)
class PartFault:
    """A part of a rig that is broken or wired wrongly.

    Attributes
    ----------
    part : its name, without an article. seen : what shows it, a clause that begins with the part.
    remedy : what to do about it, an imperative.
    """

    part: str
    seen: str
    remedy: str

    def __str__(self) -> str:
        return f"{self.seen}: {self.remedy}"


class PartFaultError(DeviceError):
    """A part of a device's rig is at fault; its text is the fault's sentence."""

    def __init__(self, fault: PartFault, text: str = "") -> None:
        self.fault = fault
        super().__init__(text or str(fault))


class WorkerError(FdvvError):
    """Work in another process failed, or lost its process again and again; says which part and why."""


class BuildError(FdvvError):
    """This installation lacks a part; says which and how to get it."""


def did_you_mean(name: str, known: Iterable[str], otherwise: str = "") -> str:
    """Return a remedy for an unknown name: the known one that is nearest, or else what is given.

    otherwise : "use one of ..." with all of them if left out.
    """
    names = tuple(known)
    import difflib  # most commands misspell nothing

    near = difflib.get_close_matches(name, names, 1, NEAR_ratio)
    return f"did you mean {near[0]}?" if near else otherwise or f"use one of {', '.join(names)}"
