"""The cases of cases.toml: commands that run one after another in a folder of their own."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import tempfile
import tomllib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from fnmatch import fnmatch
from pathlib import Path
from typing import Any

from tools.snapshot.commands import ROOT, Commands
from tools.snapshot.compare import difference
from tools.snapshot.files import text_of
from tools.snapshot.normalise import Normaliser
from tools.snapshot.values import shorten_repeats

CASES = Path(__file__).with_name("cases.toml")
DATA = Path(os.environ.get("FDVV_SHARED", ROOT.parent / "shared")) / "data"
FILES = ROOT / "tests" / "files"
PLACES = {
    "old": FILES / "old",
    "frozen": FILES / "frozen",
    "answers": FILES / "answers",
    "hardware": ROOT / "hardware",
    "data": DATA,
}
"""Folders that steps name in braces."""


@dataclass(frozen=True)
class Case:
    """Commands and the files that they begin with.

    Attributes
    ----------
    run : the steps, commands of fdvv or edits. fields : of JSON, whose values are random or take time.
    unread : patterns of files that are not looked at. data : whether it needs the real measurements.
    slow : whether it is left out of the default tests.
    """

    name: str
    run: tuple[str, ...]
    written: dict[str, str] = field(default_factory=dict)
    folders: tuple[str, ...] = ()
    fields: tuple[str, ...] = ()
    unread: tuple[str, ...] = ()
    data: bool = False
    slow: bool = False


def read_cases() -> list[Case]:
    """Return the cases of cases.toml; one with `each` is a case for every name in it."""
    tables = tomllib.loads(CASES.read_text())["case"]
    return [make_case(table, each) for table in tables for each in table.pop("each", [""])]


def make_case(table: dict[str, Any], each: str) -> Case:
    """Make the case of a table, with a name in place of EACH."""
    fields: dict[str, Any] = {
        key: tuple(text.replace("EACH", each) for text in value) if isinstance(value, list) else value
        for key, value in table.items()
    }
    return Case(**fields | {"name": table["name"].replace("EACH", each)})


def run_case(case: Case, commands: Commands) -> str:
    """Return what a case prints and writes."""
    with tempfile.TemporaryDirectory(prefix="snapshot-") as temporary:
        folder = Path(temporary).resolve()
        for name in case.folders:
            (folder / name).mkdir()
        for name, text in case.written.items():
            (folder / name).write_text(text)
        normaliser = Normaliser({"folder": folder, **PLACES}, case.fields)
        parts = [f"== $ {line}\n{run_step(line, folder, commands, normaliser)}" for line in case.run]
        parts += written_files(case, folder, normaliser)
    return "\n".join(shorten_repeats("\n\n".join(part.rstrip() for part in parts).splitlines()))


def run_step(line: str, folder: Path, commands: Commands, normaliser: Normaliser) -> str:
    """Run a step; return what it prints, of a command that fails its exit status and its errors too."""
    word, *words = shlex.split(line.format(**PLACES))
    if word == "same":
        before, after = (text_of(name, (folder / name).read_bytes(), normaliser) for name in words)
        return difference(before, after) or "the same"
    if word in EDITS:
        EDITS[word](folder, *words)
        return ""
    printed = commands.run([word, *words], folder)
    text = text_of("", printed.output, normaliser)
    if printed.status:
        text = f"exit status {printed.status}\n{normaliser.text(printed.errors)}{text}"
    return text


def written_files(case: Case, folder: Path, normaliser: Normaliser) -> Iterator[str]:
    """Yield the text of each file that the commands wrote."""
    for path in sorted(folder.rglob("*")):
        name = path.relative_to(folder).as_posix()
        unread = name in case.written or any(fnmatch(name, pattern) for pattern in case.unread)
        if path.is_file() and not unread:
            yield f"== {name}\n{text_of(name, path.read_bytes(), normaliser)}"


def keep_lines(folder: Path, name: str, count: str) -> None:
    """Cut a file after so many lines, as if its writer had been killed there."""
    path = folder / name
    path.write_text("".join(path.read_text().splitlines(keepends=True)[: int(count)]))


def copy_folder(folder: Path, source: str, name: str) -> None:
    shutil.copytree(source, folder / name)


def delete_file(folder: Path, name: str) -> None:
    (folder / name).unlink()


def set_numbers(folder: Path, name: str, *numbers: str) -> None:
    """Set numbers of a TOML file, given as KEY=NUMBER, where it has them."""
    text = (folder / name).read_text()
    for number in numbers:
        key, _, value = number.partition("=")
        text = re.sub(rf"^{key} = [\d.]+", f"{key} = {value}", text, flags=re.MULTILINE)
    (folder / name).write_text(text)


EDITS: dict[str, Callable[..., None]] = {
    "copy": copy_folder,
    "keep-lines": keep_lines,
    "delete": delete_file,
    "set": set_numbers,
}
