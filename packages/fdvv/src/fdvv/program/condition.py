"""Conditions of a program, and the transitions between its states."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from msgspec import Meta

from fdvv.errors import ModelError
from fdvv.protocol.tables import Condition as Code

EVENTS = 32  # bits of the word in which a board holds pending events (firmware/core/machine.h)
LARGEST_mm = 100.0  # assumed; beyond every travel (20 mm at most), and fits the 32 bits of an image
LARGEST_ms = 2**31 - 1  # a value is 32 bits with a sign (protocol/fdvv.toml, structs.transition)
LARGEST_mm_s = 4000.0  # the firmware's predictor takes no cap for faster (firmware/core/predictor.h)


class When(StrEnum):
    """What a condition looks at; the unit of its value ends the name, as in a program file.

    `faster_than` and `slower_than` compare the velocity that the state's `velocity` names, never negative.
    `turned_…` hold in the tick in which the cap's direction turned. `risen_by_mm` counts up from the deepest
    point since the state was entered, `fallen_by_mm` down from the highest.
    """

    ALWAYS = "always"
    DEEPER_THAN = "deeper_than_mm"
    SHALLOWER_THAN = "shallower_than_mm"
    TURNED_TO_PRESS = "turned_to_press"
    TURNED_TO_RELEASE = "turned_to_release"
    FASTER_THAN = "faster_than_mm_s"
    SLOWER_THAN = "slower_than_mm_s"
    AFTER = "after_ms"
    HOST_EVENT = "host_event"
    RISEN_BY = "risen_by_mm"
    FALLEN_BY = "fallen_by_mm"

    @property
    def code(self) -> Code:
        """Return its number on the device: both lists have one order."""
        return Code(list(When).index(self))


BARE = (When.ALWAYS, When.TURNED_TO_PRESS, When.TURNED_TO_RELEASE)
"""Conditions without a value."""
WHOLE = (When.AFTER, When.HOST_EVENT)
BOUNDS = {
    When.DEEPER_THAN: (-LARGEST_mm, LARGEST_mm),
    When.SHALLOWER_THAN: (-LARGEST_mm, LARGEST_mm),
    When.FASTER_THAN: (0.0, LARGEST_mm_s),
    When.SLOWER_THAN: (0.0, LARGEST_mm_s),
    When.AFTER: (0.0, LARGEST_ms),
    When.HOST_EVENT: (0.0, EVENTS - 1),
    When.RISEN_BY: (0.0, LARGEST_mm),
    When.FALLEN_BY: (0.0, LARGEST_mm),
}


@dataclass(frozen=True)
class Condition:
    """Something that may be so at a tick, as `Condition("deeper_than_mm", 1.9)`.

    when : what is looked at.
    value : what it is compared with, in the unit that ends the name of `when`; whole milliseconds for
        `after_ms`, 0 to 31 for `host_event`; 0 for what takes no value.
    """

    when: When
    value: float = 0.0

    def __post_init__(self) -> None:
        try:
            object.__setattr__(self, "when", When(self.when))
        except ValueError:
            raise ModelError(f"no condition {self.when!r}; use one of {', '.join(When)}") from None
        low, high = BOUNDS.get(self.when, (0.0, 0.0))
        if not (np.isfinite(self.value) and low <= self.value <= high):
            raise ModelError(f"{self.when} must be {low:g} to {high:g}, got {self.value}")
        if self.when in WHOLE and self.value != int(self.value):
            raise ModelError(f"{self.when} must be a whole number, got {self.value}")

    @classmethod
    def of(cls, stated: Mapping[When, Any]) -> Condition:
        """Return the condition that a file states as {when: value}, {when: true} where it has none."""
        ((when, value),) = stated.items()
        if (value is True) != (when in BARE):
            wanted = "true" if when in BARE else "a number"
            raise ModelError(f"{when} takes {wanted}, got {json.dumps(value)}")
        return cls(when, 0.0 if value is True else value)

    def to_dict(self) -> dict[str, float | Literal[True]]:
        """Return the condition as a file states it."""
        return {str(self.when): True if self.when in BARE else float(self.value)}

    def __str__(self) -> str:
        name, _, unit = self.when.rpartition("_")
        if self.when in BARE:
            return self.when.replace("_", " ")
        if self.when is When.HOST_EVENT:
            return f"host event {self.value:g}"
        if self.when in (When.FASTER_THAN, When.SLOWER_THAN):
            name, unit = self.when.removesuffix("_mm_s"), "mm/s"
        return f"{name.replace('_', ' ')} {self.value:g} {unit}"


Name = Annotated[str, Meta(min_length=1, max_length=40)]
"""Of a state, a surface or a signal."""

if TYPE_CHECKING:
    Stated = Condition
else:
    Stated = Annotated[
        dict[When, float | Literal[True]],
        Meta(
            min_length=1,
            max_length=1,
            description="one condition and its value; true for always, turned_to_press and turned_to_release",
            extra_json_schema={"propertyNames": {"enum": list(map(str, When))}},
        ),
    ]


@dataclass(frozen=True)
class Transition:
    """The way to another state, taken when its condition and its guard both hold.

    Attributes
    ----------
    to : name of the state to enter, which may be the same one.
    when : the condition.
    only_if : the guard, or None.
    signal : what vibrates on the way, instead of what the entered state plays; or None.
    """

    to: Name
    when: Stated
    only_if: Stated | None = None
    signal: Name | None = None

    def __post_init__(self) -> None:
        for name in ("when", "only_if"):
            if isinstance(stated := getattr(self, name), dict):
                object.__setattr__(self, name, Condition.of(stated))

    @property
    def conditions(self) -> tuple[Condition, ...]:
        """The condition, and the guard if there is one."""
        return (self.when, self.only_if) if self.only_if else (self.when,)

    def __str__(self) -> str:
        guard = f" if {self.only_if}" if self.only_if else ""
        return f"{self.when}{guard} → {self.to}"
