"""Which real curves can be made as a spring, a leaf or a dome? Simulated; some minutes.

Run as ``python -m benchmarks.mechanism [FOLDER]``; FOLDER holds the real measurements (bluepylons,
buddyog-topre, haata). Every shipped button and every measured one with press and release is designed by all
kinds; the chosen one is pressed slowly by the twin, a leaf as it is built. A line tells what each kind misses
(rms of the worse stroke, cN) and the first reason of the chosen one.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fdvv.button.open import button_files, open_button
from fdvv.errors import FdvvError
from fdvv.model.file import builtin_names, load_builtin
from fdvv.model.model import FDVVModel
from fdvv_switch.design_button import MechanismResult, design_mechanism
from fdvv_switch.residual import WANTED_cN

FOLDERS = ("bluepylons", "buddyog-topre", "haata")
NAME, REASON = 34, 90


@dataclass(frozen=True, eq=False)
class Line:
    """One button: what became of it."""

    name: str
    result: MechanismResult | None
    refused: str = ""

    @property
    def twin_cN(self) -> float:
        """Get what the twin, pressed slowly, misses on the worse stroke; infinite where it cannot."""
        if self.result is None or not self.result.pressed:
            return float("inf")
        slow = self.result.pressed[0]
        return max(slow.press.rms_cN, slow.release.rms_cN)


def shipped() -> Iterator[tuple[str, FDVVModel]]:
    """Return the shipped buttons."""
    for name in builtin_names():
        yield name, load_builtin(name)


def measured(folder: Path) -> Iterator[tuple[str, FDVVModel | str]]:
    """Return every button measured in a folder, or the reason why it cannot be read."""
    for part in FOLDERS:
        for file in button_files(folder / part):
            name = f"{part[:5]} {file.parent.name[:10] if file.parent.name != part else ''} {file.stem}"
            try:
                yield name, open_button(str(file))
            except FdvvError as error:
                yield name, str(error).partition(": ")[2]


def judged(name: str, model: FDVVModel | str) -> Line:
    """Design and press one button."""
    if isinstance(model, str):
        return Line(name, None, model)
    try:
        return Line(name, design_mechanism(model, speeds_mm_s=()))
    except FdvvError as error:
        return Line(name, None, str(error))


def describe(line: Line) -> str:
    """Write one line of the table."""
    name = line.name[:NAME].ljust(NAME)
    if line.result is None:
        return f"{name}  not designed: {line.refused[:REASON]}"
    worst = {k.kind: k.residual.worst_cN if k.residual else None for k in line.result.kinds}
    missed = "  ".join("   –" if v is None else f"{v:4.1f}" for v in worst.values())
    reason = line.result.twin_refused or next(iter(line.result.residual.reasons), "")
    twin = f"{line.twin_cN:4.1f}" if np.isfinite(line.twin_cN) else "   –"
    return f"{name}  {missed}  {line.result.mechanism.kind:6}  {twin}  {reason[:REASON]}"


def summary(title: str, lines: list[Line]) -> str:
    """Write share, median and worst of the buttons that could be designed."""
    made = [line for line in lines if line.result]
    if not made:
        return f"{title}: none"
    missed = np.array([line.twin_cN for line in made])
    met = int(np.sum([line.result.met for line in made if line.result]))
    worst = made[int(np.argmax(missed))]
    return (
        f"{title}: {met} of {len(made)} within {WANTED_cN:g} cN on both strokes, median "
        f"{np.median(missed):.1f}, worst {missed.max():.1f} ({worst.name}); "
        f"{len(lines) - len(made)} not designed"
    )


def main(arguments: list[str]) -> None:
    """Print the table as it is made, then the sums."""
    print(
        f"{'worse stroke, rms cN':{NAME}}  {'spring leaf  dome':16}  chosen  twin  why not better (simulated)"
    )
    groups = {"shipped": list(_printed(shipped()))}
    if arguments:
        groups["measured"] = list(_printed(measured(Path(arguments[0]))))
    for title, lines in groups.items():
        print(summary(title, lines))


def _printed(
    models: Iterator[tuple[str, FDVVModel]] | Iterator[tuple[str, FDVVModel | str]],
) -> Iterator[Line]:
    for name, model in models:
        line = judged(name, model)
        print(describe(line), flush=True)
        yield line


if __name__ == "__main__":
    main(sys.argv[1:])
