"""Numbers of a study in words, as a result section writes them."""

from __future__ import annotations

import functools
import math
import tomllib
from collections.abc import Sequence
from importlib import resources
from typing import Any

from fdvv_people.report.prose import listed, p_text
from fdvv_people.stats.rank_tests import SignedRank
from fdvv_people.stats.share import Share
from fdvv_people.stats.thurstone import DPrime
from fdvv_people.study.analysis.records import ALL_BUTTONS, ChoiceResult, Spread

NBSP = "\N{NO-BREAK SPACE}"
MINUS = "\N{MINUS SIGN}"


def many(count: int, one: str, more: str = "") -> str:
    """Write a number of things: 1 person, 12 people."""
    return f"{count}{NBSP}{one if count == 1 else more or one + 's'}"


def people_text(count: int) -> str:
    return many(count, "person", "people")


def fixed(value: float, digits: int = 2) -> str:
    """Write a number with its minus sign; one that is not known is a dash, one without end says so."""
    if math.isnan(value):
        return "–"
    if math.isinf(value):
        return "∞" if value > 0 else f"{MINUS}∞"
    text = f"{value:.{digits}f}"
    return text[1:] if float(text) == 0 and text.startswith("-") else text.replace("-", MINUS)


def percent(share: float, digits: int = 2) -> str:
    return f"{fixed(100 * share, digits)}{NBSP}%"


def span(low: float | None, high: float | None, digits: int = 2, scale: float = 1.0) -> str:
    """Write an interval: [low, high]; nothing where there is none."""
    if low is None or high is None or math.isnan(low) or math.isnan(high):
        return ""
    return f"[{fixed(scale * low, digits)},{NBSP}{fixed(scale * high, digits)}]"


def exact_p(p: float) -> str:
    """Return the text of an exact p, with four digits where it is small."""
    if p < 0.0001:
        return "p < .0001"
    return f"p = {p:.4f}".replace("0.", ".", 1) if p < 0.001 else p_text(p)


def short_p(p: float | None) -> str:
    return "–" if p is None or math.isnan(p) else exact_p(p).removeprefix("p = ").removeprefix("p ")


def test_text(test: SignedRank) -> str:
    """Write a signed-rank test as the paper does, the exact p beside it."""
    if test.n == test.zeros:
        return "everybody rates both alike" if test.n > 1 else "no difference"
    text = (
        f"Z = {fixed(test.z)}, {p_text(test.p_asymptotic)}, exact {exact_p(test.p_exact)}, "
        f"r = {fixed(test.effect)}"
    )
    return unbroken(text)


def unbroken(text: str) -> str:
    """Keep = and < and what is beside them on one line."""
    for sign in "=<":
        text = text.replace(f" {sign} ", f"{NBSP}{sign}{NBSP}")
    return text


def spread_text(one: Spread) -> str:
    """Write median, mean and standard deviation as the paper does."""
    sd = "" if math.isnan(one.sd) else f", SD {fixed(one.sd)}"
    return f"mdn {fixed(one.median)}, mean {fixed(one.mean)}{sd}"


def interval_of(share: Share) -> str:
    """Write the interval of a share, and what it counts."""
    bounds = f"{fixed(100 * share.low, 1)} to {percent(share.high, 1)}"
    counts = "people counted as people" if share.people else "answers counted as independent"
    return f"95{NBSP}% interval {bounds}, {counts}"


def distance_text(one: DPrime) -> str:
    """Write a d' with its interval and, of three answers, what is still called equal."""
    if math.isnan(one.d):
        return "no d′ can be computed"
    tau = "" if one.tau is None or math.isinf(one.tau) else f", τ = {fixed(one.tau)}"
    return f"d′ = {fixed(one.d)} {span(one.low, one.high)}{tau}"


@functools.cache
def report_texts() -> dict[str, Any]:
    """Return the fixed words of a report: tasks, rules, methods; see report.toml."""
    return tomllib.loads(
        resources.files("fdvv_people.study").joinpath("report.toml").read_text(encoding="utf-8")
    )


def rule_text(one: DPrime) -> str:
    return str(report_texts()["rule"].get(one.method, one.method))


def button_name(one: ChoiceResult) -> str:
    return "all buttons" if one.button == ALL_BUTTONS else one.button


def listing(names: Sequence[str], at_most: int = 8) -> str:
    """Join names, the rest of a long list as a number."""
    if not names:
        return "none"
    if len(names) <= at_most:
        return listed(list(names))
    return f"{', '.join(names[:at_most])} and {len(names) - at_most} more"
