"""The snapshots that are kept in tests/files/snapshot, and how a new one differs from them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial

from tools.snapshot import contract
from tools.snapshot.cases import DATA, read_cases, run_case
from tools.snapshot.commands import ROOT, Commands
from tools.snapshot.compare import difference
from tools.snapshot.machine import arithmetic, libraries
from tools.snapshot.values import shorten_repeats

FOLDER = ROOT / "tests" / "files" / "snapshot"
MACHINE = FOLDER / "machine.txt"


@dataclass(frozen=True)
class Snapshot:
    """What is taken. slow : not in the default tests. possible : whether what it needs is on this machine."""

    name: str
    take: Callable[[Commands], str]
    slow: bool = False
    possible: bool = True


def snapshots() -> list[Snapshot]:
    """Return everything that is taken."""
    return [
        Snapshot("facade", lambda _: contract.facade()),
        Snapshot("files", lambda _: contract.files()),
        Snapshot("help", contract.helps),
        Snapshot("wire", lambda _: "\n".join(shorten_repeats(contract.wire().splitlines()))),
        *(
            Snapshot(case.name, partial(run_case, case), case.slow, not case.data or DATA.is_dir())
            for case in read_cases()
        ),
    ]


class Reference:
    """The texts that are kept, and the machine on which they were taken."""

    @cached_property
    def _machine(self) -> list[str]:
        return MACHINE.read_text().splitlines() if MACHINE.exists() else ["", ""]

    @cached_property
    def exact(self) -> bool:
        """Whether this machine rounds as the one that took them."""
        return self._machine[0] == arithmetic()

    @cached_property
    def other_libraries(self) -> str:
        """The libraries that took them, where they are not those of today."""
        return "" if self._machine[1] == libraries() else self._machine[1]

    def differs(self, name: str, text: str) -> str:
        """Return what differs from the text that is kept, as a unified diff; empty where nothing does."""
        path = FOLDER / f"{name}.txt"
        return difference(path.read_text() if path.exists() else "", text, self.exact)


def write(texts: dict[str, str], whole: bool) -> None:
    """Keep texts in place of the former ones. whole : they are all there are."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    for path in FOLDER.glob("*.txt") if whole else ():
        if path.stem not in texts and path != MACHINE:
            path.unlink()
    for name, text in texts.items():
        (FOLDER / f"{name}.txt").write_text(text.rstrip() + "\n")
    MACHINE.write_text(f"{arithmetic()}\n{libraries()}\n")
