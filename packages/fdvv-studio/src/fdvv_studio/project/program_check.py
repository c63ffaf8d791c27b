"""Problems of a program, each with the place in its document, and how much of a device it takes."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field

import msgspec

from fdvv.errors import InputError
from fdvv.program.check import Finding, Severity, check_program
from fdvv.program.compile import Compiled, compile_program, part_counts
from fdvv.program.program import Program
from fdvv.program.surface import Limits
from fdvv.protocol.tables import IMAGE_BYTES, SURFACE_DISPLACEMENTS, SURFACE_VELOCITIES
from fdvv_studio.project.programs import read_program

PARTS = {"state": "states", "surface": "surfaces", "signal": "signals"}
"""Kinds of named parts, and the fields of a document that list them."""


@dataclass(frozen=True)
class PlacedFinding(Finding):
    """A finding with its place in the document.

    path : of the part it concerns, such as ``states[1].transitions[0]``; empty for the whole program.
    at_mm : the displacement it is about, or None.
    """

    path: str
    at_mm: float | None = None


@dataclass(frozen=True)
class Size:
    """How much of something a program takes, and how much a device holds; None if it is not known yet."""

    what: str
    taken: int | None
    most: int


@dataclass(frozen=True)
class SurfaceSize:
    """What a surface becomes in an image: even columns, rows of velocities, and what that costs in force."""

    name: str
    columns: int
    rows: int
    error_cN: float


@dataclass(frozen=True)
class ProgramCheckResult:
    """What a check found and what compiling would give.

    Attributes
    ----------
    findings : refusals first.
    sizes : image bytes first, then the counts.
    surfaces : empty while the program cannot be compiled.
    return_s : bound of the time in which the cap comes back; None if unproven.
    stiffness_cN_mm, rise_K : as a Report has them; None if the program was not checked so far.
    accepted : a device may be given the program: nothing is refused.
    """

    findings: tuple[PlacedFinding, ...]
    sizes: tuple[Size, ...] = ()
    surfaces: tuple[SurfaceSize, ...] = ()
    return_s: float | None = None
    stiffness_cN_mm: float | None = None
    rise_K: float | None = None
    accepted: bool = field(init=False)

    def __post_init__(self) -> None:
        refused = any(f.severity is Severity.REFUSED for f in self.findings)
        object.__setattr__(self, "accepted", not refused)


def check_program_text(text: str, limits: Limits | None = None) -> ProgramCheckResult:
    """Check the text of a program file as far as it goes; never raises for what a person can mend.

    A text that is no program has one finding. One that no device could hold is not checked further than
    that, for the proof that the cap comes back takes time that grows with the program.
    """
    limits = limits or Limits()
    try:
        program = read_program(text)
    except InputError as error:
        return ProgramCheckResult((_unreadable(text, error),))
    try:
        compiled = compile_program(program, limits)
    except InputError as error:
        if any(taken > most for _, taken, most in _counts(program)):
            problem = _of_error(path_of(error.place, _names(program)), error)
            return ProgramCheckResult((problem,), _sizes(program, None))
        compiled = None
    report = check_program(program, limits)
    return ProgramCheckResult(
        tuple(_place(program, finding) for finding in report.findings),
        _sizes(program, compiled),
        _surface_sizes(program, compiled),
        report.return_s,
        report.stiffness_cN_mm,
        report.rise_K,
    )


def _counts(program: Program) -> list[tuple[str, int, int]]:
    rows = max(len(s.velocity_mm_s) for s in program.surfaces)
    return [*part_counts(program), ("velocities", rows, SURFACE_VELOCITIES)]


def _sizes(program: Program, compiled: Compiled | None) -> tuple[Size, ...]:
    columns = max(compiled.columns.values()) if compiled else None
    return (
        Size("bytes", len(compiled.image) if compiled else None, IMAGE_BYTES),
        *(Size(*count) for count in _counts(program)),
        Size("columns", columns, SURFACE_DISPLACEMENTS),
    )


def _surface_sizes(program: Program, compiled: Compiled | None) -> tuple[SurfaceSize, ...]:
    if compiled is None:
        return ()
    return tuple(
        SurfaceSize(s.name, compiled.columns[s.name], len(s.velocity_mm_s), compiled.grid_error_cN[s.name])
        for s in program.surfaces
    )


def _names(program: Program) -> dict[str, list[str]]:
    return {kind: [part.name for part in getattr(program, field)] for kind, field in PARTS.items()}


def _place(program: Program, finding: Finding) -> PlacedFinding:
    words = f"state {finding.state!r}, {finding.place}" if finding.state else finding.place
    number = re.search(r"(-?\d+(?:\.\d+)?) mm\b", finding.place)
    path = path_of(words, _names(program))
    return PlacedFinding(**vars(finding), path=path, at_mm=float(number[1]) if number else None)


def _of_error(path: str, error: InputError) -> PlacedFinding:
    return PlacedFinding(Severity.REFUSED, "", error.place, error.reason, error.remedy, path)


def _unreadable(text: str, error: InputError) -> PlacedFinding:
    """Locate what makes a text invalid: by the path in the error, or by the part it names."""
    path = error.place.removeprefix("$").removeprefix(".") if error.place.startswith("$") else ""
    return _of_error(path or path_of(error.reason, _names_in(text)), error)


def _names_in(text: str) -> dict[str, list[str]]:
    """Find the names of the parts in a text that need not be a program."""
    try:
        document = msgspec.json.decode(text)
    except (msgspec.MsgspecError, UnicodeError, RecursionError):
        return {}
    if not isinstance(document, dict):
        return {}
    lists = {kind: document.get(field) for kind, field in PARTS.items()}
    return {
        kind: [str(part.get("name")) if isinstance(part, dict) else "" for part in parts]
        for kind, parts in lists.items()
        if isinstance(parts, list)
    }


def path_of(words: str, names: dict[str, list[str]]) -> str:
    """Turn words such as ``state 'up', transition 1`` into the path of that part; empty for the whole.

    A surface named within a state is the part that is meant, for it is what can be mended.
    """
    indices = {kind: _index_of_name(words, kind, names.get(kind, ())) for kind in PARTS}
    if indices["surface"] is not None:
        return f"surfaces[{indices['surface']}]"
    if indices["state"] is not None:
        path = f"states[{indices['state']}]"
        transition = re.search(r", transition (\d+)", words)
        return f"{path}.transitions[{int(transition[1]) - 1}]" if transition else path
    if indices["signal"] is not None:
        return f"signals[{indices['signal']}]"
    vibration = re.match(r"vibration (\d+)", words)
    if vibration:
        return f"vibrations[{int(vibration[1]) - 1}]"
    return {"travel": "travel_mm", "travel_mm": "travel_mm", "start:": "start"}.get(words.split(" ")[0], "")


def _index_of_name(words: str, kind: str, names: Sequence[str]) -> int | None:
    """Return the index of the part named at the start or after a comma; the last of equal names."""
    for i in reversed(range(len(names))):
        part = f"{kind} {names[i]!r}"
        if words.startswith(part) or f", {part}" in words or words == f"two {kind}s are called {names[i]!r}":
            return i
    return None
