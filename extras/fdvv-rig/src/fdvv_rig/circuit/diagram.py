"""Circuit diagrams of a sheet: every path a line from pin to pin, with what hangs on it; needs schemdraw."""

from __future__ import annotations

from typing import Any

from fdvv.errors import BuildError
from fdvv_rig.circuit.circuit import TWO, Circuit, Component, Sheet
from fdvv_rig.circuit.rules import path_nets

STEP, SERIES, SHUNT, TAG = 1.7, 3.0, 2.2, 3.4
"""Widths: of a pin on a line, a part within it, a part that hangs on it, an end's box."""
DOWN, UP, PLAIN = 3.4, 2.9, 0.9
"""Heights: of a part that hangs down, of one that stands up, of a pin."""
BOX_FILL, INK, FAINT = "#e8eef7", "#1c2430", "#5a6676"
ELEMENTS = {"resistor": "ResistorIEC", "coil": "Inductor2", "exciter": "ResistorIEC", "fuse": "FuseIEC"}
ELEMENTS |= {
    "thermistor": "Thermistor",
    "switch": "Button",
    "diode": "Diode",
    "suppressor": "Zener",
    "capacitor": "Capacitor",
}
CONTACTS = {"emergency stop": {"nc": True}, "clapper switch": {"nc": False}}
POLAR_F, LETTER = 1e-5, 0.145
PINS_PER_LINE = 9
"""Pins of a ground listed in one line."""


def sheet_svgs(circuit: Circuit) -> dict[str, str]:
    """Draw every sheet as SVG text, by name; what hangs on a net is drawn where the net comes first.

    BuildError without schemdraw.
    """
    seen: set[str] = set()
    return {sheet.name: _Drawer(circuit, sheet, seen).svg() for sheet in circuit.sheets}


def _library() -> tuple[Any, Any]:
    try:
        import schemdraw
        import schemdraw.elements
    except ImportError as error:
        raise BuildError("drawing the circuit needs schemdraw: pip install schemdraw") from error
    return schemdraw, schemdraw.elements


class _Drawer:
    """One sheet. `seen` holds the nets whose hanging parts and pins were drawn before."""

    def __init__(self, circuit: Circuit, sheet: Sheet, seen: set[str]) -> None:
        self._circuit, self._sheet, self._seen = circuit, sheet, seen
        self._library, self._elements = _library()
        self._in_paths = {step for s in circuit.sheets for path in s.paths for step in path[1:-1]}

    def svg(self) -> str:
        self._library.config(fontsize=11, lw=1.4, color=INK, bgcolor="white", font="sans-serif")
        drawing = self._library.Drawing(canvas="svg", show=False)
        y = 0.0
        self._text(drawing, (0, 1.6), self._sheet.title, 15, "left")
        for path in self._sheet.paths:
            nets = path_nets(self._circuit, path)
            fresh = [net for net in nets if net not in self._seen and not self._is_ground(net)]
            y -= self._above(fresh, path)
            self._path(drawing, path, nets, y)
            y -= self._below(fresh)
        for net in self._sheet.grounds:
            y = self._ground(drawing, net, y)
        return str(drawing.get_imagedata("svg").decode())

    def _above(self, nets: list[str], path: tuple[str, ...]) -> float:
        if any(not self._is_ground(end) for net in nets for _, end in self._hanging(net)):
            return UP
        return PLAIN + 0.7 if any(self._others(net, path) for net in nets) else PLAIN

    def _below(self, nets: list[str]) -> float:
        return DOWN if any(self._is_ground(end) for net in nets for _, end in self._hanging(net)) else PLAIN

    # -- what is where -------------------------------------------------------------------------------------

    def _is_ground(self, net: str) -> bool:
        return any(self._circuit.pin(pin).type == "ground" for pin in self._circuit.nets[net])

    def _is_rail(self, net: str) -> bool:
        return any(self._circuit.pin(pin).type in ("ground", "source") for pin in self._circuit.nets[net])

    def _hanging(self, net: str) -> list[tuple[Component, str]]:
        found = []
        for kind in TWO:
            for part, a, b in self._circuit.between(kind):
                end = b if a == net else a
                if net in (a, b) and part.ref not in self._in_paths and self._is_rail(end):
                    found.append((part, end))
        return found

    def _others(self, net: str, path: tuple[str, ...]) -> list[str]:
        pins = self._circuit.nets[net]
        return [p for p in pins if p not in path and self._circuit.part_of(p).kind.name not in TWO]

    # -- drawing -------------------------------------------------------------------------------------------

    def _path(self, drawing: Any, path: tuple[str, ...], nets: list[str], y: float) -> None:
        self._box(drawing, path[0], (0.0, y))
        x = TAG
        for i, net in enumerate(nets):
            x = self._net(drawing, net, path, (x, y))
            if i < len(nets) - 1:
                part = self._circuit.parts[path[1 + i]]
                self._part(drawing, part, net, (x, y), (x + SERIES, y))
                x += SERIES
        if self._is_ground(nets[-1]):
            drawing.add(self._elements.Ground().at((x, y)))
        else:
            self._box(drawing, path[-1], (x, y))

    def _net(self, drawing: Any, net: str, path: tuple[str, ...], at: tuple[float, float]) -> float:
        x, y = at
        fresh = net not in self._seen and not self._is_ground(net)
        hanging = self._hanging(net) if fresh else []
        others = self._others(net, path) if fresh else []
        self._seen.add(net)
        lead = max(1.5, 0.4 + LETTER * len(net))
        end = x + lead + SHUNT * len(hanging) + STEP * len(others)
        drawing.add(self._elements.Line().at((x, y)).to((end, y)))
        self._text(drawing, (x + 0.1, y + 0.18), net, 8, "left", FAINT)
        x += lead
        for part, rail in hanging:
            self._hang(drawing, part, net, rail, (x, y))
            x += SHUNT
        for pin in others:
            drawing.add(self._elements.Dot().at((x, y)))
            drawing.add(self._elements.Line().at((x, y)).to((x, y + 0.5)))
            self._text(drawing, (x, y + 0.62), pin, 9, "center")
            x += STEP
        return end

    def _ground(self, drawing: Any, net: str, y: float) -> float:
        pins = [p for p in self._circuit.nets[net] if self._circuit.part_of(p).kind.name not in TWO]
        lines = [pins[i : i + PINS_PER_LINE] for i in range(0, len(pins), PINS_PER_LINE)]
        for i, line in enumerate(lines):
            text = f"{net}, joined in one star: " if i == 0 else "      "
            self._text(drawing, (0, y - 0.5 * i), text + "  ".join(line), 10, "left")
        return y - 0.5 * len(lines) - 0.4

    def _hang(self, drawing: Any, part: Component, net: str, rail: str, at: tuple[float, float]) -> None:
        x, y = at
        drawing.add(self._elements.Dot().at(at))
        if self._is_ground(rail):
            self._part(drawing, part, net, at, (x, y - 2.1))
            drawing.add(self._elements.Ground().at((x, y - 2.1)))
        else:
            self._part(drawing, part, net, at, (x, y + 2.0))
            drawing.add(self._elements.Vdd().at((x, y + 2.0)).label(rail, fontsize=8))

    def _part(
        self, drawing: Any, part: Component, net: str, a: tuple[float, float], b: tuple[float, float]
    ) -> None:
        name = ELEMENTS[part.kind.name]
        if part.kind.name == "capacitor" and (part.value or 0) > POLAR_F:
            name = "CapacitorPolar" if hasattr(self._elements, "CapacitorPolar") else "Capacitor2"
        if part.bill == "infrared LED":
            name = "LED"
        first_is_net = self._circuit.net_of[f"{part.ref}.1"] == net
        begin, end = (a, b) if first_is_net else (b, a)
        element = getattr(self._elements, name)(**CONTACTS.get(part.bill, {})).endpoints(begin, end)
        drawing.add(element)
        label = f"{part.ref} {part.text}".strip()
        if a[1] == b[1]:
            above = -0.55 if name == "LED" else 0.55  # its arrows point up
            self._text(drawing, ((a[0] + b[0]) / 2, a[1] + above), label, 10, "center")
        else:
            x, middle = a[0] + 0.42, (a[1] + b[1]) / 2
            self._text(drawing, (x, middle + 0.22), part.ref, 10, "left")
            self._text(drawing, (x, middle - 0.22), part.text, 9, "left", FAINT)

    def _box(self, drawing: Any, pin: str, at: tuple[float, float]) -> None:
        x, y = at
        part = self._circuit.part_of(pin)
        box = self._elements.Rect(corner1=(0, -0.55), corner2=(TAG, 0.55), fill=BOX_FILL)
        drawing.add(box.at((x, y)).theta(0))
        known = self._circuit.pin(pin)
        extra = known.chip or (f"pin {known.number}" if known.number else "")
        self._text(
            drawing, (x + TAG / 2, y + 0.2), f"{pin} {f'({extra})' if extra else ''}".strip(), 11, "center"
        )
        self._text(drawing, (x + TAG / 2, y - 0.24), part.kind.name, 8, "center", FAINT)

    def _text(
        self, drawing: Any, at: tuple[float, float], text: str, size: int, side: str, color: str = INK
    ) -> None:
        label = self._elements.Label().at(at).theta(0)
        drawing.add(label.label(text, fontsize=size, halign=side, valign="center", ofst=0, color=color))
