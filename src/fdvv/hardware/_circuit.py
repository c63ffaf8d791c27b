"""The rig's circuit as records: kinds of parts with their pins, parts, nets, and what is drawn together."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

from fdvv.errors import ModelError

PIN_TYPES = ("source", "supply", "ground", "input", "output", "open", "analog", "passive", "free")
HEARS = ("input", "open", "analog")
"""Pins that listen to a voltage."""
UNITS = {"ohm": "Ω", "F": "F", "A": "A", "V": "V"}
TWO = ("resistor", "capacitor", "coil", "exciter", "fuse", "switch", "diode", "suppressor")
"""Kinds with two pins, drawn by their symbol."""


@dataclass(frozen=True)
class Pin:
    """One pin of a kind of part.

    Attributes
    ----------
    name : as printed on the board. number, chip, signal : of the package, of the chip, of the firmware.
    type : one of PIN_TYPES; V : what a source or a high output gives. ohm : inside an output.
    limit_mA : of a source.
    low_V, high_V : of a supply its range; of an input high_V is the level from which it reads as high.
    max_V : what destroys an input. max_source_ohm : largest resistance of what drives a converter.
    bias : it sets its own rest level. load_ohm : what it loads its driver with.
    rest : "low" if it must be low while the controller's outputs float.
    mA, peak_mA : what a supply takes. feeds, efficiency_ratio : of a regulator's input, the pin it feeds.
    """

    name: str
    type: str
    V: float | None = None
    ohm: float = 30.0
    limit_mA: float | None = None
    low_V: float | None = None
    high_V: float | None = None
    max_V: float | None = None
    max_source_ohm: float | None = None
    load_ohm: float | None = None
    bias: bool = False
    rest: str = ""
    mA: float = 0.0
    peak_mA: float = 0.0
    feeds: str = ""
    efficiency_ratio: float = 1.0
    number: str = ""
    chip: str = ""
    signal: str = ""

    def __post_init__(self) -> None:
        if self.type not in PIN_TYPES:
            raise ModelError(f"pin {self.name}: type must be one of {', '.join(PIN_TYPES)}, got {self.type}")
        needs = {"source": ("V", "limit_mA"), "output": ("V",), "analog": ("max_V",), "supply": ("low_V",)}
        needs |= {"input": ("max_V", "high_V"), "open": ("max_V", "high_V")}
        missing = [name for name in needs.get(self.type, ()) if getattr(self, name) is None]
        if missing:
            raise ModelError(f"pin {self.name}: a pin of type {self.type} needs {', '.join(missing)}")


@dataclass(frozen=True)
class Kind:
    """What parts of one kind have in common: pins by name, and tolerance of their value.

    source : where their figures come from.
    """

    name: str
    about: str
    source: str
    pins: dict[str, Pin]
    tolerance: float = 0.0


@dataclass(frozen=True)
class Component:
    """One part: reference, kind, role in the bill, value in SI units; a plug may be pulled out."""

    ref: str
    kind: Kind
    bill: str
    value: float | None = None
    unit: str = ""
    plug: bool = False

    @property
    def text(self) -> str:
        """Write the value: 5.23 kΩ, 10 nF, 2.5 A; nothing where there is none."""
        return "" if self.value is None else engineering(self.value, UNITS[self.unit])


@dataclass(frozen=True)
class Sheet:
    """What is drawn together.

    name, title : of the sheet. paths : each leads from pin to pin. grounds : are listed below.
    """

    name: str
    title: str
    paths: tuple[tuple[str, ...], ...]
    grounds: tuple[str, ...] = ()


@dataclass(frozen=True)
class Filter:
    """A filter by its capacitor and the net it works on; paper_Hz is what the paper prints for it."""

    name: str
    about: str
    kind: str
    capacitor: str
    net: str
    paper_Hz: tuple[float, ...] = ()


@dataclass(frozen=True, eq=False)
class Circuit:
    """Parts, nets (pins "U1.A0" by net), sheets, filters and facts; checked for its form only."""

    title: str
    kinds: dict[str, Kind]
    parts: dict[str, Component]
    nets: dict[str, tuple[str, ...]]
    sheets: tuple[Sheet, ...] = ()
    filters: tuple[Filter, ...] = ()
    facts: dict[str, float] = field(default_factory=dict)

    @cached_property
    def net_of(self) -> dict[str, str]:
        """Give the net of every connected pin."""
        return {pin: net for net, pins in self.nets.items() for pin in pins}

    def pin(self, name: str) -> Pin:
        """Give a pin by "U1.A0". KeyError if there is none."""
        ref, _, pin = name.partition(".")
        return self.parts[ref].kind.pins[pin]

    def part_of(self, name: str) -> Component:
        """Give the part that a pin "U1.A0" belongs to."""
        return self.parts[name.partition(".")[0]]

    def pins(self) -> list[str]:
        """List all pins of all parts."""
        return [f"{part.ref}.{pin}" for part in self.parts.values() for pin in part.kind.pins]

    def between(self, kind: str) -> list[tuple[Component, str, str]]:
        """List the parts of a kind (its name) with two pins, and the nets they join."""
        found = [part for part in self.parts.values() if part.kind.name == kind]
        return [(p, self.net_of.get(f"{p.ref}.1", ""), self.net_of.get(f"{p.ref}.2", "")) for p in found]


def engineering(value: float, unit: str) -> str:
    """Write a value with a prefix that leaves one to three digits before the point."""
    steps = ((1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n"), (1e-12, "p"))
    size, prefix = next(((s, p) for s, p in steps if abs(value) >= 0.9999999 * s), (1.0, ""))
    return f"{value / size:.4g} {prefix}{unit}"
