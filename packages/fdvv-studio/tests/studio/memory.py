"""Questions drawn from what a studio has answered: names that exist, current numbers, texts that it made."""

from __future__ import annotations

import random
from collections import defaultdict
from typing import Any

import msgspec
from msgspec import inspect

from tests.studio.values import typed_value

KEPT, LATEST = 40, 8
"""Values remembered per name, and records that a question is likely to be about."""

ALSO = {
    "button": ("id",),
    "button_id": ("id", "button"),
    "ids": ("id",),
    "like": ("id",),
    "base": ("id", "button"),
    "program": ("id",),
    "device": ("devices.name",),
    "engine": ("engines.name", "pair_engines.name", "line_engines.name"),
    "space": ("spaces.name",),
    "template": ("templates.name",),
    "person": ("people.person",),
    "rig": ("rigs.name", "rig_id"),
    "trial": ("trials.number", "pairs.number", "lines.number", "number"),
    "velocities_mm_s": ("velocity_mm_s",),
}
"""Names under which the values of a field are answered, besides its own."""

OWN = {
    "name": ("a", "b", "ä", "one two"),
    "title": ("t",),
    "passphrase": ("correct horse battery staple",),
    "who": ("somebody",),
    "why": ("it is over",),
    "velocity_mm_s": (20.0, 50.0, 200.0),
    "velocities_mm_s": (50.0, 100.0),
    "template": ("realism", "preference", "tactile", "linear"),
    "device": ("twin", "host"),
    "rig": ("recommended", "light", "paper"),
    "recipe": ("rapid-trigger", "multi-level", "button"),
    "budget": (3,),
    "trials": (1, 2),
    "task_presses": (2, 3),
    "person": ("P01", 0),
    "rounds": (0, 1),
    "presses": (1,),
    "seed": (0, 1),
    "limit": (5,),
    "sort": ("name", "peak_cN"),
    "parameters": ({}, {"depth_mm": 0.3}),
    "text": ('{"t_s": [0, 0.01, 0.02], "displacement_mm": [0, 1, 2]}',),
    "keep": (True, False),
    "job": ("0001", "0002"),
    "also": (),
    "run": (1, 2),
    "trial": (0, 1),
    "pair": (0, 1),
    "line": (0, 1),
    "best": (0, 8),
    "revision": (0, 1),
    "start": ("builtin:mx-clear", "builtin:mx-red"),
    "base": ("builtin:mx-clear", "own:my button"),
    "engine": ("random", "sobol", "preference", "preference-line"),
    "space": ("FDV", "FDVV"),
    "rig_id": ("shipped:recommended", "shipped:paper"),
    "asking": ("compare",),
    "actuation": ("",),
    "known": ("",),
    "others": (),
    "pace_ratio": (0.35,),
    "number": (1,),
    "answer": ("first", "second"),
    "fault": (1, 9),
    "levels": (2,),
}
"""Values that a page would send, where none was answered yet."""


class Memory:
    """What was answered so far, by the names of its fields."""

    def __init__(self, draw: random.Random) -> None:
        self._draw = draw
        self._values: dict[str, list[Any]] = defaultdict(list)
        self._records: list[dict[str, Any]] = []
        self._record: dict[str, Any] = {}

    def learn(self, answer: Any, name: str = "", within: str = "") -> None:
        """Remember every value of an answer under its name, and under that of the list it is in."""
        if isinstance(answer, dict):
            # what belongs together, such as a program and its revision
            self._records = [*self._records, answer][-KEPT:]
            for key, value in answer.items():
                self.learn(value, key, name)
        if isinstance(answer, list):
            for item in answer[:KEPT]:
                self.learn(item, name, within)
        if name and not isinstance(answer, list) and answer is not None:
            for known in {name, f"{within}.{name}"}:
                values = [one for one in self._values[known] if one != answer]
                self._values[known] = [*values, answer][-KEPT:]

    def question(self, ask: type[msgspec.Struct], nonsense: float) -> Any:
        """Return a question; each field is nonsense with this probability."""
        together = self._records and self._draw.random() < 0.5
        self._record = self._draw.choice(self._records[-LATEST:]) if together else {}
        return self._struct(inspect.type_info(ask), nonsense, 0)

    def _struct(self, kind: Any, nonsense: float, depth: int) -> dict[str, Any]:
        fields = [f for f in kind.fields if f.required or self._draw.random() < 0.4]
        tag = {kind.tag_field: kind.tag} if kind.tag_field else {}
        return {**tag, **{f.encode_name: self._field(f.encode_name, f.type, nonsense, depth) for f in fields}}

    def _field(self, name: str, kind: inspect.Type, nonsense: float, depth: int) -> Any:
        if self._draw.random() < nonsense:
            return typed_value(kind, self._draw)
        while isinstance(kind, inspect.Metadata):
            kind = kind.type
        if isinstance(kind, inspect.UnionType):
            kind = self._draw.choice(kind.types)
        if isinstance(kind, inspect.NoneType):
            return None
        if isinstance(kind, inspect.StructType) and depth < 6:
            return self._struct(kind, nonsense, depth + 1)
        if isinstance(kind, inspect.ListType | inspect.VarTupleType):
            return [
                self._field(name, kind.item_type, nonsense, depth + 1)
                for _ in range(self._draw.randint(1, 2))
            ]
        if name in self._record and _fits(self._record[name], kind):
            return self._record[name]
        known = self._known(name, kind)
        return self._draw.choice(known) if known else typed_value(kind, self._draw, 3)

    def _known(self, name: str, kind: inspect.Type) -> list[Any]:
        """Return what a page would send, or what was answered; empty if there is neither."""
        own = [value for value in OWN.get(name, ()) if _fits(value, kind)]
        answered = [value for key in (name, *ALSO.get(name, ())) for value in self._values[key]]
        answered = [value for value in answered if _fits(value, kind)]
        return own if own and (not answered or self._draw.random() < 0.5) else answered


PLAIN: dict[type[inspect.Type], tuple[type, ...]] = {
    inspect.StrType: (str,),
    inspect.IntType: (int,),
    inspect.FloatType: (int, float),
    inspect.DictType: (dict,),
    inspect.RawType: (dict,),
}


def _fits(value: Any, kind: inspect.Type) -> bool:
    if isinstance(value, bool) or not isinstance(value, PLAIN.get(type(kind), ())):
        return False
    most = getattr(kind, "max_length", None)
    return not isinstance(value, str) or most is None or len(value) <= most
