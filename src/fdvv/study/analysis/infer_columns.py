"""Infer what the columns of a foreign table are, from their headings and from what stands in them."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

from fdvv.study.analysis.columns import NO, ROLES, YES, ColumnMap, is_missing
from fdvv.study.plan.trial import EQUAL

NAMES: Mapping[str, tuple[str, ...]] = {
    "person": (
        *("participant", "participantid", "participantnumber", "subject", "subjectid", "subj", "sub"),
        *("observer", "respondent", "user", "userid", "personid", "pid", "ppid", "vp", "id", "who"),
    ),
    "item": ("button", "switch", "keyswitch", "key", "device", "itemid", "sample"),
    "stimulus": ("model", "condition", "rendering", "stim", "version", "system", "method", "variant"),
    "choice": (
        *("preferred", "preference", "prefers", "chosen", "selected", "selection", "winner"),
        *("answer", "response", "prefer"),
    ),
    "correct": ("iscorrect", "right", "accuracy", "hit"),
    "round": ("trial", "trialnumber", "trialno", "block", "repetition", "repeat", "rep", "run"),
    "excluded": ("exclude", "isexcluded", "exclusion"),
}
"""Headings by role, likeliest first, without case, blanks and marks."""

RATINGS = ("rating", "score", "realism", "quality", "similarity", "likert", "mos", "rate", "value")
"""Headings of a rating where a row is one rating; another column of numbers is one if it is the only one."""

EQUAL_WORDS = frozenset({"same", "tie", "tied", "neither", "both", "no difference", "no preference"})
MOST_STIMULI = 12
Rows = Sequence[Sequence[str]]


@dataclass(frozen=True)
class Inferred:
    """A map with what was inferred in it.

    Attributes
    ----------
    guessed : the heading by role, of what nobody had said. unused : headings that serve nothing.
    """

    column_map: ColumnMap
    guessed: Mapping[str, str] = field(default_factory=dict)
    unused: tuple[str, ...] = ()


def infer(heads: Sequence[str], rows: Rows, column_map: ColumnMap) -> Inferred:
    """Complete a map: what is said in it or named like a role stays; the rest follows names and contents.

    A heading such as "trial" is taken for the round only where it pairs the ratings of one trial.
    """
    table = _Table(heads, rows, column_map)
    for role in ("person", "item", "stimulus"):
        table.by_name(role)
    table.long_ratings()
    table.wide_ratings()
    table.choices()
    for role in ("correct", "excluded"):
        table.by_name(role)
    table.rounds()
    columns = {**column_map.columns, **table.guessed}
    unused = tuple(head for head in heads if head and head not in table.used)
    return Inferred(replace(column_map, columns=columns, codes=table.codes), table.guessed, unused)


class _Table:
    """A table whose columns are given roles one by one."""

    def __init__(self, heads: Sequence[str], rows: Rows, column_map: ColumnMap) -> None:
        self.heads, self.rows, self.column_map = heads, rows, column_map
        self.guessed: dict[str, str] = {}
        self.codes = dict(column_map.codes)
        self.roles = {role: role for role in ROLES if role in heads} | dict(column_map.columns)
        self.used = set(self.roles.values())

    @property
    def rated(self) -> bool:
        """Whether somebody said, or it was inferred, which columns hold ratings."""
        return any(role not in ROLES for role in self.roles)

    def take(self, role: str, head: str) -> None:
        self.guessed[role] = self.roles[role] = head
        self.used.add(head)

    def cells(self, head: str) -> list[str]:
        """Return what stands in a column, missing cells as ""."""
        place = self.heads.index(head)
        return ["" if is_missing(row[place], self.column_map) else row[place] for row in self.rows]

    def words(self, head: str) -> set[str]:
        return set(self.cells(head)) - {""}

    def numeric(self, head: str) -> bool:
        words = self.words(head)
        return bool(words) and all(re.fullmatch(r"[-+]?\d*[.,]?\d+(e[-+]?\d+)?", w, re.I) for w in words)

    def named(self, names: Sequence[str]) -> list[str]:
        """Return the unused headings of these names, likeliest first."""
        free = {_plain(head): head for head in self.heads if head and head not in self.used}
        return [free[name] for name in names if name in free]

    def by_name(self, role: str) -> None:
        found = self.named(NAMES[role])
        if role == "stimulus":
            wide = any(":" in rating for rating in self.roles)
            found = [head for head in found if 2 <= len(self.words(head)) <= MOST_STIMULI and not wide]
        if role not in self.roles and found:
            self.take(role, found[0])

    def long_ratings(self) -> None:
        """Where a row is one rating of one stimulus: the column of ratings."""
        if "stimulus" not in self.roles or self.rated:
            return
        named = [head for head in self.named(RATINGS) if self.numeric(head)]
        others = {name for names in NAMES.values() for name in names}
        numbers = [h for h in self.heads if h and h not in self.used and self.numeric(h)]
        numbers = [h for h in numbers if _plain(h) not in others]
        for head in named[:1] or (numbers if len(numbers) == 1 else []):
            self.take(head, head)

    def wide_ratings(self) -> None:
        """Where every stimulus has its own column: RATING_STIMULUS, or the choices' names."""
        if "stimulus" in self.roles or self.rated or self.column_map.stimuli:
            return
        numbers = [h for h in self.heads if h and h not in self.used and self.numeric(h)]
        groups: dict[str, dict[str, str]] = {}
        for head in numbers:
            rating, mark, stimulus = _parted(head)
            if mark:
                groups.setdefault(rating, {})[stimulus] = head
        whole = {rating: by for rating, by in groups.items() if 2 <= len(by) <= MOST_STIMULI}
        if whole and all(set(a) == set(b) for a, b in pairwise(whole.values())):
            for rating, by in whole.items():
                for stimulus in sorted(by):
                    self.take(f"{rating}:{stimulus}", by[stimulus])
            return
        chosen = {w for head in self._choice_columns() for w in self.words(head)}
        same = [head for head in numbers if head in chosen]
        for head in same if len(same) > 1 else []:
            self.take(f"rating:{head}", head)

    def _choice_columns(self) -> list[str]:
        return [self.roles["choice"]] if "choice" in self.roles else self.named(NAMES["choice"])[:1]

    def choices(self) -> None:
        """What was chosen: a name in the row, or whether the row's own stimulus was."""
        for head in self._choice_columns():
            words = self.words(head)
            stimuli = self.words(self.roles["stimulus"]) if "stimulus" in self.roles else set()
            if "choice" not in self.roles and "is_chosen" not in self.roles:
                flag = bool(stimuli and words) and {w.lower() for w in words} <= {*YES, *NO}
                self.take("is_chosen" if flag and not words <= stimuli else "choice", head)
            for word in words - stimuli - set(self.codes):
                if word.lower() in EQUAL_WORDS:
                    self.codes[word] = EQUAL

    def rounds(self) -> None:
        for head in self.named(NAMES["round"]) if "round" not in self.roles else []:
            if all(re.fullmatch(r"\d+(\.0*)?", word) for word in self.words(head)) and self._pairs(head):
                self.take("round", head)
                return

    def _pairs(self, head: str) -> bool:
        """Whether a column tells the trials of a person and item apart and joins what belongs to one."""
        roles = [self.roles[r] for r in ("person", "item", "stimulus") if r in self.roles]
        columns = [self.cells(name) for name in (*roles, head)]
        keys = Counter(zip(*columns, strict=True))
        if not keys or max(keys.values()) > 1:
            return False
        if "stimulus" not in self.roles:
            return True
        trials = Counter((*key[:-2], key[-1]) for key in keys)
        return max(trials.values()) > 1


def _plain(head: str) -> str:
    return re.sub(r"[^a-z0-9]", "", head.lower())


def _parted(head: str) -> tuple[str, str, str]:
    """Part RATING_STIMULUS at its last mark; the mark is "" where it has none."""
    found = re.fullmatch(r"(.+)([_.: -])([^_.: -]+)", head)
    return (found[1], found[2], found[3]) if found else (head, "", "")
