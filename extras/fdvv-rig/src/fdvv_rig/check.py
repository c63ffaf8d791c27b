"""Check exported parts: are they closed, as large as they were made, do they collide anywhere in the rig?"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from itertools import combinations

from fdvv_rig.bought import bought_parts
from fdvv_rig.dimensions import Dimensions
from fdvv_rig.envelope import Envelope
from fdvv_rig.mesh import Mesh
from fdvv_rig.placement import CELL_RIG, MOVES, RIG, Moves, State, in_rig, moved
from fdvv_rig.solids import Body, body_of, body_of_bought, gap_mm, placed, shared_mm3

SHARED_mm3 = 0.05
"""Less is the facets of round faces, which are chords."""

TRAVELS = (0.0, 0.25, 0.5, 0.75, 1.0)
"""As shares of the whole travel."""

JOINED = frozenset(
    {
        *(frozenset(pair) for pair in (("slider-yoke", "keycap-adapter"), ("coil-mount", "base"))),
        *(frozenset(pair) for pair in (("lvdt-mount", "base"), ("limiter-bracket", "base"))),
        frozenset(("slider-yoke", "cell-holder")),
    }
)
"""Printed pairs that touch, screwed together. They may share no room all the same."""

STOP = frozenset(("slider-yoke", "limiter-arm"))


@dataclass(frozen=True)
class Meeting:
    """Two parts that share room in a state, in mm³."""

    one: str
    other: str
    travel_mm: float
    stop_mm: float
    shared_mm3: float


@dataclass(frozen=True)
class Clearance:
    """How close a moving part comes to another over all states, in mm, and at which travel."""

    one: str
    other: str
    gap_mm: float
    travel_mm: float


@dataclass(frozen=True)
class Assembly:
    """The rig's bodies: printed ones on their beds, bought ones at travel 0."""

    d: Dimensions
    printed: Mapping[str, Body]
    bought: Mapping[str, Body]
    envelopes: Mapping[str, Envelope]

    def at(self, state: State) -> dict[str, Body]:
        """Return every body where it is in a state."""
        found = {name: placed(body, in_rig(name, state, self.d)) for name, body in self.printed.items()}
        for name, body in self.bought.items():
            found[name] = placed(body, moved(self.envelopes[name].moves, state, self.d))
        return found

    def may_share(self, one: str, other: str) -> bool:
        """Return whether one goes into the other: a thread, or a rod in what is drawn full."""
        return other in self._of(one).enters or one in self._of(other).enters

    def may_touch(self, one: str, other: str) -> bool:
        """Return whether a pair touches by design."""
        fastened = other in self._of(one).holds or one in self._of(other).holds
        pair = frozenset((one, other))
        return fastened or self.may_share(one, other) or pair in JOINED or pair == STOP

    def moves(self, name: str) -> Moves:
        """Return what a part moves with."""
        return self._of(name).moves

    def _of(self, name: str) -> Envelope:
        printed = Envelope(name, name, MOVES.get(name, Moves.FIXED), ())
        return self.envelopes.get(name, printed)


def assemble(meshes: Mapping[str, Mesh], d: Dimensions, cell: bool = False) -> Assembly:
    """Put exported parts and bought ones together. Raises ValueError where a mesh is not closed.

    cell : the rig with a load cell, else the paper's.
    """
    bought = bought_parts(d, cell)
    return Assembly(
        d,
        {name: body_of(meshes[name]) for name in (CELL_RIG if cell else RIG)},
        {envelope.name: body_of_bought(envelope) for envelope in bought},
        {envelope.name: envelope for envelope in bought},
    )


def states(d: Dimensions) -> Iterator[State]:
    """Yield the states that are checked: several travels, the stop right below and as deep as it goes."""
    for share in TRAVELS:
        travel_mm = share * d.travel_mm
        for stop_mm in sorted({min(travel_mm + 0.05, d.travel_mm), d.travel_mm}):
            yield State(min(travel_mm, stop_mm - 0.02), stop_mm)


def meetings(assembly: Assembly, state: State) -> list[Meeting]:
    """Return the pairs that share room in a state though they are not fastened to each other."""
    bodies, found = assembly.at(state), []
    for one, other in combinations(bodies, 2):
        if assembly.may_share(one, other) or gap_mm(bodies[one], bodies[other], 0.01) > 0:
            continue
        shared = shared_mm3(bodies[one], bodies[other])
        if shared > SHARED_mm3:
            stop_mm = assembly.d.travel_mm if state.stop_mm is None else state.stop_mm
            found.append(Meeting(one, other, state.travel_mm, stop_mm, shared))
    return found


def clearances(
    assembly: Assembly, tell: Callable[[int, int], None] = lambda _done, _total: None
) -> list[Clearance]:
    """Return the smallest gap of every pair that moves against each other and does not touch by design.

    tell : called with how many states are done, and how many there are.
    """
    closest: dict[tuple[str, str], Clearance] = {}
    todo = list(states(assembly.d))
    for done, state in enumerate(todo):
        tell(done, len(todo))
        bodies = assembly.at(state)
        for one, other in combinations(bodies, 2):
            if assembly.moves(one) is assembly.moves(other) or assembly.may_touch(one, other):
                continue
            gap = gap_mm(bodies[one], bodies[other])
            if (one, other) not in closest or gap < closest[one, other].gap_mm:
                closest[one, other] = Clearance(one, other, gap, state.travel_mm)
    return sorted(closest.values(), key=lambda found: found.gap_mm)
