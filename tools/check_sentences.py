"""List sentences of the documents that are too long: ``python -m tools.check_sentences``.

Prints file, line, number of words and the sentence, and exits with 1. Code is left out, fenced or indented.
A link counts by its text, a piece of code within a line is one word, and every cell of a table is text of
its own.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PAGES = (
    "README.md",
    "docs/*.md",
    *(f"docs/{part}/*.md" for part in ("tutorials", "how-to", "explanation", "reference", "decisions")),
)
NOT_YET = {
    "docs/reference/bill.md",
}
"""Pages that still have long sentences: shorten them, then remove them here."""
MOST_WORDS = 25

_ITEM = re.compile(r"\s*(?:[-*+]|\d+\.)\s+")
_TAGS = re.compile(r"<[^>]+>")
_CODE = re.compile(r"(`+)(.+?)\1")
_LINK = re.compile(r"!?\[((?:[^\[\]]|\[[^\]]*\])*)\]\([^)]*\)")
_END = re.compile(r"(?<=[.!?])[\"')*_]*\s+")
_SHORT = re.compile(r"\b(?:e\.g|i\.e|et al|vs|cf|Fig)\.\s")


def blocks(text: str) -> Iterator[tuple[int, str]]:
    """Yield (line, text) of every paragraph, item, heading and cell of a table."""
    lines: list[str] = []
    start, fence, before = 1, "", ""
    for number, line in enumerate([*text.splitlines(), ""], start=1):
        mark = re.match(r"\s*(```+|~~~+)", line)
        code = line.startswith("    ") and not lines and not _ITEM.match(line) and not before.strip()
        before = "" if code else line
        plain = not fence and not mark and not code
        if lines and (
            not plain or not line.strip() or _ITEM.match(line) or line.lstrip().startswith(("|", "#"))
        ):
            yield start, " ".join(lines)
            lines = []
        if mark:
            fence = "" if fence else mark[1]
        elif plain and line.lstrip().startswith(("|", "#")):
            yield from ((number, cell) for cell in line.strip().strip("#").split("|") if cell.strip())
        elif plain and line.strip():
            start = start if lines else number
            item = _ITEM.match(line)
            lines.append(line[item.end() if item else 0 :].strip(" >"))


def sentences(block: str) -> list[str]:
    """Split a block into sentences, links by their text, a piece of code as one word."""
    plain = _LINK.sub(r"\1", _CODE.sub("CODE", _TAGS.sub(" ", block)))
    return _END.split(_SHORT.sub(lambda m: m[0].replace(". ", " "), plain))


def words(sentence: str) -> int:
    """Count what has a letter or a digit."""
    return sum(any(c.isalnum() for c in word) for word in sentence.split())


def found(text: str) -> Iterator[tuple[int, int, str]]:
    """Yield (line where its block begins, words, sentence) of every sentence that is too long."""
    for line, block in blocks(text):
        for sentence in sentences(block):
            if (count := words(sentence)) > MOST_WORDS:
                yield line, count, sentence.strip()


def main() -> int:
    wrong = 0
    for pattern in PAGES:
        for path in sorted(set(ROOT.glob(pattern)) - {ROOT / page for page in NOT_YET}):
            for line, count, sentence in found(path.read_text(encoding="utf-8")):
                print(f"{path.relative_to(ROOT)}:{line}: {count} words: {sentence}")
                wrong += 1
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
