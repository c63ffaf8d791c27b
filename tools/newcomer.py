"""Type what the README and the page of features say, in a folder of the sources; tools/newcomer.sh calls it.

usage: python -m tools.newcomer FOLDER install|use. The commands are read out of these documents, so that they
cannot differ from what is tried.
"""

from __future__ import annotations

import re
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

from tools.try_wheel import fetched

ACTIVATE = ". .venv/bin/activate"
STUDIO = "fdvv studio"
LONGEST_s = 900


def blocks(readme: str) -> list[tuple[str, list[str]]]:
    """Return language and lines of every fenced block."""
    found = re.findall(r"^```(\w*)\n(.*?)^```$", readme, flags=re.MULTILINE | re.DOTALL)
    return [(language, text.splitlines()) for language, text in found]


def commands(folder: Path) -> tuple[list[str], list[str], str]:
    """Return what is typed to install, what is typed then, and the program in Python; all without remarks."""
    (install,) = plain(folder / "README.md")
    (use,) = plain(folder / "docs" / "features.md")
    features = (folder / "docs" / "features.md").read_text(encoding="utf-8")
    (program,) = ["\n".join(lines) for language, lines in blocks(features) if language == "python"]
    if install[0] != "make demo" or use[:2] != [ACTIVATE, STUDIO]:
        raise SystemExit("newcomer: the documents begin otherwise than this path; walk it anew")
    return install[:1], use, program


def plain(page: Path) -> list[list[str]]:
    """Return the commands of every block that names no language."""
    found = blocks(page.read_text(encoding="utf-8"))
    return [[line.partition("#")[0].strip() for line in lines] for language, lines in found if not language]


def typed(folder: Path, line: str) -> str:
    """Type a line; SystemExit with what it said if it fails."""
    ran = subprocess.run(
        ["bash", "-c", line], cwd=folder, capture_output=True, text=True, timeout=LONGEST_s, check=False
    )
    if ran.returncode:
        raise SystemExit(f"newcomer: {line} ended with {ran.returncode}:\n{ran.stdout}{ran.stderr}")
    return ran.stdout


def studio(folder: Path, line: str) -> str:
    """Open the studio, fetch its page with the token it printed, close it."""
    command = ["bash", "-c", f"{line} --no-browser --port 0"]
    with subprocess.Popen(
        command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    ) as running:
        try:
            assert running.stdout
            return fetched(running.stdout.readline().split()[-1])
        finally:
            running.terminate()


def steps(folder: Path, phase: str) -> Iterator[tuple[str, str]]:
    """Take the steps of a phase; give of each its line and what to tell of it."""
    install, use, program = commands(folder)
    if phase == "install":
        for line in install:
            yield line, typed(folder, line).splitlines()[-1]
        if not (folder / "demo" / "report.html").is_file():
            raise SystemExit("newcomer: make demo wrote no report")
        return
    for line in use[1:]:
        active = f"{ACTIVATE}; exec {line}"
        yield line, studio(folder, active) if line == STUDIO else last(typed(folder, active))
    yield "python", last(typed(folder, f"{ACTIVATE}; python -c '{program}'"))


def last(text: str) -> str:
    """Return the last line of a text that has any."""
    return (text.strip().splitlines() or [""])[-1].strip()


def main() -> None:
    """Walk, and tell the seconds of every step."""
    folder, phase = Path(sys.argv[1]), sys.argv[2]
    begun = before = time.monotonic()
    for line, result in steps(folder, phase):
        now = time.monotonic()
        print(f"{now - before:7.1f} s  {line:.60s}  {result:.60s}", flush=True)
        before = now
    print(f"{before - begun:7.1f} s  {phase}, in all", flush=True)


if __name__ == "__main__":
    main()
