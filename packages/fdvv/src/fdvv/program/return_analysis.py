"""Proof that the cap comes back: with the finger off, every state leads to the start state at the top.

All motions of the cap are over-approximated by a finite graph; a node is a state, what is known of the
motion, and a cell of the stroke. Every node is left in a bounded time. So if the graph has no cycle, and no
dead end but the start state at the top, every motion ends there. What is assumed is in `Limits`;
docs/explanation/programs.md says what follows and what does not.
"""

from __future__ import annotations

from collections.abc import Iterator
from enum import Enum
from functools import cached_property
from itertools import product
from typing import NamedTuple

from fdvv.force_text import force_text
from fdvv.program.motion import Motion
from fdvv.program.program import Program
from fdvv.program.reachability import Direction
from fdvv.program.surface import Limits


class HazardKind(Enum):
    """What is known of the cap's motion at a node."""

    DOWN = "moving down against a force that lifts"
    UP = "moving up, or at rest below the top"
    TOP = "bouncing or at rest at the top"
    PULLED = "moving down with a force that pulls"
    ANYHOW = "moving anyhow until the state's time is over"
    FADING = "moving anyhow until the force has faded in"


class Node(NamedTuple):
    """Where the cap may be: number of the state, what is known of its motion, cell."""

    state: int
    kind: HazardKind
    cell: int = 0


class ReturnHazard(NamedTuple):
    """Why the return cannot be proven: the state, the place in it, what may happen, and what helps."""

    state: str
    place: str
    reason: str
    remedy: str


class ReturnAnalysis:
    """The graph of all motions of one program with the finger off."""

    def __init__(self, program: Program, limits: Limits, margin_cN: float) -> None:
        self.program = program
        self.motion = Motion(program, limits, margin_cN)
        self.cells = self.motion.cells
        self.index = {state.name: i for i, state in enumerate(program.states)}
        self._known: dict[tuple[int, int, Direction], tuple[list[int], bool]] = {}

    def successors(self, state: int, cell: int, way: Direction) -> tuple[list[int], bool]:
        """Return the states that may follow at once in a cell, and whether one of them must."""
        key = (state, cell, way)
        if key not in self._known:
            states, must = [], False
            for transition in self.program.states[state].transitions:
                if self.cells.may_fire(transition, cell, way):
                    states.append(self.index[transition.to])
                    must = self.cells.must_fire(transition, cell)
                if must:
                    break
            self._known[key] = states, must
        return self._known[key]

    def enter(self, state: int, cell: int, way: Direction, pulled: bool = False) -> Node:
        """Return the node that a transition leads to; pulled: the force before it may not have lifted."""
        fades = self.program.states[state].fade_ms > 0
        if self.motion.lifts(state):
            if fades and pulled:
                return Node(state, HazardKind.FADING)
            return Node(state, HazardKind.DOWN if way is Direction.DOWN else HazardKind.UP, cell)
        if self.motion.pulls(state) and way is Direction.DOWN and not fades:
            return Node(state, HazardKind.PULLED, cell)
        return Node(state, HazardKind.ANYHOW)

    def _follow(self, node: Node, cell: int, way: Direction) -> Iterator[Node]:
        pulled = node.kind in (HazardKind.PULLED, HazardKind.ANYHOW, HazardKind.FADING)
        for state in self.successors(node.state, cell, way)[0]:
            yield self.enter(state, cell, way, pulled)

    def followers(self, node: Node) -> tuple[list[Node], list[Node]]:
        """Return the nodes that follow by motion within the state, and those that follow by a transition."""
        match node.kind:
            case HazardKind.DOWN:
                return self._down(node)
            case HazardKind.UP:
                return self._up(node)
            case HazardKind.TOP:
                near = self.motion.top_cells(node.state)
                return [], [e for c in near for way in Direction for e in self._follow(node, c, way)]
            case HazardKind.PULLED:
                return self._after_pull(node)
            case _:
                everywhere = range(self.cells.count)
                entered = [e for c in everywhere for way in Direction for e in self._follow(node, c, way)]
                kinds = (HazardKind.DOWN, HazardKind.UP) if node.kind is HazardKind.FADING else ()
                return [Node(node.state, kind, c) for c in everywhere for kind in kinds], entered

    def _down(self, node: Node) -> tuple[list[Node], list[Node]]:
        turned: list[Node] = []
        entered: list[Node] = []
        for cell in self.motion.coast_cells(node.state, node.cell):
            entered += self._follow(node, cell, Direction.DOWN)
            if self.successors(node.state, cell, Direction.DOWN)[1]:
                break
            turned = [Node(node.state, HazardKind.UP, cell)]
        return turned, entered

    def _up(self, node: Node) -> tuple[list[Node], list[Node]]:
        entered = list(self._follow(node, node.cell, Direction.UP))
        if self.successors(node.state, node.cell, Direction.UP)[1]:
            return [], entered
        if node.cell in self.motion.top_cells(node.state):
            return [Node(node.state, HazardKind.TOP)], entered
        return [Node(node.state, HazardKind.UP, node.cell - 1)], entered

    def _after_pull(self, node: Node) -> tuple[list[Node], list[Node]]:
        edges_mm = self.cells.edges_mm
        zone_mm = edges_mm[-1] - self.motion.bottom_zone_mm(node.state)
        entered: list[Node] = []
        for cell in range(self.cells.count):
            bounces = edges_mm[cell + 1] > zone_mm
            if cell >= node.cell or bounces:
                entered += self._follow(node, cell, Direction.DOWN)
            if bounces:
                entered += self._follow(node, cell, Direction.UP)
        return [], entered

    # -- flaws ---------------------------------------------------------------------------------------------

    def hazards(self) -> list[ReturnHazard]:
        """Return why the cap may not come back: dead ends, or where there are none the first cycle."""
        return self.dead_ends() or self._cycle_hazards()

    def dead_ends(self) -> list[ReturnHazard]:
        """Return the states in which the cap may stay for ever, other than at the top in the start state."""
        hazards = []
        for i, state in enumerate(self.program.states):
            lifts = self.motion.lifts(i)
            if not lifts and state.name == self.program.start:
                reason = "may not lift the cap, and is the start state"
                hazards.append(ReturnHazard(state.name, self._weakest(i), reason, "raise its forces there"))
            elif not lifts and self.motion.longest_stay_s(i) is None:
                reason = "may not lift the cap, and no after_ms without a guard ends it"
                remedy = "raise its forces there, or let an after_ms without only_if end it"
                hazards.append(ReturnHazard(state.name, self._weakest(i), reason, remedy))
            elif lifts and self.motion.stay_at_top_s(i) is None and state.name != self.program.start:
                reason = "nothing is sure to lead on to the start state"
                remedy = "let a shallower_than_mm lead towards it"
                hazards.append(ReturnHazard(state.name, "at the top", reason, remedy))
        return hazards

    def _weakest(self, state: int) -> str:
        first = self.motion.first
        least = self.cells.least_cN[state]
        cell = first + int(least[first:].argmin())
        place = f"{self.cells.edges_mm[cell]:.2f} mm, at least {force_text(least[cell], '.1f')}"
        return f"{place} against {force_text(self.motion.limits.opposing_cN)} of friction"

    @cached_property
    def starts(self) -> list[Node]:
        """Return every node in which the finger may leave the cap."""
        everywhere = product(range(len(self.program.states)), range(self.cells.count), Direction)
        return list(dict.fromkeys(self.enter(*place) for place in everywhere))

    def find_cycle(self) -> list[Node]:
        """Return nodes that may follow each other for ever, the last being the first again; or none."""
        done: set[Node] = set()
        for start in self.starts:
            path: dict[Node, Iterator[Node]] = {}
            self._push(path, start, done)
            while path:
                node = next(reversed(path))
                follower = next(path[node], None)
                if follower is None:
                    done.add(node)
                    del path[node]
                elif follower in path:
                    nodes = list(path)
                    return [*nodes[nodes.index(follower) :], follower]
                else:
                    self._push(path, follower, done)
        return []

    def _push(self, path: dict[Node, Iterator[Node]], node: Node, done: set[Node]) -> None:
        if node not in done:
            moved, entered = self.followers(node)
            path[node] = iter(dict.fromkeys([*moved, *entered]))

    def _cycle_hazards(self) -> list[ReturnHazard]:
        """Return the first cycle as a hazard, if there is one: its states and where it turns."""
        cycle = self.find_cycle()
        if not cycle:
            return []
        names = [self.program.states[node.state].name for node in cycle]
        loop = [name for i, name in enumerate(names) if i == 0 or name != names[i - 1]]
        edge_mm = self.cells.edges_mm[max(node.cell for node in cycle)]
        reason = f"with the finger off it may go {' → '.join(loop if len(loop) > 1 else loop * 2)} for ever"
        remedy = "move the conditions of these states apart"
        return [ReturnHazard(names[0], f"near {edge_mm:.2f} mm", reason, remedy)]

    # -- time ----------------------------------------------------------------------------------------------

    def return_s(self) -> float:
        """Bound the time until the cap rests at the top in the start state; only where there is no flaw."""
        known: dict[Node, float] = {}
        for start in self.starts:
            stack = [start]
            while stack:
                node = stack[-1]
                moved, entered = self.followers(node)
                missing = [n for n in (*moved, *entered) if n not in known]
                if missing:
                    stack += missing
                    continue
                stack.pop()
                after = [known[n] + self._top_s(n) for n in moved]
                after += [known[n] + self._entry_s(n) for n in entered]
                known[node] = max(after, default=0.0)
        return max(known[n] + self._entry_s(n) for n in self.starts)

    def _top_s(self, node: Node) -> float:
        if node.kind is not HazardKind.TOP:
            return 0.0
        return self.motion.settle_s(node.state) + (self.motion.stay_at_top_s(node.state) or 0.0)

    def _entry_s(self, node: Node) -> float:
        match node.kind:
            case HazardKind.DOWN | HazardKind.UP:
                return self.motion.rise_s(node.state)
            case HazardKind.FADING:
                return self.program.states[node.state].fade_ms / 1000 + self.motion.rise_s(node.state)
            case _:
                return self.motion.longest_stay_s(node.state) or 0.0
