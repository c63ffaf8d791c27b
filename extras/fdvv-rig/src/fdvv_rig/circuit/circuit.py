"""The rig's circuit as records: kinds of parts with their pins, parts, nets, and what is drawn together."""

from __future__ import annotations

import tomllib
from collections.abc import Collection
from dataclasses import dataclass, field
from functools import cached_property
from importlib import resources
from pathlib import Path
from typing import Any

from fdvv.errors import InputError, ModelError

PIN_TYPES = ("source", "supply", "ground", "input", "output", "open", "analog", "passive", "free")

HEARS = ("input", "open", "analog")
"""Pins that listen to a voltage."""

UNITS = {"ohm": "Ω", "F": "F", "A": "A", "V": "V"}

TWO = ("resistor", "thermistor", "capacitor", "coil", "exciter", "fuse", "switch", "diode", "suppressor")
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

    @property
    def has_cell(self) -> bool:
        """Return whether this is a rig with a load cell and a linear current drive."""
        return "cell_mV_N" in self.facts

    @cached_property
    def net_of(self) -> dict[str, str]:
        """Return the net of every connected pin."""
        return {pin: net for net, pins in self.nets.items() for pin in pins}

    def pin(self, name: str) -> Pin:
        """Return a pin by "U1.A0". KeyError if there is none."""
        ref, _, pin = name.partition(".")
        return self.parts[ref].kind.pins[pin]

    def part_of(self, name: str) -> Component:
        """Return the part that a pin "U1.A0" belongs to."""
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


FORMAT, VERSION = "fdvv-circuit", 1

TOP = ("format", "version", "title", "kinds", "parts", "nets", "sheets", "filters", "facts")
CHANGES = ("base", "without", "without_sheets")
"""What only a circuit has that changes another."""

RIGS = {"paper": "circuit.toml", "recommended": "recommended.toml"}
"""The rigs whose circuits the package has, each with its file."""

PIN_KEYS = {"is": "type", "from": "feeds"}


def load_circuit(path: Path | None = None, rig: str = "paper") -> Circuit:
    """Read the circuit of one of RIGS, or another from a TOML file.

    Only the form is checked here; check_circuit tells whether it may be built. Raises InputError.
    """
    if path is None:
        return read_circuit(_packaged(RIGS[rig]), RIGS[rig])
    try:
        return read_circuit(path.read_text("utf-8"), path)
    except UnicodeDecodeError as error:
        raise InputError(
            path, "whole file", f"is no text ({error.reason})", "name a circuit's TOML"
        ) from None


def _packaged(name: str) -> str:
    return resources.files("fdvv_rig.circuit").joinpath(name).read_text("utf-8")


def read_circuit(text: str, source: object = "circuit") -> Circuit:
    """Read a circuit from TOML text, or the changes of a base. Raises InputError with the place."""
    document = _document(text, source)
    if "base" in document:
        if document["base"] not in RIGS.values():
            known = ", ".join(RIGS.values())
            raise InputError(source, "base", f"there is no {document['base']}", f"use one of {known}")
        document = changed(_document(_packaged(document["base"]), document["base"]), document)
    return _Reader(source, document).circuit()


def _document(text: str, source: object) -> dict[str, Any]:
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError(source, "whole file", f"is no TOML: {error}", "mend that place") from None


def changed(base: dict[str, Any], change: dict[str, Any]) -> dict[str, Any]:
    """Return a circuit's document with the changes of another.

    Parts in `without` go, and with them their pins; what has the same name is replaced; an empty net goes.
    """
    gone = set(change.get("without", ()))
    kept = {ref: part for ref, part in base.get("parts", {}).items() if ref not in gone}
    nets = {
        net: [pin for pin in pins if pin.partition(".")[0] not in gone]
        for net, pins in base.get("nets", {}).items()
    }
    nets |= change.get("nets", {})
    made = {**base, **{key: value for key, value in change.items() if key not in CHANGES}}
    made |= {table: {**base.get(table, {}), **change.get(table, {})} for table in ("kinds", "facts")}
    made["parts"] = {**kept, **change.get("parts", {})}
    used = {part.get("kind") for part in made["parts"].values()}
    made["kinds"] = {name: kind for name, kind in made["kinds"].items() if name in used}
    made["nets"] = {net: pins for net, pins in nets.items() if pins}
    for table, left_out in (("sheets", change.get("without_sheets", ())), ("filters", ())):
        made[table] = _named(base.get(table, []), change.get(table, []), left_out, made["parts"])
    return made


def _named(
    base: list[dict[str, Any]],
    change: list[dict[str, Any]],
    left_out: Collection[str],
    parts: Collection[str],
) -> list[dict[str, Any]]:
    """Return tables by name, the change's in place of the base's; filters without capacitor go."""
    by_name = {raw["name"]: raw for raw in (*base, *change)}
    found = [raw for name, raw in by_name.items() if name not in left_out]
    return [raw for raw in found if raw.get("capacitor") is None or raw["capacitor"] in parts]


class _Reader:
    def __init__(self, source: object, document: dict[str, Any]) -> None:
        self._source, self._document = source, document

    def circuit(self) -> Circuit:
        top = self._document
        if top.get("format") != FORMAT or top.get("version") != VERSION:
            self._refuse("format", f"is not {FORMAT} of version {VERSION}", "name a circuit's TOML")
        self._known("whole file", top, TOP)
        kinds = {name: self._kind(name, raw) for name, raw in top.get("kinds", {}).items()}
        parts = {ref: self._part(ref, raw, kinds) for ref, raw in top.get("parts", {}).items()}
        return Circuit(
            top.get("title", ""),
            kinds,
            parts,
            self._nets(parts),
            tuple(self._sheet(raw) for raw in top.get("sheets", ())),
            tuple(self._filter(raw, parts) for raw in top.get("filters", ())),
            {name: float(value) for name, value in top.get("facts", {}).items()},
        )

    def _refuse(self, place: str, reason: str, remedy: str) -> None:
        raise InputError(self._source, place, reason, remedy)

    def _known(self, place: str, raw: dict[str, Any], names: tuple[str, ...]) -> None:
        for name in raw:
            if name not in names:
                self._refuse(place, f"{name} is unknown", f"use {', '.join(names)}")

    def _kind(self, name: str, raw: dict[str, Any]) -> Kind:
        place = f"kinds.{name}"
        self._known(place, raw, ("about", "source", "pins", "tolerance"))
        pins = {pin: self._pin(f"{place}.pins.{pin}", pin, body) for pin, body in raw["pins"].items()}
        if name in TWO and list(pins) != ["1", "2"]:
            self._refuse(place, f"has the pins {', '.join(pins)}", "give it the pins 1 and 2")
        return Kind(name, raw.get("about", ""), raw.get("source", ""), pins, raw.get("tolerance", 0.0))

    def _pin(self, place: str, name: str, raw: dict[str, Any]) -> Pin:
        try:
            return Pin(name, **{PIN_KEYS.get(key, key): value for key, value in raw.items()})
        except (TypeError, ModelError) as error:
            raise InputError(self._source, place, str(error), "see the head of circuit.toml") from None

    def _part(self, ref: str, raw: dict[str, Any], kinds: dict[str, Kind]) -> Component:
        place = f"parts.{ref}"
        self._known(place, raw, ("kind", "value", "unit", "bill", "plug"))
        if raw.get("kind") not in kinds:
            self._refuse(place, f"its kind {raw.get('kind')} is unknown", "use one of kinds")
        if not raw.get("bill"):
            self._refuse(place, "has no role in the bill", "give it one, as bill")
        value = raw.get("value")
        if value is not None and (value <= 0 or raw.get("unit") not in UNITS):
            self._refuse(place, f"value {value} {raw.get('unit')}", f"a value above 0 in {', '.join(UNITS)}")
        return Component(ref, **{**raw, "kind": kinds[raw["kind"]]})

    def _nets(self, parts: dict[str, Component]) -> dict[str, tuple[str, ...]]:
        found = {}
        for net, pins in self._document.get("nets", {}).items():
            for pin in pins:
                ref, _, name = pin.partition(".")
                if ref not in parts or name not in parts[ref].kind.pins:
                    self._refuse(f"nets.{net}", f"there is no pin {pin}", "name a part's pin, as U1.A0")
            found[net] = tuple(pins)
        return found

    def _sheet(self, raw: dict[str, Any]) -> Sheet:
        return Sheet(
            raw["name"], raw["title"], tuple(map(tuple, raw["paths"])), tuple(raw.get("grounds", ()))
        )

    def _filter(self, raw: dict[str, Any], parts: dict[str, Component]) -> Filter:
        if raw["capacitor"] not in parts:
            self._refuse("filters", f"there is no part {raw['capacitor']}", "name a capacitor")
        return Filter(**{**raw, "paper_Hz": tuple(raw.get("paper_Hz", ()))})
