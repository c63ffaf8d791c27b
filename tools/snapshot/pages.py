"""The text of HTML pages and of drawings, without their markup."""

from __future__ import annotations

import re
from html.parser import HTMLParser

from tools.snapshot.values import describe_numbers, digest

LEFT_OUT = ("script", "style")
INLINE = (
    *("a", "abbr", "b", "code", "em", "i", "kbd", "small", "span", "strong", "sub", "sup", "tspan", "u"),
)
CELLS = ("td", "th")
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
GEOMETRY = ("d", "points", "transform", "x", "y", "x1", "x2", "y1", "y2", "cx", "cy", "r", "width", "height")


class Page(HTMLParser):
    """Collects the lines of a page; of every drawing its words, and a line on its geometry."""

    def __init__(self) -> None:
        super().__init__()
        self._words = [""]
        self._skipped = 0
        self._numbers: list[float] = []
        self._shapes = 0
        self._drawings = 0

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self._skipped += tag in LEFT_OUT
        self._drawings += tag == "svg"
        if self._drawings:
            self._shapes += 1
            self._numbers += [
                float(number)
                for name, text in attrs
                if name in GEOMETRY and text
                for number in NUMBER.findall(text)
            ]
        if image := dict(attrs).get("src"):
            self._words.append(f"[{tag} {digest(image)}]" if len(image) > 80 else f"[{tag} {image}]")
        self._separate(tag)

    def handle_endtag(self, tag: str) -> None:
        self._skipped -= tag in LEFT_OUT
        self._separate(tag)
        if tag == "svg":
            self._drawings -= 1
            self._words.append(f"[{self._shapes} elements, {describe_numbers(self._numbers)}]\n")
            self._shapes, self._numbers = 0, []

    def handle_data(self, data: str) -> None:
        if not self._skipped:
            self._words.append(re.sub(r"\s+", " ", data))

    def _separate(self, tag: str) -> None:
        if tag in CELLS:
            self._words.append(" | ")
        elif tag not in INLINE:
            self._words.append("\n")

    def text(self) -> str:
        """Return the lines; a table's cells are separated by bars."""
        lines = (re.sub(r"[ |]*\|[ |]*", " | ", line) for line in "".join(self._words).split("\n"))
        plain = (re.sub(r" +", " ", line).strip(" |") for line in lines)
        return "\n".join(line for line in plain if line)


def page_text(text: str) -> str:
    """Return the text of an HTML page, or of a drawing in SVG."""
    page = Page()
    page.feed(text)
    page.close()
    return page.text()
