"""Small faults planted in C code: another operator, a constant off by one, a statement gone."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

OTHER_OPERATOR = {
    "<": "<=",
    "<=": "<",
    ">": ">=",
    ">=": ">",
    "==": "!=",
    "!=": "==",
    "&&": "||",
    "||": "&&",
    "&": "|",
    "|": "&",
    "<<": ">>",
    ">>": "<<",
    "+": "-",
    "-": "+",
    "*": "+",
    "/": "*",
    "++": "--",
    "+=": "-=",
    "-=": "+=",
    "|=": "&=",
    "<<=": ">>=",
    "!": "",
    "~": "",
}
OPERATOR = re.compile(r"<<=|>>=|->|[-+|&<>=!]=|<<|>>|\+\+|--|&&|\|\||##|[-+*/<>&|!~]")
CONSTANT = re.compile(r"(?<![\w.])(0x[0-9a-f]+|\d+)(?![\w.])")
STATEMENT = re.compile(r"^ +(?! )((?!(?:static |const |u?int\d|fault_inputs )).+;)[ \\]*$", re.MULTILINE)
TYPE = re.compile(r"(\w_t|fdvv_\w+|fault_inputs|word) $")
OTHER_WORD = {
    "ALWAYS": ("RENDERING",),
    "RENDERING": ("ALWAYS",),
    "INACTIVE": ("ANYTIME", "NEVER"),
    "ANYTIME": ("INACTIVE", "NEVER"),
    "NEVER": ("INACTIVE", "ANYTIME"),
    "STOP": ("WARN",),
    "WARN": ("STOP",),
}
CELL = re.compile(r"\b(BOOT|TESTING|IDLE|ARMED|DERATED|FAULT|WRONG|BUSY|FAULTY)\b(?=[,}])")
BLANK = re.compile(r"/\*.*?\*/|^#include.*?$", re.DOTALL | re.MULTILINE)


@dataclass(frozen=True)
class Mutant:
    """Code with one fault: where it is, what became of what, the whole text."""

    line: int
    where: str
    what: str
    text: str

    @property
    def name(self) -> str:
        """Say what was changed, without numbers that move when lines are added."""
        return f"{self.where}: {self.what}"


def mutants(text: str) -> list[Mutant]:
    """Return every mutant of this C code, none of them twice."""
    code = BLANK.sub(lambda found: re.sub(r"[^\n]", " ", found[0]), text)
    spans = [
        *_operators(code),
        *_constants(code),
        *_statements(code),
        *_questions(code),
        *_cells(code),
        *_rows(code),
        *_columns(code),
    ]
    found = {}
    for start, end, new in spans:
        mutated = text[:start] + new + text[end:]
        line = code.count("\n", 0, start)
        column = start - code.rfind("\n", 0, start)
        where = text.split("\n")[line].strip(" \\")
        what = f"{plain(text[start:end])} -> {plain(new) or 'nothing'} at {column}"
        found[mutated] = Mutant(line + 1, plain(where), what, mutated)
    return list(found.values())


def plain(text: str) -> str:
    """Return the text with single blanks."""
    return " ".join(text.split())


Span = tuple[int, int, str]


def _operators(code: str) -> Iterator[Span]:
    for found in OPERATOR.finditer(code):
        new = OTHER_OPERATOR.get(found[0])
        before, after = code[: found.start()][-40:], code[found.end() :][:2]
        unary = found[0] in "-*&" and re.search(r"[(=?:,<>] *$", before)
        declares = found[0] == "*" and (after[0] == ")" or re.search(TYPE, before))
        if new is not None and not declares and not (unary and found[0] in "*&"):
            yield (*found.span(), "" if unary else new)


def _constants(code: str) -> Iterator[Span]:
    for found in CONSTANT.finditer(code):
        value = int(found[0], 0)
        yield (*found.span(), str(value + 1))
        yield (*found.span(), f"({value - 1})")


def _statements(code: str) -> Iterator[Span]:
    for found in STATEMENT.finditer(code):
        yield (*found.span(1), ";")


def _questions(code: str) -> Iterator[Span]:
    for found in re.finditer(r"\bif \((.+)\)[ {\\]*$", code, re.MULTILINE):
        yield (*found.span(1), f"!({found[1]})")


def _cells(code: str) -> Iterator[Span]:
    for found in CELL.finditer(code):
        for new in ("ARMED", "IDLE", "WRONG"):
            if new != found[1]:
                yield (*found.span(), new)


def _rows(code: str) -> Iterator[Span]:
    """Swap rows of a table of braces; leave out rows of a table of macros."""
    rows = list(re.finditer(r"^ +(\{\w+(?:, +\w+)+\}),$", code, re.MULTILINE))
    for one, other in pairwise(rows):
        between = code[one.end(1) : other.start(1)]
        yield one.start(1), other.end(1), other[1] + between + one[1]
    for found in re.finditer(r"^ +X\([A-Z_]+, .+\\\n.+\)[ \\]*$", code, re.MULTILINE):
        last = not found[0].rstrip().endswith("\\")
        yield (*found.span(), "" if last else "\\")


def _columns(code: str) -> Iterator[Span]:
    for row in re.finditer(r"^ +X\([A-Z_]+, ([A-Z]+), ([A-Z]+), ([A-Z]+),", code, re.MULTILINE):
        for group in (1, 2, 3):
            for new in OTHER_WORD.get(row[group], ()):
                yield (*row.span(group), new)
