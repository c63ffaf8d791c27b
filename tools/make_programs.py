"""Write the shipped programs as files: ``python tools/make_programs.py``."""

from __future__ import annotations

from pathlib import Path

from fdvv.io.files import write_atomic
from fdvv.program.file import PROGRAM_SUFFIX, program_to_json
from fdvv.program.library import make, programs

FOLDER = Path(__file__).parents[1] / "packages/fdvv/src/fdvv/program/library"


def files() -> dict[Path, str]:
    """Return every file with its text: each program on its default base with its default parameters."""
    return {FOLDER / f"{p.name}{PROGRAM_SUFFIX}": program_to_json(make(p.name)) for p in programs()}


if __name__ == "__main__":
    for path, text in files().items():
        write_atomic(path, text)
        print(path)
