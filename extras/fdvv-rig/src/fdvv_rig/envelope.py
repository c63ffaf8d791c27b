"""The room that a bought part takes: cylinders and blocks, drawn where they stand at travel 0."""

from __future__ import annotations

from dataclasses import dataclass

from fdvv_rig.placement import Moves, Row


@dataclass(frozen=True)
class Rod:
    """A cylinder from a point along an axis ("x", "y" or "z"), with a bore where it is not 0."""

    axis: str
    begin_mm: Row
    length_mm: float
    diameter_mm: float
    bore_mm: float = 0.0


@dataclass(frozen=True)
class Block:
    """A block between two corners."""

    low_mm: Row
    high_mm: Row


@dataclass(frozen=True)
class Envelope:
    """A bought part as the room it takes.

    Attributes
    ----------
    name, title : of the part; count : how many the envelope stands for; moves : what it moves with.
    solids : the room; hollows : what is open in it.
    holds : names of parts that it is fastened to or bears on: it may touch them.
    enters : names of parts that its thread cuts or that are drawn full where it goes: it may share room.
    """

    name: str
    title: str
    moves: Moves
    solids: tuple[Rod | Block, ...]
    hollows: tuple[Rod | Block, ...] = ()
    holds: frozenset[str] = frozenset()
    enters: frozenset[str] = frozenset()
    count: int = 1
