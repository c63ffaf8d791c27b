"""Look for words of our own making where a standard term exists: ``python -m tools.check_words``.

Prints file, line and the term to use, and exits with 1. Keys of files and messages keep their old names: a
word in quotes is left alone.
"""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
CODE = (".py", ".ts", ".svelte", ".c", ".h")
PROSE = (".md", ".toml", ".html")
LEFT_OUT = (
    "tests/files/",
    "CHANGELOG.md",
    "tools/check_words.py",
    "packages/fdvv-studio/src/fdvv_studio/studio/static/",
    "web/src/net/messages.ts",
)

EVERYWHERE = {
    r"told": "say what it is: message, summary, reported, telemetry",
    r'"""(Give|Tell)s? ': "Return ..., or no docstring where the name says it",
}
IN_CODE = {
    r"\w*_told(?:_\w+)?|told_\w+|\w*Told|\w*TOLD": "message, summary, event or telemetry, by what it holds",
    r"Standing": "Ranking, VelocityProgress or JobProgress",
    r"Way|way_us16000": "Direction, SynthesisMethod, offset",
    r"Hands|AskedHands": "Operator",
    r"Stand|stand_of": "CompiledDesign, compile_design",
    r"Course": "SessionPlan",
    r"(?<=class )(Ask|Kept|Given)": "PressRequest, PressRecord, AnswerRecord",
    r"(?<=class )(Became|Felt|Pass)": "TrialOutcome, PressError, StrokeSample",
    r"(?<=class )(Began|Left|Settled|Resumed)": "SessionStarted, SessionClosed, StaircaseConverged ...",
    r"held_back": "defer_interrupt",
    r"HeldStage|StudyStage": "ReconnectableRenderer, StimulusRenderer",
    r"_meet|meet_most|meet": "identify, identification_presses",
    r"KnownRig|RigMemory": "RigModel, LearnedRig",
    r"believed|held_up": "prior_table, minimum_lift_surface",
    r"felt_cN|felt_press|FeltPress": "rendered_cN, bin_press, RenderedPress",
}


def _whole(pattern: str) -> re.Pattern[str]:
    return re.compile(pattern if pattern.startswith('"') else rf'(?<![\w"])(?:{pattern})(?![\w"])')


# The server's messages carry a field `told`, which pages read as a property: the wire's names are frozen.
# The CSS class `.press-told` belongs to the page.
WIRE_FIELD = re.compile(r"\.told\b|\btold: (?=string|\"\")|press-told|^told = ")


RULES = {
    **{_whole(pattern): (CODE + PROSE, term) for pattern, term in EVERYWHERE.items()},
    **{_whole(pattern): (CODE, term) for pattern, term in IN_CODE.items()},
}


def found(text: str, suffix: str) -> Iterator[tuple[int, str, str]]:
    """Yield (line, word, what to write in its place)."""
    for number, line in enumerate(text.splitlines(), start=1):
        for pattern, (suffixes, term) in RULES.items():
            if suffix in suffixes and (match := pattern.search(WIRE_FIELD.sub("", line))):
                yield number, match.group(), term


def main() -> int:
    names = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    wrong = 0
    for name in names.splitlines():
        path = ROOT / name
        if path.suffix not in CODE + PROSE or name.startswith(LEFT_OUT) or not path.is_file():
            continue
        for number, word, term in found(path.read_text(encoding="utf-8"), path.suffix):
            print(f"{name}:{number}: {word.strip()}: {term}")
            wrong += 1
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
