"""Run the commands and programs that a page shows, and compare what they print with the page."""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from tools.markdown import SPAN, Block, blocks

REPOSITORY = Path(__file__).resolve().parents[2]
DOCS = REPOSITORY / "docs"
PAGES = [*sorted(REPOSITORY.glob("*.md")), *sorted(DOCS.rglob("*.md"))]
SETUP = ("make", ".", "pip", "python")
"""Commands that install something; tests/package runs them."""
NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?")
MILLISECONDS = re.compile(r"\s+\d+\.\d$")
LEARNED = ("compensate", "probe", "feasible")
"""Commands whose figures depend on rounding; they are compared within the tolerances below."""
LEARNED_ratio, LEARNED_absolute = 0.35, 2.5
EXAMPLE_lines = 150
"""Of a task or a method of one's own, most."""


@dataclass(frozen=True)
class Step:
    """A command and the output that the page shows for it."""

    command: tuple[str, ...]
    shown: tuple[str, ...]


def name_of(page: Path) -> str:
    """Return a page's path relative to the repository."""
    return str(page.relative_to(REPOSITORY))


def blocks_of(page: Path) -> list[Block]:
    """Return the fenced blocks of a page."""
    return blocks(page.read_text(encoding="utf-8"))


def steps(text: str) -> list[Step]:
    """Split a console block into commands with their output; a backslash joins lines."""
    found: list[tuple[list[str], list[str]]] = []
    for line in text.replace("\\\n", "").splitlines():
        if line.startswith("$ "):
            found.append((shlex.split(line[2:], comments=True), []))
        else:
            found[-1][1].append(line)
    return [Step(tuple(command), tuple(shown)) for command, shown in found]


def commands_on(text: str) -> Iterator[str]:
    """Yield every fdvv command on a page, in blocks and in lines of text."""
    for block in blocks(text):
        for line in block.text.replace("\\\n", "").splitlines():
            if found := re.match(r"(?:\$ )?(fdvv [a-z].*)", line):
                yield found[1]
    for span in SPAN.finditer(re.sub(r"(?ms)^```.*?^```$", "", text)):
        words = " ".join(span[0].strip("`").split())
        if re.match(r"fdvv [a-z]+( |$)", words):
            yield words


def follow(
    page: Path, folder: Path, environment: Mapping[str, str], shorter: Mapping[str, tuple[str, ...]]
) -> None:
    """Run everything that a page shows, in order, in one folder.

    shorter : options to append to a subcommand that would take minutes.
    """
    (folder / "packages").symlink_to(REPOSITORY / "packages")
    printed = ""
    for block in blocks_of(page):
        where = f"{name_of(page)}:{block.line}"
        if block.language == "python":
            ran = run([sys.executable, "-W", "error", "-c", block.text], folder, environment)
            assert (ran.returncode, ran.stderr) == (0, ""), f"{where}: the program fails: {ran.stderr}"
            printed = ran.stdout
        elif block.language == "console":
            for step in steps(block.text):
                run_step(step, where, folder, environment, shorter)
        elif block.name:
            (folder / block.name).write_text(block.text, encoding="utf-8")
        elif block.language == "" and printed:
            assert block.text == printed, f"{where}: the program above prints {printed!r}"
            printed = ""


def run_step(
    step: Step,
    where: str,
    folder: Path,
    environment: Mapping[str, str],
    shorter: Mapping[str, tuple[str, ...]],
) -> None:
    """Run one command; every line that the page shows must be printed."""
    if step.command[0] in SETUP:
        return
    place = f"{where}: {shlex.join(step.command)}"
    assert step.command[0] == "fdvv", f"{place}: use a text block for commands of other programs"
    more = next((shorter[word] for word in step.command if word in shorter), ())
    ran = run([sys.executable, "-m", *step.command, *more], folder, environment)
    expected = 2 if step.shown and step.shown[0].startswith("fdvv: ") else 0
    assert ran.returncode == expected, f"{place}: exit status {ran.returncode}: {ran.stderr}"
    printed = [normalised(line) for line in (ran.stdout + ran.stderr).splitlines()]
    learned = step.command[1] in LEARNED
    for line in step.shown:
        matches = any(alike(normalised(line), other, learned) for other in printed)
        assert matches, f"{place}: does not print {line!r} but\n{ran.stdout}{ran.stderr}"


def run(command: list[str], folder: Path, environment: Mapping[str, str]) -> subprocess.CompletedProcess[str]:
    """Run a command in a folder."""
    return subprocess.run(
        command, cwd=folder, env=environment, capture_output=True, text=True, encoding="utf-8", check=False
    )


def install_example(folder: Path, file: str, source: str, toml: str) -> dict[str, str]:
    """Install a page's file as `my_package` below a folder; return the environment that finds it.

    toml : its entry points, as its pyproject.toml declares them.
    """
    assert source.count("\n") <= EXAMPLE_lines
    package, about = folder / "my_package", folder / "my_package-1.dist-info"
    package.mkdir()
    about.mkdir()
    (package / file).write_text(source)
    ((group, entries),) = tomllib.loads(toml)["project"]["entry-points"].items()
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: my-package\nVersion: 1\n")
    lines = [f"[{group}]", *(f"{name} = {place}" for name, place in entries.items())]
    (about / "entry_points.txt").write_text("\n".join(lines))
    return os.environ | {"PYTHONPATH": os.pathsep.join(map(str, (folder, *sys.path)))}


def normalised(line: str) -> str:
    """Drop milliseconds, and the column widths that depend on them."""
    return " ".join(MILLISECONDS.sub("", line).split())


def alike(shown: str, printed: str, learned: bool) -> bool:
    """Return whether two lines agree; learned figures may differ within the tolerances."""
    if shown == printed or not learned:
        return shown == printed
    if NUMBER.sub("#", shown) != NUMBER.sub("#", printed):
        return False
    pairs = zip(NUMBER.findall(shown), NUMBER.findall(printed), strict=True)
    return all(_near(float(one), float(other)) for one, other in pairs)


def _near(one: float, other: float) -> bool:
    return abs(one - other) <= max(LEARNED_absolute, LEARNED_ratio * abs(one))
