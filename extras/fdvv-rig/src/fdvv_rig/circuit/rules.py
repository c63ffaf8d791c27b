"""The electrical rule check: what would not work or would break, each with its place and a remedy."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass

from fdvv.errors import InputError
from fdvv_rig.circuit.circuit import HEARS, TWO, Circuit
from fdvv_rig.circuit.levels import Level, PowerState, levels
from fdvv_rig.circuit.power import power_budget

LOW_V = 0.4
"""At or below it every input reads as low."""
SAME_V = 0.2
"""Sources of one net may differ so much."""


@dataclass(frozen=True)
class Violation:
    """One broken rule.

    rule : its name. place : pin or net. reason : what was found. remedy : what to do.
    """

    rule: str
    place: str
    reason: str
    remedy: str

    def __str__(self) -> str:
        return f"{self.place}: {self.reason}; {self.remedy}"


def check_circuit(circuit: Circuit) -> tuple[Violation, ...]:
    """Return every broken rule of a circuit; empty if it may be built."""
    form = (*_connections(circuit), *_sources(circuit))
    return form or (
        *_supplies(circuit),
        *_overloads(circuit),
        *_inputs(circuit),
        *_floating(circuit),
        *_resting(circuit),
    )


def require_sound(circuit: Circuit, source: object) -> None:
    """Raise InputError with the first broken rule, and how many there are."""
    found = check_circuit(circuit)
    if found:
        more = f" (and {len(found) - 1} more)" if len(found) > 1 else ""
        raise InputError(source, found[0].place, f"{found[0].reason}{more}", found[0].remedy)


def _connections(circuit: Circuit) -> Iterator[Violation]:
    counts = Counter(pin for pins in circuit.nets.values() for pin in pins)
    for name in circuit.pins():
        free = circuit.pin(name).type == "free"
        if counts[name] > 1:
            yield Violation("once", name, f"stands in {counts[name]} nets", "connect it once")
        if not counts[name] and not free:
            yield Violation("open", name, "is not connected", "connect it, or mark it free")
        if counts[name] and free:
            yield Violation("free", name, "is free but connected", "leave it out of the nets")
    for net, pins in circuit.nets.items():
        if len(set(pins)) < 2:
            yield Violation("single", net, "joins nothing", "give the net two pins or more")


def _sources(circuit: Circuit) -> Iterator[Violation]:
    for net, pins in circuit.nets.items():
        drives = [p for p in pins if circuit.pin(p).type in ("source", "output", "ground")]
        volts = {0.0 if circuit.pin(p).type == "ground" else circuit.pin(p).V or 0.0 for p in drives}
        outputs = [p for p in drives if circuit.pin(p).type == "output"]
        if drives and max(volts) - min(volts) > SAME_V:
            drivers = " and ".join(f"{p} of {circuit.pin(p).V or 0:g} V" for p in drives)
            yield Violation("short", net, f"joins {drivers}", "part them")
        elif outputs and len(drives) > 1:
            yield Violation("drive", net, f"is driven by {' and '.join(drives)}", "leave one of them")


def _supplies(circuit: Circuit) -> Iterator[Violation]:
    at = levels(circuit, PowerState())
    for name, net in circuit.net_of.items():
        pin, V = circuit.pin(name), at[net].V
        if pin.type == "supply" and not (pin.low_V or 0.0) <= V <= (pin.high_V or 1e9):
            bound = f"{pin.low_V:g} to {pin.high_V:g} V"
            reason = f"is fed {V:.2f} V, it takes {bound}"
            yield Violation("supply", name, reason, "feed it from another rail")
        if pin.type == "ground" and at[net].V > 0.05:
            yield Violation("ground", name, f"stands at {V:.2f} V", "join it with ground")


def _overloads(circuit: Circuit) -> Iterator[Violation]:
    for rail in power_budget(circuit):
        if rail.peak_mA > rail.limit_mA:
            reason = f"gives {rail.limit_mA:g} mA at most, {rail.peak_mA:.0f} mA hang on it"
            yield Violation("overload", rail.source, reason, "take a stronger source or part the loads")


def _inputs(circuit: Circuit) -> Iterator[Violation]:
    at = levels(circuit, PowerState())
    for name, net in circuit.net_of.items():
        pin, level = circuit.pin(name), at[net]
        if pin.type not in HEARS:
            continue
        if pin.max_V is not None and pin.max_V < level.V:
            reason = f"is driven with {level.V:.2f} V, it bears {pin.max_V:g} V"
            yield Violation("too high", name, reason, "put a level shifter or a divider before it")
        elif pin.high_V is not None and _driven(circuit, net) and pin.high_V > level.V:
            reason = f"gets {level.V:.2f} V at most and takes {pin.high_V:g} V as high"
            yield Violation("too low", name, reason, "put a level shifter before it")
        if pin.max_source_ohm and level.ohm > pin.max_source_ohm and not level.floats:
            reason = f"is driven with {level.ohm:.0f} ohm, it takes {pin.max_source_ohm:g}"
            yield Violation("weak", name, reason, "use smaller resistors or a buffer")


def _driven(circuit: Circuit, net: str) -> bool:
    types = {circuit.pin(p).type for p in circuit.nets[net]}
    if "output" in types or "ground" in types:
        return "output" in types
    ends = {b if a == net else a for _, a, b in circuit.between("resistor") if net in (a, b)}
    return any(circuit.pin(p).type in ("output", "source") for end in ends if end for p in circuit.nets[end])


def _states(circuit: Circuit) -> Iterator[tuple[str, PowerState]]:
    yield "", PowerState()
    yield " with contacts open", PowerState(contacts_open=True)
    for part in circuit.parts.values():
        if part.plug:
            yield f" with {part.ref} pulled out", PowerState(absent=(part.ref,))


def _floating(circuit: Circuit) -> Iterator[Violation]:
    reported = set()
    for when, state in _states(circuit):
        at = levels(circuit, state)
        for name, net in circuit.net_of.items():
            pin = circuit.pin(name)
            listens = pin.type in HEARS and not pin.bias and circuit.part_of(name).ref not in state.absent
            if listens and at[net].floats and name not in reported:
                reported.add(name)
                remedy = "give it a resistor to ground or to its rail"
                yield Violation("floats", name, f"floats{when}", remedy)


def _resting(circuit: Circuit) -> Iterator[Violation]:
    controllers = [p.ref for p in circuit.parts.values() if any(pin.signal for pin in p.kind.pins.values())]
    at: dict[str, Level] = levels(circuit, PowerState(released=controllers))
    for name, net in circuit.net_of.items():
        if circuit.pin(name).rest == "low" and (at[net].floats or at[net].V > LOW_V):
            what = "floats" if at[net].floats else f"rests at {at[net].V:.2f} V"
            yield Violation("rest", name, f"{what} while the controller is in reset", "pull it to ground")


def undrawn(circuit: Circuit) -> list[str]:
    """List parts of two pins that no sheet would draw: neither in a path, nor from a drawn net to a rail."""
    in_paths = {step for sheet in circuit.sheets for path in sheet.paths for step in path[1:-1]}
    drawn = {net for sheet in circuit.sheets for path in sheet.paths for net in path_nets(circuit, path)}
    hung = {
        part.ref
        for kind in TWO
        for part, a, b in circuit.between(kind)
        if part.ref not in in_paths and (a in drawn or b in drawn)
    }
    two = {part.ref for kind in TWO for part, _, _ in circuit.between(kind)}
    return sorted(two - in_paths - hung)


def path_nets(circuit: Circuit, path: tuple[str, ...]) -> list[str]:
    """Return the nets that a drawn path passes; InputError if its steps are not connected."""
    nets = [circuit.net_of[path[0]]]
    for ref in path[1:-1]:
        ends = [circuit.net_of.get(f"{ref}.1", ""), circuit.net_of.get(f"{ref}.2", "")]
        if nets[-1] not in ends:
            reason = f"{ref} is not at {nets[-1]}"
            raise InputError("circuit", " ".join(path), reason, "mend the sheet's path")
        nets.append(ends[1] if ends[0] == nets[-1] else ends[0])
    if circuit.net_of[path[-1]] != nets[-1]:
        raise InputError("circuit", " ".join(path), f"ends at {nets[-1]}", "mend the sheet's path")
    return nets
