"""Write what the boards are built for: firmware/boards/*/limits.h.

    python -m tools.make_board_limits                          # the shipped boards and rigs
    python -m tools.make_board_limits itsybitsy_m0=my.rig.toml # a board for another rig

`make firmware` then compiles the limits in. The diff shows where a limit has become looser.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass, fields, replace
from pathlib import Path

from fdvv.protocol.tables import BoardLimits
from fdvv.twin.files import load_rig
from fdvv.twin.settings import limits_of

ROOT = Path(__file__).resolve().parents[1]
BOARDS = ROOT / "firmware" / "boards"
RIGS = ROOT / "packages/fdvv/src/fdvv/twin/rigs"


@dataclass(frozen=True)
class Board:
    """A board, the rig it is shipped for, and the shortest tick that its processor has time for.

    The longest is what its timer of 16 bits counts at 48 MHz.
    """

    rig: Path
    tick_low_us: int
    tick_high_us: int = 1000


SHIPPED = {
    "itsybitsy_m0": Board(RIGS / "voltage.toml", 250),
    "itsybitsy_m4": Board(RIGS / "recommended.toml", 100),
}


def header(name: str, rig: Path) -> str:
    """Return limits.h of a board built for a rig; ModelError as for limits_of."""
    board = SHIPPED[name]
    limits = limits_of(load_rig(rig))
    limits = replace(limits, tick_low_us=board.tick_low_us, tick_high_us=board.tick_high_us)
    lines = [
        f"/* Made by tools/make_board_limits.py from {rig.name}; do not edit.",
        " * No setting is looser than these. */",
        f"#ifndef {name.upper()}_LIMITS_H",
        f"#define {name.upper()}_LIMITS_H",
        "",
        "#define BOARD_LIMITS \\",
        "    { \\",
    ]
    lines += [f"        {getattr(limits, f.name)}, /* {f.name} */ \\" for f in fields(BoardLimits)]
    return "\n".join([*lines, "    }", "", "#endif", ""])


def write(chosen: dict[str, Path]) -> list[Path]:
    """Write the headers of these boards; return their paths."""
    written = []
    for name, rig in chosen.items():
        written.append(BOARDS / name / "limits.h")
        written[-1].write_text(header(name, rig), encoding="utf-8", newline="\n")
    return written


if __name__ == "__main__":
    asked = dict(argument.split("=", 1) for argument in sys.argv[1:])
    for path in write({n: Path(r) for n, r in asked.items()} or {n: b.rig for n, b in SHIPPED.items()}):
        sys.stdout.write(f"{path.relative_to(ROOT)}\n")
