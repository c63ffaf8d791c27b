"""Docstrings in the way of this house: a sentence, paragraphs, and entries ``name : what it is``."""

from __future__ import annotations

import re
from dataclasses import dataclass

ENTRY = re.compile(r"(?:^|(?<=; )|(?<=\. ))(\*{0,2}\w+(?:, \*{0,2}\w+)*) ?: ")
HEADING = re.compile(r"(?m)^(Attributes|Parameters)\n-+\n")


@dataclass(frozen=True)
class Said:
    """What a docstring says, apart from its entries: a sentence, and paragraphs; indented ones are code."""

    head: str
    body: tuple[str, ...] = ()


def named(name: str, text: str) -> bool:
    """Tell whether a text names something, as a word of its own."""
    return re.search(rf"(?<![\w.]){re.escape(name)}(?!\w)", text) is not None


def read(doc: str, names: tuple[str, ...]) -> tuple[Said | None, dict[str, str]]:
    """Split a docstring into its text and what it says of each of the given names."""
    if not doc:
        return None, {}
    head, _, rest = doc.partition("\n\n")
    first, entries = _split(head, names)
    body = []
    for block in re.split(r"\n{2,}", HEADING.sub("", rest)):
        if all(line.startswith("    ") for line in block.splitlines()):
            body.append(block)
            continue
        text, found = _block(block, names)
        entries |= found
        body.append(text)
    return Said(first, tuple(text for text in body if text.strip())), entries


def _block(block: str, names: tuple[str, ...]) -> tuple[str, dict[str, str]]:
    """Take the entries out of a paragraph: further lines of an entry are indented, or end with a sentence."""
    texts: list[str] = []
    entries: dict[str, str] = {}
    hanging = re.search(r"\n {2,}\S", block) is not None
    for piece in re.split(r"\n(?=\S)", block) if hanging else [block]:
        told, after = (piece, "") if hanging else _at_sentence(piece)
        if not _split(told, names)[1]:
            told, after = piece, ""
        text, found = _split(told, names)
        entries |= found
        texts += [text, " ".join(after.split())]
    return " ".join(text for text in texts if text), entries


def _at_sentence(text: str) -> tuple[str, str]:
    """Cut behind the first line that ends a sentence."""
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
