"""What the brake measures: the files and lines of every part, and what six commands load and take."""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from fnmatch import fnmatch
from pathlib import Path
from typing import Any

from tools.budget_file import Row

COUNTED = (".py", ".c", ".h", ".ts", ".svelte", ".css", ".md")
TRIES = 5

COUNT_MODULES = """
import runpy, sys
try:
    runpy.run_module("fdvv", run_name="__main__", alter_sys=True)
except SystemExit as end:
    if end.code:
        raise
print(sum(name.partition(".")[0].startswith("fdvv") for name in sys.modules))
"""


def list_files(root: Path) -> list[str]:
    """Return the files that are kept, or would be at the next ``git add``; without git, all not ignored."""
    try:
        if not (root / ".git").exists():
            raise FileNotFoundError
        listed = subprocess.run(
            ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
            cwd=root,
            capture_output=True,
            text=True,
            encoding="utf-8",
            check=True,
        ).stdout.split("\0")
    except (OSError, subprocess.CalledProcessError):
        listed = list(walk_files(root))
    return sorted({name for name in listed if name.endswith(COUNTED) and (root / name).is_file()})


def walk_files(root: Path) -> Iterator[str]:
    """Yield the files that no ``.gitignore`` names; exceptions with ``!`` are not read."""
    rules: list[tuple[str, str]] = []
    for folder, folders, names in os.walk(root):
        here = Path(folder).relative_to(root).as_posix().removeprefix(".")
        prefix = here and f"{here}/"
        if ".gitignore" in names:
            text = (Path(folder) / ".gitignore").read_text(encoding="utf-8")
            rules += [(prefix, rule.strip("/")) for rule in text.split() if not rule.startswith("#")]
        folders[:] = [name for name in folders if name != ".git" and not _is_ignored(prefix + name, rules)]
        yield from (prefix + name for name in names if not _is_ignored(prefix + name, rules))


def _is_ignored(path: str, rules: Iterable[tuple[str, str]]) -> bool:
    name = path.rpartition("/")[2]
    return any(
        fnmatch(path.removeprefix(prefix) if "/" in rule else name, rule)
        for prefix, rule in rules
        if path.startswith(prefix)
    )


def to_pattern(paths: Sequence[str]) -> re.Pattern[str]:
    """Return what matches any of these paths: ``*`` within a folder, ``**/`` any folders."""
    escaped = "|".join(map(re.escape, paths))
    return re.compile(escaped.replace(r"\*\*/", "(?:.+/)?").replace(r"\*", "[^/]*"))


def count_parts(
    root: Path, files: Iterable[str], document: Mapping[str, Any]
) -> tuple[dict[Row, int], list[str]]:
    """Return the lines and files of every part, and a line for each file that is not in exactly one of them.

    Generated files are in none.
    """
    parts = {name: to_pattern(part["paths"]) for name, part in document["parts"].items()}
    made = {
        Row("generated", maker, path): to_pattern([path])
        for maker, paths in document.get("generated", {}).items()
        for path in paths
    }
    counts: Counter[Row] = Counter()
    faults = []
    for file in files:
        if makers := [row for row, pattern in made.items() if pattern.fullmatch(file)]:
            counts |= Counter(makers)  # however many files there are
            continue
        homes = [name for name, pattern in parts.items() if pattern.fullmatch(file)]
        if len(homes) != 1:
            faults.append(_explain_homes(file, homes))
            continue
        counts[Row("parts", homes[0], "lines")] += (root / file).read_bytes().count(b"\n")
        counts[Row("parts", homes[0], "files")] += 1
    return dict(counts), faults


def _explain_homes(file: str, homes: Sequence[str]) -> str:
    if homes:
        return f"{file}: counted by {' and '.join(homes)}; let the paths of one of them leave it out"
    return f"{file}: in no row of [parts]; move it into a part, or add a row in a commit of budget.toml alone"


def find_modules(root: Path, files: Iterable[str], sources: Sequence[str]) -> dict[str, Path]:
    """Return the Python files below these folders by the dotted names of their modules."""
    pattern = re.compile(f"(?:{to_pattern(sources).pattern})/(?P<module>.+?)(?:/__init__)?\\.py")
    matches = [match for file in files if (match := pattern.fullmatch(file))]
    return {match["module"].replace("/", "."): root / match[0] for match in matches}


def count_loaded(root: Path, commands: Sequence[str], sources: Sequence[str]) -> dict[Row, int]:
    """Return how many modules of ours each command loads."""

    def count(command: str) -> int:
        return int(_run(root, sources, "-c", COUNT_MODULES, *shlex.split(command)).splitlines()[-1])

    with ThreadPoolExecutor(2) as pool:
        return {Row("loaded", name): n for name, n in zip(commands, pool.map(count, commands), strict=True)}


def measure_cpu(root: Path, commands: Sequence[str], sources: Sequence[str]) -> dict[Row, int]:
    """Return the CPU time of each command in percent of that of ``import numpy``, the least of five tries."""
    runs = {name: ("-m", "fdvv", *shlex.split(name)) for name in commands}
    taken_s: defaultdict[str, list[float]] = defaultdict(list)
    for _ in range(TRIES):
        for name, arguments in {"": ("-c", "import numpy"), **runs}.items():
            before = os.times()
            _run(root, sources, *arguments)
            after = os.times()
            taken_s[name].append(sum(after[2:4]) - sum(before[2:4]))
    numpy_s = min(taken_s[""])
    return {Row("cpu", name): round(100 * min(taken_s[name]) / numpy_s) for name in commands}


def _run(root: Path, sources: Sequence[str], *arguments: str) -> str:
    """Run Python in the checkout, with its sources first; return what it prints."""
    folders = [str(path) for source in sources for path in sorted(root.glob(source))]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(folders)}
    done = subprocess.run(
        [sys.executable, *arguments], cwd=root, env=environment, capture_output=True, text=True, check=False
    )
    if done.returncode:
        raise SystemExit(f"budget.toml: fdvv {shlex.join(arguments[2:])} fails: {done.stderr.strip()}")
    return done.stdout
