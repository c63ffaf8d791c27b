"""Are switches of one make nearest to each other, on one bench and on another?

    python -m benchmarks.library_likeness SHARED_DATA

SHARED_DATA holds a folder for every bench. A make is identified by the file's name. By chance: as if the
others stood in any order.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Sequence
from math import comb
from pathlib import Path

import numpy as np

from fdvv.button.like import LikeTable, distances
from fdvv.errors import FdvvError
from fdvv.units import FloatArray
from fdvv_studio.library.catalog import source_files
from fdvv_studio.library.figures import row_of_file
from fdvv_studio.library.row import ButtonRow

BENCHES = ("tg-tidy", "bluepylons", "haata", "buddyog-topre", "geekboards", "joaoachando")
MAKES = (
    *(
        "Cherry MX Clear( studies| slow|$)",
        "MX.*Blue$",
        "MX.*Brown$",
        "MX.*Black$",
        "Cherry MX Red",
        "Box Navy",
    ),
    *("Diamond Avalon", "Huano Pineapple", "G Pro 3.0", "DareU Mahjong Blue", "Durock Sea Glass"),
    *("Topre.*45g", "BKE", "NiZ", "^tf"),
)
PARTS = {"force": [0], "shape": [1], "landmarks": [2], "all three": [0, 1, 2]}


def rows_of(shared: Path) -> list[ButtonRow]:
    """Read what can be read."""
    found = []
    for file in source_files([shared / bench for bench in BENCHES]):
        try:
            found.append(row_of_file(file.path, file.id, file.collection))
        except FdvvError:
            continue
    return found


def rate(rows: Sequence[ButtonRow], gaps: FloatArray, others: bool, among: int) -> str:
    """Count how often one of a make is among the nearest; others: of other benches only."""
    make = [next((m for m in MAKES if re.search(m, row.name)), None) for row in rows]
    bench = [row.collection.split("/")[0] for row in rows]
    hits, chance = [], []
    for at in range(len(rows)):
        same_bench = [
            i for i in range(len(rows)) if i != at and bench[i] == bench[at] and make[i] == make[at]
        ]
        pool = [i for i in range(len(rows)) if i != at and not (others and bench[i] == bench[at])]
        mates = {i for i in pool if make[i] == make[at]}
        if make[at] is None or not mates or not (others or same_bench):
            continue
        nearest = sorted(pool, key=lambda i: gaps[at, i])[:among]
        hits.append(bool(mates & set(nearest)))
        chance.append(1 - comb(len(pool) - len(mates), among) / comb(len(pool), among))
    return f"{100 * np.mean(hits):3.0f} % of {len(hits)} (by chance {100 * np.mean(chance):.0f} %)"


def main() -> None:
    """Print the rates."""
    if len(sys.argv) != 2:
        raise SystemExit("usage: python -m benchmarks.library_likeness SHARED_DATA")
    rows = rows_of(Path(sys.argv[1]))
    table = LikeTable()
    table.extend(rows)
    parts = np.array([table.parts(at) for at in range(len(rows))])
    print(f"{len(rows)} measured files")
    for name, which in PARTS.items():
        gaps = np.array([distances(one[:, which]) for one in parts])
        print(
            f"{name:10s} one bench {rate(rows, gaps, False, 1)}; other benches {rate(rows, gaps, True, 1)}; "
            f"among the nearest three {rate(rows, gaps, True, 3)}"
        )


if __name__ == "__main__":
    main()
