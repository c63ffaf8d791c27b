"""The bill of materials: what to buy or print, how many, and what it costs."""

from __future__ import annotations

import csv
import io
import tomllib
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from datetime import date
from importlib import resources
from typing import Any

from fdvv.errors import InputError, ModelError
from fdvv_rig.circuit.circuit import Circuit
from fdvv_rig.circuit.circuit_report import page
from fdvv_rig.parts import PARTS, Part

PAPER_USD = 550.0
"""What the paper says the construction of its simulator costs, about."""

GROUPS = ("rig", "vibration", "strip", "capture")
"""The rig itself; what makes it vibrate; the pointing task's strip; the capture bench."""

COLUMNS = ("group", "role", "maker", "part_number", "count", "pack", "packs", "price_USD", "total_USD")
"""Of CSV, and then when and from whom the price is, and what else would do."""


@dataclass(frozen=True)
class BillLine:
    """One line: what, from whom, how many, for how much.

    Attributes
    ----------
    role : what the circuit and the drawings call it. group : one of GROUPS.
    count : how many are needed. pack : how many one price buys.
    price_USD : of a pack, None where one must ask; priced says when, price_source where from, or "estimate".
    alternatives : other parts that serve. note : what to look out for.
    """

    role: str
    group: str
    maker: str
    part_number: str
    count: int
    price_USD: float | None
    priced: date
    price_source: str = "estimate"
    pack: int = 1
    alternatives: tuple[str, ...] = ()
    note: str = ""

    def __post_init__(self) -> None:
        if self.group not in GROUPS:
            raise ModelError(f"{self.role}: group must be one of {', '.join(GROUPS)}, got {self.group}")
        if self.count < 1 or self.pack < 1 or (self.price_USD or 0.0) < 0:
            raise ModelError(f"{self.role}: count and pack from 1, price from 0; got {self}")

    @property
    def packs(self) -> int:
        """How many packs to buy."""
        return -(-self.count // self.pack)

    @property
    def total_USD(self) -> float:
        """What they cost; nothing where the price must be asked for."""
        return self.packs * (self.price_USD or 0.0)

    @property
    def asked(self) -> bool:
        """Return whether the price must be asked for."""
        return self.price_USD is None

    @property
    def estimated(self) -> bool:
        """Return whether there is a price that nobody quoted."""
        return not self.asked and self.price_source == "estimate"


@dataclass(frozen=True)
class Bill:
    """All lines, in the order in which they are bought."""

    lines: tuple[BillLine, ...]

    @property
    def total_USD(self) -> float:
        """What everything costs."""
        return sum(line.total_USD for line in self.lines)

    def of(self, *groups: str) -> Bill:
        """Return the lines of some groups only."""
        return Bill(tuple(line for line in self.lines if line.group in groups))

    def rows(self) -> list[dict[str, Any]]:
        """Return every line as plain data with COLUMNS and what else is known."""
        keys = [*COLUMNS, "price_source", "note"]
        return [
            {key: getattr(line, key) for key in keys}
            | {"priced": line.priced.isoformat(), "alternatives": list(line.alternatives)}
            for line in self.lines
        ]


def load_bill(circuit: Circuit, printed: Iterable[Part] | None = None) -> Bill:
    """Return a rig's bill: counts come from its circuit, the plastic from its printed parts.

    Raises InputError if the circuit asks for a role that bill.toml does not have, or the other way round.
    """
    text = resources.files("fdvv_rig").joinpath("bill.toml").read_text("utf-8")
    rig = "recommended" if circuit.has_cell else "paper"
    own = [part for part in PARTS if part.rig in ("", rig)] if printed is None else printed
    return read_bill(text, Counter(part.bill for part in circuit.parts.values()), own, rig)


def read_bill(text: str, needed: Mapping[str, int], printed: Iterable[Part] = (), rig: str = "paper") -> Bill:
    """Read a bill from TOML text.

    needed : count of each electrical role. printed : the printed parts, of which the plastic is counted.
    rig : lines that name another rig are left out.
    Raises InputError if a role is needed that the text does not have, or the other way round.
    """
    document = tomllib.loads(text)
    lines = [_line(raw, needed) for raw in document["lines"] if raw.get("rig", rig) == rig]
    lacking = sorted(set(needed) - {line.role for line in lines})
    if lacking:
        reason = f"the circuit needs {', '.join(lacking)}"
        raise InputError("bill.toml", "lines", reason, "add a line for each")
    return Bill((*lines, *_printed(document.get("printed", {}), printed)))


def _printed(raw: dict[str, Any], printed: Iterable[Part]) -> list[BillLine]:
    return [
        BillLine(
            role=part.name,
            group=raw["group"],
            maker="printed",
            part_number=f"{raw['material']}, {part.mass_g:.1f} g",
            count=part.count,
            price_USD=round(part.mass_g * raw["price_USD_g"], 2),
            priced=raw["priced"],
        )
        for part in printed
    ]


def _line(raw: dict[str, Any], needed: Mapping[str, int]) -> BillLine:
    role, body = raw["role"], {"price_USD": None, **raw}
    body.pop("rig", None)
    if body.pop("circuit", True):
        if role not in needed:
            reason = f"{role} is not in the circuit"
            raise InputError("bill.toml", "lines", reason, "take it out, or say circuit = false and a count")
        body["count"] = needed[role]
    return BillLine(**body | {"alternatives": tuple(raw.get("alternatives", ()))})


def to_csv(bill: Bill) -> str:
    """Write the lines as CSV with a header; alternatives are joined by semicolons."""
    out = io.StringIO()
    columns = [*COLUMNS, "priced", "price_source", "alternatives", "note"]
    writer = csv.DictWriter(out, columns, lineterminator="\n")
    writer.writeheader()
    for row in bill.rows():
        writer.writerow(row | {"alternatives": "; ".join(row["alternatives"])})
    return out.getvalue()


def group_totals(bill: Bill) -> dict[str, float]:
    """Return what every group costs."""
    return {group: bill.of(group).total_USD for group in GROUPS}


def dates(lines: Iterable[BillLine]) -> str:
    """Write the span of the prices' dates."""
    found = sorted({line.priced.isoformat() for line in lines})
    return found[0] if len(found) == 1 else f"{found[0]} to {found[-1]}"


ABOUT = {
    "rig": "the rig: force, position, travel",
    "vibration": "vibration",
    "strip": "the pointing task's LED strip",
    "capture": "the capture bench, without cameras",
}


def bill_page(paper: Bill, recommended: Bill) -> str:
    """Write both rigs' bills as Markdown: a table per group with both counts, totals beside the paper's."""
    counts = [Counter({line.role: line.count for line in bill.lines}) for bill in (paper, recommended)]
    lines = {line.role: line for line in (*paper.lines, *recommended.lines)}
    groups = [(ABOUT[group], [one for one in lines.values() if one.group == group]) for group in GROUPS]
    texts = {"paper": summary(paper), "recommended": summary(recommended)}
    return page("bill.md.j2", summaries=texts, groups=groups, paper=counts[0], recommended=counts[1])


def summary(bill: Bill) -> str:
    """Return the total in a few sentences, beside the paper's."""
    totals = group_totals(bill)
    estimates, asked = (sum(getattr(line, name) for line in bill.lines) for name in ("estimated", "asked"))
    built = totals["rig"] + totals["vibration"]
    lines = [line for line in bill.lines if not line.asked]
    more = f", and {asked} lines without a price: ask for a quotation" if asked else ""
    return (
        f"{bill.total_USD:.0f} USD in all{more}. Rig and vibration, which the paper built for about "
        f"{PAPER_USD:.0f} USD, cost {built:.0f} USD. {estimates} of {len(lines)} prices "
        f"are estimates of {dates(lines)}, without shipping and tax."
    )
