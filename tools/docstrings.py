"""Read docstrings: a summary, paragraphs, and entries ``name : meaning``."""

from __future__ import annotations

import re
from dataclasses import dataclass

ENTRY = re.compile(r"(?:^|(?<=; )|(?<=\. ))(\*{0,2}\w+(?:, \*{0,2}\w+)*) ?: ")
HEADING = re.compile(r"(?m)^(Attributes|Parameters)\n-+\n")
SECTION = re.compile(r"(?m)^(Returns|Yields|Raises|Warns|Notes|Examples?|References|See Also)\n-+\n")


@dataclass(frozen=True)
class Text:
    """A docstring without its entries.

    Attributes
    ----------
    summary : the first sentence or paragraph.
    paragraphs : the rest; an indented paragraph is code.
    """

    summary: str
    paragraphs: tuple[str, ...] = ()


def mentions(text: str, name: str) -> bool:
    """Return whether a text contains a name as a whole word."""
    return re.search(rf"(?<![\w.]){re.escape(name)}(?!\w)", text) is not None


def read(doc: str, names: tuple[str, ...]) -> tuple[Text | None, dict[str, str]]:
    """Split a docstring into its text and the meanings of the given names."""
    if not doc:
        return None, {}
    head, _, rest = doc.partition("\n\n")
    summary, entries = _split(head, names)
    paragraphs = []
    for block in re.split(r"\n{2,}", HEADING.sub("", rest)):
        if all(line.startswith("    ") for line in block.splitlines()):
            paragraphs.append(block)
            continue
        text, more = _read_block(block, names)
        entries |= more
        paragraphs.append(text)
    return Text(summary, tuple(text for text in paragraphs if text.strip())), entries


def _read_block(block: str, names: tuple[str, ...]) -> tuple[str, dict[str, str]]:
    """Take the entries out of a paragraph; continuation lines are indented or end with a sentence."""
    texts: list[str] = []
    entries: dict[str, str] = {}
    hanging = re.search(r"\n {2,}\S", block) is not None
    for piece in re.split(r"\n(?=\S)", block) if hanging else [block]:
        entry, after = (piece, "") if hanging else _cut_at_sentence(piece)
        if not _split(entry, names)[1]:
            entry, after = piece, ""
        text, more = _split(entry, names)
        entries |= more
        texts += [text, " ".join(after.split())]
    return " ".join(text for text in texts if text), entries


def _cut_at_sentence(text: str) -> tuple[str, str]:
    cut = re.search(r"\.\n(?=[A-Z])", text)
    return (text[: cut.start() + 1], text[cut.end() :]) if cut else (text, "")


def _split(text: str, names: tuple[str, ...]) -> tuple[str, dict[str, str]]:
    line = " ".join(text.split())
    marks = [m for m in ENTRY.finditer(line) if all(n.strip("* ") in names for n in m[1].split(","))]
    ends = [*(mark.start() for mark in marks[1:]), len(line)][: len(marks)]
    entries = {
        name.strip("* "): line[mark.end() : end].strip().rstrip(";.")
        for mark, end in zip(marks, ends, strict=True)
        for name in mark[1].split(",")
    }
    return line[: marks[0].start()].strip() if marks else line, entries
