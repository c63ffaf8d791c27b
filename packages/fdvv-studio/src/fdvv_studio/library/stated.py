"""What maker or measurer state a button to be: in a table beside its file, in its name, or by its make."""

from __future__ import annotations

import csv
import re
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

TYPES = ("linear", "tactile", "clicky", "dome")
WORDS = {"click": "clicky", "topre": "dome", **{word: word for word in TYPES}}

TABLES = ("types.csv", "switchmeta.csv")
"""Files with lines name,type; looked for in a file's folder and in the one above."""
LARGEST_bytes = 1_000_000  # that of tg-strokes (switchmeta.csv) has 29 kB; what is beyond is not read

MAKES = {
    "clicky": (
        r"(cherry )?mx2?a? (hyperglide |rgb )?(blue|green|white)( rgb)?",
        r"(novelkeys |nk )?(kailh|kaihua|kalih|novelkeys) box (v2 )?(white|jade|navy|pale blue|pink)",
        r"(kailh|kaihua) (speed )?(bronze|gold)",
        r"(kailh|kaihua) choc (white|navy|jade)",
        r"(gateron|outemu|greetech|kaihua|kailh) (blue|green)",
        r"alps skcm (blue|white|amber)",
        r".*buckling spring.*",
    ),
    "tactile": (
        r"(cherry )?mx2?a? (hyperglide |rgb )?(brown|clear|tactile grey|ergo clear)( rgb)?",
        r"(kailh|kaihua|kalih) box brown",
        r"(kailh|kaihua) (choc brown|(speed )?copper|pro purple)",
        r"(gateron|outemu|greetech|kaihua|kailh) brown",
        r"(aflion |top clack )?holy panda",
    ),
    "linear": (
        r"(cherry )?mx2?a? (hyperglide |rgb |silent |speed )?(black|red|silver|linear grey)( rgb)?",
        r"(kailh|kaihua|kalih) box (red|black)",
        r"(kailh|kaihua) (choc red|(speed )?silver)",
        r"(gateron|outemu|greetech|kaihua|kailh) (red|black|yellow)",
        r"alps skcl (green|yellow)",
    ),
    "dome": (r"(niz|bke|deskeys|sony bke|dynacaps|klc densus|astro domes)\b.*",),
}
"""Makes whose makers state the type in their data sheets, by the whole name."""


class Stated(NamedTuple):
    """A type that is stated, and where."""

    type: str
    by: str

    def __str__(self) -> str:
        return f"{self.type} by {self.by}"


def find_type(name: str, folder: str = "", path: Path | None = None) -> Stated | None:
    """Find what is stated of a button: by a table, by the words of name and folder, or by its make.

    folder : the names of the folders it lies in. path : of its file, beside which a table may lie.
    """
    stated = _by_table(name, path) if path else None
    if stated:
        return stated
    words = re.findall(rf"\b({'|'.join(WORDS)})\b", _plain(f"{name} {folder}"))
    types = {WORDS[word] for word in words}
    if len(types) == 1:
        return Stated(types.pop(), "its name")
    plain = re.sub(r"\s*(\d+|\(\d+\))$", "", _plain(name))
    makes = (kind for kind, patterns in MAKES.items() if any(re.fullmatch(p, plain) for p in patterns))
    make = next(makes, None)
    return Stated(make, "its maker") if make and not types else None


def _plain(text: str) -> str:
    return " ".join(re.sub(r"[_\-,]", " ", text).lower().split())


def _by_table(name: str, path: Path) -> Stated | None:
    names = (name, path.stem, path.stem.split("__")[0], path.parent.name)
    for table in (folder / file for folder in path.parents[:2] for file in TABLES):
        try:
            known = _table(table, table.stat().st_mtime_ns)
        except OSError:
            continue
        kind = next((known[key] for key in map(_plain, names) if key in known), None)
        if kind:
            return Stated(kind, table.name)
    return None


@lru_cache(maxsize=8)
def _table(path: Path, _changed: int) -> dict[str, str]:
    """Read a table of types; lines of other words are passed over."""
    with path.open("rb") as stream:
        text = stream.read(LARGEST_bytes).decode("utf-8-sig", errors="replace")
    lines = [line for line in csv.reader(text.splitlines()) if len(line) >= 2]
    kinds = ((_plain(line[0]), WORDS.get(line[1].strip().lower())) for line in lines)
    return {name: kind for name, kind in kinds if kind}
