"""Hash what the commands print and write, so that a change that should change nothing can be seen to.

``python -m tools.snapshot`` runs the commands of snapshot.toml and compares with tests/files/snapshot.json:
a line for each difference, and exit status 1. ``--write`` writes the hashes anew. ``--fdvv
OTHER/.venv/bin/fdvv`` runs those of another checkout; with ``--keep FOLDER`` for both, ``diff -r`` shows
what differs.

Only the command line is used, and no module of the package.
"""

from __future__ import annotations

import argparse
import hashlib
import io
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile
import time
import tomllib
import zipfile
from collections import defaultdict
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from fnmatch import fnmatch
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
CASES = Path(__file__).with_suffix(".toml")
COMMITTED = ROOT / "tests" / "files" / "snapshot.json"

FOLDER = "<folder>"
LIMIT_s = 180
DIGITS = 16

# Fields whose value differs from run to run, or from machine to machine, and why. Their presence is kept.
VARYING = {
    "time_s": "when it was written",
    "crc32": "of a line that holds a time",
    "versions": "of fdvv, Python and NumPy",
    "pressing_s": "how long the presses took by the clock of the wall",
    "stamp": "of a measured file: size and time",
}
VARIES = "varies"
# Text that differs from run to run, and what stands for it.
VARYING_TEXT = {
    r"\d{4}-\d\d-\d\d[T ]\d\d:\d\d(:\d\d(\.\d+)?)?(Z|[+-]\d\d:?\d\d)?": "<time>",
    r"(?<=[\"#])[a-z][0-9a-f]{10}(?=[\")])": "<name>",  # Matplotlib names what it draws at random
    r"\b24\d{5}\.\d+\b": "<day>",  # a DXF's Julian date
    r"\{[0-9A-F]{8}(-[0-9A-F]{4}){3}-[0-9A-F]{12}\}": "<id>",  # a DXF's name
}

# Python sources and compiled code change; the studio's page is built and tested from web/.
NOT_DATA = {".py", ".pyc", ".so", ".dylib", ".dll", ".c", ".h", ".typed", ""}


@dataclass(frozen=True)
class Case:
    """Commands that run one after another in a folder of their own."""

    name: str
    run: tuple[str, ...]
    written: dict[str, str] = field(default_factory=dict)
    folders: tuple[str, ...] = ()
    varying: tuple[str, ...] = ()
    data: bool = False

    def varies(self, name: str) -> bool:
        """Return whether a command or a file is random, so that only its parts' names count."""
        return any(fnmatch(name, pattern) for pattern in self.varying)


@dataclass(frozen=True)
class Checkout:
    """The checkout whose commands are run."""

    fdvv: Path
    package: Path
    root: Path

    @classmethod
    def of(cls, fdvv: Path) -> Checkout:
        python = fdvv.parent / "python"
        found = subprocess.run(
            [python, "-c", "import fdvv; print(fdvv.__file__)"], check=True, capture_output=True, text=True
        )
        package = Path(found.stdout.strip()).parent
        root = next(folder for folder in package.parents if (folder / "firmware" / "core").is_dir())
        return cls(fdvv, package, root)


def sha256(data: bytes) -> str:
    """Return the first digits of the SHA-256, enough to see a difference."""
    return hashlib.sha256(data).hexdigest()[:DIGITS]


def canonical(value: object) -> bytes:
    """Return JSON with its keys in the order they were written, for that order is part of the output."""
    return json.dumps(value, ensure_ascii=False, indent=1, default=str).encode()


class Normaliser:
    """Replaces what differs between two runs of the same code."""

    def __init__(self, paths: dict[str, str]) -> None:
        self.paths = sorted(paths.items(), key=lambda one: -len(one[0]))

    def text(self, text: str) -> str:
        for path, name in self.paths:
            text = text.replace(path, name)
        for pattern, name in VARYING_TEXT.items():
            text = re.sub(pattern, name, text)
        return text

    def value(self, value: object) -> object:
        if isinstance(value, dict):
            return {
                self.text(key): f"<{key}>" if key in VARYING else self.value(one)
                for key, one in value.items()
            }
        if isinstance(value, list):
            return [self.value(one) for one in value]
        return self.text(value) if isinstance(value, str) else value

    def json(self, text: str) -> tuple[bytes, dict[str, str]]:
        """Return a document without what varies, and a hash for each of its top-level keys."""
        value = self.value(json.loads(text))
        parts = value.items() if isinstance(value, dict) else [("list", value)]
        return canonical(value), {key: sha256(canonical(one)) for key, one in parts}

    def lines(self, text: str) -> tuple[bytes, dict[str, str]]:
        """Return a journal without what varies, and a hash for each kind of record."""
        values = [self.value(json.loads(line)) for line in text.splitlines()]
        kinds: dict[str, list[object]] = defaultdict(list)
        for value in values:
            kinds[kind_of(value)].append(value)
        return b"\n".join(map(canonical, values)), {
            f"{kind} x{len(ones)}": sha256(canonical(ones)) for kind, ones in kinds.items()
        }

    def columns(self, data: bytes) -> tuple[bytes, dict[str, str]]:
        """Return the columns of a table without what varies, and a hash for each."""
        import pyarrow.parquet

        table = pyarrow.parquet.read_table(io.BytesIO(data))
        value = self.value({name: table[name].to_pylist() for name in table.column_names})
        assert isinstance(value, dict)
        return canonical(value), {name: sha256(canonical(one)) for name, one in value.items()}

    def file(self, name: str, data: bytes) -> tuple[bytes, dict[str, str]]:
        """Return the bytes to hash, and what locates a difference inside them."""
        suffix = Path(name).suffix
        if suffix in {".npz", ".zip"}:
            with zipfile.ZipFile(io.BytesIO(data)) as archive:
                members = {one: archive.read(one) for one in sorted(archive.namelist())}
            return b"".join(members.values()), {one: sha256(held) for one, held in members.items()}
        if suffix == ".parquet":
            return self.columns(data)
        try:
            text = data.decode()
        except UnicodeDecodeError:
            return data, {}
        if suffix == ".jsonl":
            return self.lines(text)
        if text.startswith(("{", "[")):
            try:
                return self.json(text)
            except json.JSONDecodeError:
                pass
        if suffix == ".dxf":  # ezdxf writes the classes in the order of a set
            text = "\n".join(sorted(self.text(text).splitlines()))
        return self.text(text).encode(), {}


def kind_of(line: object) -> str:
    """Return the kind of a journal's line: the first field of its record."""
    record = line.get("record", line) if isinstance(line, dict) else {}
    return next(iter(record), "?") if isinstance(record, dict) else "?"


@dataclass
class Output:
    """The hash of something that was printed or written, and of its parts."""

    sha256: str
    parts: dict[str, str]
    status: int = 0

    def without(self, varying: bool) -> Output:
        """Return only which parts there are, of what is random."""
        if not varying:
            return self
        return Output(VARIES, dict.fromkeys(self.parts, VARIES), self.status)

    def plain(self) -> dict[str, Any]:
        return {
            **({"status": self.status} if self.status else {}),
            "sha256": self.sha256,
            **({"parts": self.parts} if self.parts else {}),
        }


def environment() -> dict[str, str]:
    """Return an environment in which colours, widths and threads are the same everywhere."""
    kept = {
        key: value for key, value in os.environ.items() if not key.startswith(("FDVV_", "COLUMNS", "FORCE_"))
    }
    return kept | {
        "NO_COLOR": "1",
        "COLUMNS": "100",
        "OPENBLAS_NUM_THREADS": "1",
        "LC_ALL": "C.UTF-8",
        "TZ": "UTC",
    }


def run_timed(case: Case, checkout: Checkout, data: Path, keep: Path | None) -> dict[str, dict[str, Any]]:
    """Run a case and say how long it took."""
    began = time.monotonic()
    outputs = run_case(case, checkout, data, keep)
    print(f"{case.name}: {time.monotonic() - began:.0f} s", file=sys.stderr)
    return outputs


def run_case(case: Case, checkout: Checkout, data: Path, keep: Path | None) -> dict[str, dict[str, Any]]:
    """Return the hash of each command's output and of each file, by name."""
    with tempfile.TemporaryDirectory(prefix="snapshot-") as temporary:
        folder = Path(temporary).resolve()
        for one in case.folders:
            (folder / one).mkdir()
        for name, text in case.written.items():
            (folder / name).write_text(text)
        places = {
            "example": str(next(checkout.package.rglob("cherry-mx-hyperglide-brown.csv"))),
            "hardware": str(checkout.root / "hardware"),
            "data": str(data),
        }
        normaliser = Normaliser({str(folder): FOLDER, **{path: f"<{name}>" for name, path in places.items()}})
        outputs: dict[str, dict[str, Any]] = {}
        for number, line in enumerate(case.run):
            words = shlex.split(line.format(**places))
            ran = subprocess.run(
                [checkout.fdvv, *words],
                cwd=folder,
                env=environment(),
                capture_output=True,
                timeout=LIMIT_s,
                check=False,
            )
            printed, parts = normaliser.file("", ran.stdout)
            key = f"$ {line}"
            varies = case.varies(line)
            outputs[key] = Output(sha256(printed), parts, ran.returncode).without(varies).plain()
            if keep is not None:
                at = keep / case.name
                at.mkdir(parents=True, exist_ok=True)
                (at / f"{number:02d}.out").write_bytes(printed)
                (at / f"{number:02d}.err").write_text(
                    f"$ fdvv {line}\n" + normaliser.text(ran.stderr.decode())
                )
        for path in sorted(folder.rglob("*")):
            name = path.relative_to(folder).as_posix()
            if not path.is_file() or name in case.written:
                continue
            held, parts = normaliser.file(name, path.read_bytes())
            outputs[name] = Output(sha256(held), parts).without(case.varies(name)).plain()
            if keep is not None:
                at = keep / case.name / name
                at.parent.mkdir(parents=True, exist_ok=True)
                at.write_bytes(held)
    return outputs


def package_files(checkout: Checkout) -> dict[str, Any]:
    """Return the hash of each data file of the package by its bare name, wherever it lies."""
    found: dict[str, list[str]] = defaultdict(list)
    packages = [*checkout.root.glob("packages/*/src/*")] or [checkout.package]
    for path in (path for package in packages for path in package.rglob("*")):
        if path.is_file() and path.suffix not in NOT_DATA and not {"static", "__pycache__"} & set(path.parts):
            found[path.name].append(sha256(path.read_bytes()))
    return {name: {"sha256": " ".join(sorted(found[name]))} for name in sorted(found)}


def protocol_files(checkout: Checkout) -> dict[str, Any]:
    """Return the definitions of the wire, and their hashes as the firmware holds them."""
    outputs = {
        one.name: {"sha256": sha256(one.read_bytes())}
        for one in sorted((checkout.root / "protocol").iterdir())
        if one.is_file()
    }
    for header in sorted((checkout.root / "firmware").rglob("*protocol.h")):
        for name, value in re.findall(r"#define (\w*PROTOCOL_HASH) (\w+)", header.read_text()):
            outputs[name] = {"sha256": value}
    return outputs


def firmware_files(checkout: Checkout) -> dict[str, Any]:
    """Return the hash of each image that was built of a board's program; none where none was."""
    built = checkout.root / "build" / "firmware"
    return {
        path.name: {"sha256": sha256(path.read_bytes())}
        for path in sorted(built.glob("*"))
        if path.suffix in {".bin", ".hex", ".uf2"}
    }


def differences(name: str, before: dict[str, Any], after: dict[str, Any]) -> Iterator[str]:
    """Yield a line for each output of a case that is not the same."""
    for key in before:
        if key not in after:
            yield f"{name}: {key}: gone"
    for key, held in after.items():
        if key not in before:
            yield f"{name}: {key}: new"
        elif held != before[key]:
            yield f"{name}: {key}: {what_differs(before[key], held)}"


def what_differs(before: dict[str, Any], after: dict[str, Any]) -> str:
    """Return in a few words what differs between two hashes of one output."""
    if before.get("status") != after.get("status"):
        return f"exit status {after.get('status', 0)}, was {before.get('status', 0)}"
    old, new = before.get("parts", {}), after.get("parts", {})
    changed = [f"{part} differs" for part in new if part in old and new[part] != old[part]]
    gone = [f"{part} gone" for part in old if part not in new]
    added = [f"{part} new" for part in new if part not in old]
    return ", ".join([*changed, *gone, *added]) or "differs"


def read_cases() -> list[Case]:
    """Return the cases of snapshot.toml."""
    held = tomllib.loads(CASES.read_text())["case"]
    return [
        Case(
            one["name"],
            tuple(one["run"]),
            one.get("written", {}),
            tuple(one.get("folders", ())),
            tuple(one.get("varying", ())),
            one.get("data", False),
        )
        for one in held
    ]


def take(
    checkout: Checkout, only: Iterable[str], keep: Path | None, processes: int
) -> dict[str, dict[str, Any]]:
    """Return the hashes of every case that is asked for and possible."""
    data = Path(os.environ.get("FDVV_SHARED", ROOT.parent / "shared")) / "data"
    wanted = set(only)
    cases = [one for one in read_cases() if not wanted or one.name in wanted]
    for case in [one for one in cases if one.data and not data.is_dir()]:
        print(f"{case.name}: skipped, there is no {data.name} folder of real measurements", file=sys.stderr)
        cases.remove(case)
    with ThreadPoolExecutor(processes) as pool:
        taken = dict(
            zip(
                [one.name for one in cases],
                pool.map(lambda one: run_timed(one, checkout, data, keep), cases),
                strict=True,
            )
        )
    files = {"package": package_files, "protocol": protocol_files, "firmware": firmware_files}
    for name, hashed in files.items():
        if not wanted or name in wanted:
            outputs = hashed(checkout)
            if outputs:
                taken[name] = outputs
            else:
                print(f"{name}: skipped, none is built", file=sys.stderr)
    return taken


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--write", action="store_true", help="write the hashes anew")
    parser.add_argument("--only", action="append", default=[], metavar="NAME", help="a case; repeatable")
    parser.add_argument("--keep", type=Path, metavar="FOLDER", help="keep what was hashed, normalised")
    parser.add_argument(
        "--fdvv", type=Path, default=Path(sys.executable).parent / "fdvv", help="another fdvv"
    )
    parser.add_argument("--processes", type=int, default=os.cpu_count() or 1, help="cases at once")
    options = parser.parse_args()
    checkout = Checkout.of(options.fdvv.absolute())
    known = {one.name for one in read_cases()} | {"package", "protocol", "firmware"}
    if unknown := set(options.only) - known:
        parser.error(f"no case {', '.join(sorted(unknown))}; there are {', '.join(sorted(known))}")
    taken = take(checkout, options.only, options.keep, options.processes)
    before = json.loads(COMMITTED.read_text()) if COMMITTED.exists() else {}
    if options.write:
        COMMITTED.parent.mkdir(parents=True, exist_ok=True)
        COMMITTED.write_text(json.dumps(before | taken, indent=1, ensure_ascii=False, sort_keys=True) + "\n")
        print(f"{len(taken)} cases written to {COMMITTED.relative_to(ROOT)}")
        return 0
    found = [
        line for name, outputs in taken.items() for line in differences(name, before.get(name, {}), outputs)
    ]
    print("\n".join(found) or f"{len(taken)} cases: no difference")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
