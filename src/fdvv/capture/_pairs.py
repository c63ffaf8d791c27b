"""Strokes kept in two files, NAME.downstroke.csv and NAME.upstroke.csv: either finds the other."""

from __future__ import annotations

from pathlib import Path

from fdvv.model import Stroke

ENDINGS = (
    (".downstroke", ".upstroke"),
    ("_downstroke", "_upstroke"),
    ("_press", "_release"),
    (".press", ".release"),
)


def stroke_of(path: Path) -> tuple[Stroke, Path] | None:
    """Tell which stroke a file's name says it is, and where the other one would be; None if it says none."""
    for press, release in ENDINGS:
        for mine, other, stroke in ((press, release, Stroke.PRESS), (release, press, Stroke.RELEASE)):
            if path.stem.lower().endswith(mine):
                return stroke, path.with_name(f"{path.stem[: -len(mine)]}{other}{path.suffix}")
    return None


def companion(path: Path) -> Path | None:
    """Give where the other stroke of a pair would lie; None if the name says no stroke."""
    named = stroke_of(path)
    return None if named is None else named[1]


def base_name(path: Path) -> str:
    """Give the name that both halves share."""
    stem = path.stem
    found = (ending for pair in ENDINGS for ending in pair if stem.lower().endswith(ending))
    ending = next(found, "")
    return stem[: len(stem) - len(ending)] or stem
