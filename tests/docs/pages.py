"""The pages that people read, and how what they show is run."""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from tools.markdown import Block, blocks

REPOSITORY = Path(__file__).resolve().parents[2]
DOCS = REPOSITORY / "docs"
API = DOCS / "reference" / "api"
PAGES = [*sorted(REPOSITORY.glob("*.md")), *sorted(DOCS.rglob("*.md"))]
NOT_OURS = ("make", ".", "pip", "python")
"""What sets things up has runs of its own."""
NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?")
MILLISECONDS = re.compile(r"\s+\d+\.\d$")
LEARNED = ("compensate", "probe", "feasible")
"""Figures of learning follow from rounding: held to LEARNED_ratio, not to the digit."""
LEARNED_ratio, LEARNED_absolute = 0.35, 2.5


@dataclass(frozen=True)
class Step:
    """A command as a page shows it, with the lines that are shown for it."""

    command: tuple[str, ...]
    shown: tuple[str, ...]


def name_of(page: Path) -> str:
    """Give a page's path as people would write it."""
    return str(page.relative_to(REPOSITORY))


def blocks_of(page: Path) -> list[Block]:
    """Give the blocks of a page."""
    return blocks(page.read_text(encoding="utf-8"))


def steps(text: str) -> list[Step]:
    """Split a console block into commands, each with the lines shown for it; a backslash joins lines."""
    found: list[tuple[list[str], list[str]]] = []
    for line in text.replace("\\\n", "").splitlines():
        if line.startswith("$ "):
            found.append((shlex.split(line[2:], comments=True), []))
        else:
            found[-1][1].append(line)
    return [Step(tuple(command), tuple(shown)) for command, shown in found]


def run(command: list[str], folder: Path, environment: Mapping[str, str]) -> subprocess.CompletedProcess[str]:
    """Run a command as a reader would, in a folder."""
    return subprocess.run(
        command, cwd=folder, env=environment, capture_output=True, text=True, encoding="utf-8", check=False
    )


def follow(page: Path, folder: Path, environment: Mapping[str, str]) -> None:
    """Run everything that a page shows, in its order, in one folder, and hold it against what is shown."""
    (folder / "src").symlink_to(REPOSITORY / "src")
    printed = ""
    for block in blocks_of(page):
        where = f"{name_of(page)}:{block.line}"
        if block.language == "python":
            ran = run([sys.executable, "-W", "error", "-c", block.text], folder, environment)
            assert (ran.returncode, ran.stderr) == (0, ""), f"{where}: the program fails: {ran.stderr}"
            printed = ran.stdout
        elif block.language == "console":
            for step in steps(block.text):
                check(step, where, folder, environment)
        elif block.name:
            (folder / block.name).write_text(block.text, encoding="utf-8")
        elif block.language == "" and printed:
            assert block.text == printed, f"{where}: the program above prints {printed!r}"
            printed = ""


def check(step: Step, where: str, folder: Path, environment: Mapping[str, str]) -> None:
    """Run one command; every line that is shown must be printed, figures of learning nearly so."""
    if step.command[0] in NOT_OURS:
        return
    told = f"{where}: {shlex.join(step.command)}"
    assert step.command[0] == "fdvv", (
        f"{told}: is no command of this package; use a block of another language"
    )
    ran = run([sys.executable, "-m", *step.command], folder, environment)
    expected = 2 if step.shown and step.shown[0].startswith("fdvv: ") else 0
    assert ran.returncode == expected, f"{told}: ended with {ran.returncode}: {ran.stderr}"
    printed = [plain(line) for line in (ran.stdout + ran.stderr).splitlines()]
    for line in step.shown:
        same = any(alike(plain(line), other, step.command[1] in LEARNED) for other in printed)
        assert same, f"{told}: does not print {line!r} but\n{ran.stdout}{ran.stderr}"


def plain(line: str) -> str:
    """Drop milliseconds, and the column widths that they set."""
    return " ".join(MILLISECONDS.sub("", line).split())


def alike(shown: str, printed: str, learned: bool) -> bool:
    """Tell whether two lines say the same; numbers of learning may differ a little."""
    if shown == printed or not learned:
        return shown == printed
    if NUMBER.sub("#", shown) != NUMBER.sub("#", printed):
        return False
    pairs = zip(NUMBER.findall(shown), NUMBER.findall(printed), strict=True)
    return all(_near(float(one), float(other)) for one, other in pairs)


def _near(one: float, other: float) -> bool:
    return abs(one - other) <= max(LEARNED_absolute, LEARNED_ratio * abs(one))
