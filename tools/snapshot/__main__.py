"""Keep as text what the commands print and write, so that a change that should change nothing can be seen to.

``python -m tools.snapshot`` runs the cases of cases.toml and compares with tests/files/snapshot: it prints
what differs, with exit status 1. ``--write`` writes the texts anew; ``git diff`` then shows what changed.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator

from tools.snapshot.commands import Commands
from tools.snapshot.reference import Reference, Snapshot, snapshots, write

OTHER_MACHINE = (
    "this machine rounds otherwise than the one that wrote tests/files/snapshot, or has other libraries: "
    "--write without names writes everything anew"
)


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help="what to take; everything by default")
    parser.add_argument("--write", action="store_true", help="write the texts anew")
    options = parser.parse_args()
    known = {snapshot.name: snapshot for snapshot in snapshots()}
    if unknown := sorted(set(options.names) - set(known)):
        parser.error(f"no snapshot {', '.join(unknown)}; there are {', '.join(known)}")
    reference = Reference()
    if options.write and options.names and (reference.other_libraries or not reference.exact):
        parser.error(OTHER_MACHINE)
    if reference.other_libraries:
        print(f"they were taken with {reference.other_libraries}", file=sys.stderr)
    texts = dict(take([known[name] for name in options.names or known]))
    if options.write:
        write(texts, whole=not options.names)
        return 0
    return report({name: reference.differs(name, text) for name, text in texts.items()})


def take(wanted: list[Snapshot]) -> Iterator[tuple[str, str]]:
    """Yield the name and the text of each snapshot that is possible here."""
    with Commands() as commands:
        for snapshot in wanted:
            if snapshot.possible:
                before_s = commands.cpu_s
                yield snapshot.name, snapshot.take(commands)
                print(f"{snapshot.name}: {commands.cpu_s - before_s:.1f} s of CPU", file=sys.stderr)
            else:
                print(f"{snapshot.name}: skipped, the real measurements are not here", file=sys.stderr)


def report(differences: dict[str, str]) -> int:
    """Print what differs; return the exit status."""
    differing = {name: lines for name, lines in differences.items() if lines}
    for name, lines in differing.items():
        print(f"{name}:\n{lines}\n")
    print(f"{len(differing)} of {len(differences)} differ" + f": {', '.join(differing)}" * bool(differing))
    return 1 if differing else 0


if __name__ == "__main__":
    sys.exit(main())
