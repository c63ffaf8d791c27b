"""What is needed of Markdown to write and check pages: headings and their anchors, links, blocks of code."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

FENCE = re.compile(r"^(`{3,})(\w*)\n(.*?)^\1$", flags=re.MULTILINE | re.DOTALL)
SPAN = re.compile(r"(`+)(?!`).*?(?<!`)\1(?!`)", flags=re.DOTALL)
NAMED = re.compile(r"`([\w.-]+\.\w+)`:\s*\Z")
HEADING = re.compile(r"^#{1,6} +(.+?)\s*$", flags=re.MULTILINE)
LINK = re.compile(r"\]\(([^()\s]+(?:\([^()\s]*\))?)\)")


@dataclass(frozen=True)
class Block:
    """A fenced block of code.

    Attributes
    ----------
    language : after the fence; "" if none is named. text : what stands in it. line : of its fence, from 1.
    name : of the file that it shows, if the words before it end with that name and a colon; else "".
    """

    language: str
    text: str
    line: int
    name: str = ""


def blocks(text: str) -> list[Block]:
    """Return the fenced blocks of a page, in their order."""
    return [_block(text, mark) for mark in FENCE.finditer(text)]


def _block(text: str, mark: re.Match[str]) -> Block:
    before = text[: mark.start()]
    named = NAMED.search(before)
    return Block(mark[2], mark[3], before.count("\n") + 1, named[1] if named else "")


def prose(text: str) -> str:
    """Return a page without its blocks and spans of code."""
    return SPAN.sub("", FENCE.sub("", text))


def slug(heading: str) -> str:
    """Return the anchor of a heading as GitHub and MyST make it."""
    shown = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading)
    return re.sub(r"[^\w\- ]", "", shown.strip().lower()).replace(" ", "-")


def slugs(headings: Iterable[str]) -> list[str]:
    """Return the anchors of all headings of a page; one that comes again gets a number."""
    seen: dict[str, int] = {}
    found = []
    for heading in headings:
        name = slug(heading)
        count = seen[name] = seen.get(name, -1) + 1
        found.append(f"{name}-{count}" if count else name)
    return found


def anchors(text: str) -> set[str]:
    """Return every anchor of a page."""
    return set(slugs([m[1] for m in HEADING.finditer(FENCE.sub("", text))]))


def links(text: str) -> list[str]:
    """Return the targets of all links and pictures of a page."""
    return LINK.findall(prose(text))


def escaped(text: str) -> str:
    """Keep Markdown from taking a ``<`` for a tag; code stays as it is."""
    pieces, last = [], 0
    for span in SPAN.finditer(text):
        pieces += [_plain(text[last : span.start()]), span[0]]
        last = span.end()
    return "".join([*pieces, _plain(text[last:])])


def _plain(text: str) -> str:
    return re.sub(r"([<\[])", r"\\\1", text)


def cell(text: str) -> str:
    """Return text as it may stand in a cell of a table."""
    return " ".join(text.split()).replace("|", "\\|")


def table(head: tuple[str, ...], rows: Sequence[tuple[str, ...]]) -> str:
    """Return a table; cells are Markdown already."""
    lines = [head, ("---",) * len(head), *rows]
    return "\n".join(f"| {' | '.join(cell(text) for text in row)} |" for row in lines) + "\n"
