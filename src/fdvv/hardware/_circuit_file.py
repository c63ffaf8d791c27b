"""Read a circuit from TOML; what is wrong is refused with its place."""

from __future__ import annotations

import tomllib
from importlib import resources
from pathlib import Path
from typing import Any

from fdvv.errors import InputError, ModelError
from fdvv.hardware._circuit import TWO, UNITS, Circuit, Component, Filter, Kind, Pin, Sheet

FORMAT, VERSION = "fdvv-circuit", 1
TOP = ("format", "version", "title", "kinds", "parts", "nets", "sheets", "filters", "facts")
PIN_KEYS = {"is": "type", "from": "feeds"}


def load_circuit(path: Path | None = None) -> Circuit:
    """Read the rig's own circuit, or another from a TOML file.

    Only the form is checked here; check_circuit tells whether it may be built. Raises InputError.
    """
    if path is None:
        text = resources.files("fdvv.hardware").joinpath("circuit.toml").read_text("utf-8")
        return read_circuit(text, "circuit.toml")
    try:
        return read_circuit(path.read_text("utf-8"), path)
    except UnicodeDecodeError as error:
        raise InputError(
            path, "whole file", f"is no text ({error.reason})", "name a circuit's TOML"
        ) from None


def read_circuit(text: str, source: object = "circuit") -> Circuit:
    """Read a circuit from TOML text. Raises InputError with the place."""
    try:
        document = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError(source, "whole file", f"is no TOML: {error}", "mend that place") from None
    return _Reader(source, document).circuit()


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
