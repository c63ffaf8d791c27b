"""Hold the project to ``budget.toml``, the brake: ``python -m tools.check_budget``.

Prints a line for each limit that is passed, with what to do, and exits with 1. Where there is none, it writes
lower limits for what shrank, or only names them where ``CI`` is set. ``--cpu`` measures also what commands
take. ``--raise`` writes today's figures, up too: commit that file alone, and say what came in and what went
out.
"""

from __future__ import annotations

import argparse
import os
import sys
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from tools.budget_file import Limits, Row, parse_limits, write_limits
from tools.budget_history import NAME, NoHistoryError, refuse_raises
from tools.budget_house import count_house
from tools.budget_measures import count_loaded, count_parts, find_modules, list_files, measure_cpu

ROOT = Path(__file__).resolve().parents[1]

UNITS = {
    "loaded": "modules of ours loaded",
    "cpu": "% of the CPU time of importing numpy",
    "force_text": "modules that import force_text",
}
REMEDIES = {
    "loaded": "import where it is used, or split what is loaded for one name",
    "cpu": "import where it is used, or put off what is computed",
    "force_text": "return the number; a report, a command or a page words it",
    "arrows": "a new arrow between packages; move the shared record down, or pass a callable",
    "records": "two records share most fields; use one of them, or let one hold the other",
    "protocols": "a protocol with fewer than two implementers; name the class itself",
}
COUNTS = {
    "modules": "fold a module into its only importer",
    "public": "a name is public for good; leave it in its module",
    "functions": "name it by a verb, or by the noun it returns",
    "identifiers": "name the thing by what it holds",
}
"""What to do, by the first word of a row of [counts]."""


def measure(root: Path, document: Mapping[str, Any], cpu: bool) -> tuple[dict[Row, int], list[str]]:
    """Return the figure of every row, and a line for each file that no part counts."""
    files, sources = list_files(root), document["sources"]
    sizes, faults = count_parts(root, files, document)
    modules = find_modules(root, files, sources)
    if not modules:
        return sizes, [f"{NAME}: no module below {', '.join(sources)}; mend sources"]
    commands = {name: list(document.get(name, {})) for name in ("loaded", "cpu")}
    figures = {**sizes, **count_house(modules), **count_loaded(root, commands["loaded"], sources)}
    if cpu:
        figures |= measure_cpu(root, commands["cpu"], sources)
    return figures, faults


def explain(row: Row, figure: int, limit: int) -> str:
    """Return the line for a limit that is passed."""
    section, name, part = row
    if section == "parts":
        remedy = (
            f"make room in {name}, or raise the budget in a commit that names what came in and what went out"
        )
        return f"{name}: {figure:,} of {limit:,} {part}; {remedy}"
    if part:
        return f"{name} -> {part}: {REMEDIES[section]}"
    if section == "counts":
        return f"{name}: {figure:,} of {limit:,}; {COUNTS[name.split()[0]]}"
    label = f"fdvv {name}" if section in ("loaded", "cpu") else name
    return f"{label}: {figure:,} of {limit:,} {UNITS[section]}; {REMEDIES[section]}"


def lower(row: Row, limit: int, figure: int) -> int:
    """Return the new limit: a part gives back from 2 % on; CPU time is noisy, so its limits stay."""
    if row.section == "cpu":
        return limit
    if row.section == "parts" and figure > 0.98 * limit:
        return limit
    return min(figure, limit)


def limit_for(row: Row, figure: int) -> int:
    """Return the limit that this figure sets: CPU time has room for noise."""
    return round(1.15 * figure) if row.section == "cpu" else figure


def check(root: Path, cpu: bool = False, write: bool = True, raise_too: bool = False) -> list[str]:
    """Return a line for each fault; where there is none, write the limits of what shrank, or only name them.

    cpu : measure also what commands take. raise_too : write also today's figures that are above their limits.
    """
    path = root / NAME
    text = path.read_text(encoding="utf-8")
    document = tomllib.loads(text)
    limits = parse_limits(document)
    figures, faults = measure(root, document, cpu)
    higher = {row: figure for row, figure in sorted(figures.items()) if figure > limits.get(row, 0)}
    if raise_too:
        limits |= {row: limit_for(row, figure) for row, figure in higher.items()}
    else:
        faults += [explain(row, figure, limits.get(row, 0)) for row, figure in higher.items()]
        faults += _refuse_raises(root)
    lowered = {row: new for row, new in _lower_all(limits, figures) if new < limits[row]}
    if not faults:
        _report(lowered, limits, write)
        if write and (lowered or raise_too):
            path.write_text(write_limits(text, limits | lowered), encoding="utf-8")
    return faults


def _refuse_raises(root: Path) -> list[str]:
    try:
        return refuse_raises(root)
    except NoHistoryError as reason:
        print(f"{NAME}: who raised a limit is not checked: {reason}")
        return []


def _lower_all(limits: Limits, figures: Limits) -> Iterator[tuple[Row, int]]:
    for row, limit in limits.items():
        yield row, lower(row, limit, figures.get(row, 0))


def _report(lowered: Limits, limits: Limits, write: bool) -> None:
    for row, limit in lowered.items():
        remedy = "commit it with what shrank" if write else "run make check and commit it"
        print(f"{NAME}: {row}: {limits[row]:,} becomes {limit:,}; {remedy}")


def main(arguments: Sequence[str] | None = None, root: Path = ROOT) -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cpu", action="store_true", help="measure also what commands take")
    parser.add_argument(
        "--raise", dest="raise_too", action="store_true", help="write today's numbers, up too"
    )
    options = parser.parse_args(arguments)
    faults = check(root, options.cpu, write="CI" not in os.environ, raise_too=options.raise_too)
    print("\n".join(faults), end="\n" if faults else "")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
