"""Infer what the columns of a foreign table are, from their headings and from what stands in them."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

from fdvv_people.study.analysis.columns import NO, ROLES, YES, ColumnMap, is_missing
from fdvv_people.study.plan.trial import EQUAL

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

TRIALS = ("trial", "trialnumber", "trialno")
"""Headings of the rounds that number trials; the others may number something that holds several."""
PARTS = (
    *("session", "day", "week", "visit", "phase", "stage", "part", "half", "set", "list", "practice", "hand"),
    *(name for role in ("round", "item", "stimulus") for name in NAMES[role]),
)
"""Headings of what divides a study: trials may be numbered anew in each part."""

RATINGS = ("rating", "score", "realism", "quality", "similarity", "likert", "mos", "rate", "value")
"""Headings of a rating where a row is one rating; another column of numbers is one if it is the only one."""

EQUAL_WORDS = frozenset({"same", "tie", "tied", "neither", "both", "no difference", "no preference"})
MOST_STIMULI = 12  # assumed: more words in a column are items rather than stimuli; --map says otherwise
Rows = Sequence[Sequence[str]]


@dataclass(frozen=True)
class RepeatedTrial:
    """Two rows of one trial: their places, the earlier first, and the headings that say which trial it is."""

    first: int
    again: int
    heads: tuple[str, ...]


@dataclass(frozen=True)
class Inferred:
    """A map with what was inferred in it.

    Attributes
    ----------
    guessed : the heading by role, of what nobody had said. unused : headings that serve nothing.
    repeat : two rows of one trial; None if there are none.
    """

    column_map: ColumnMap
    guessed: Mapping[str, str] = field(default_factory=dict)
    unused: tuple[str, ...] = ()
    repeat: RepeatedTrial | None = None


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
    repeat = table.find_repeat()
    table.rounds()
    columns = {**column_map.columns, **table.guessed}
    unused = tuple(head for head in heads if head and head not in table.used)
    return Inferred(replace(column_map, columns=columns, codes=table.codes), table.guessed, unused, repeat)


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
        for head in self._counts():
            if self._pairs(head):
                self.take("round", head)
                return

    def _counts(self) -> list[str]:
        """Return the columns that may count rounds, likeliest first; none where the round is known."""
        named = self.named(NAMES["round"]) if "round" not in self.roles else []
        words = {head: self.words(head) for head in named}
        return [h for h in named if words[h] and all(re.fullmatch(r"\d+(\.0*)?", w) for w in words[h])]

    def _pairs(self, head: str) -> bool:
        """Whether a column tells the trials of a person and item apart and joins what belongs to one."""
        columns = [self.cells(name) for name in (*self._headings("person", "item", "stimulus"), head)]
        keys = Counter(zip(*columns, strict=True))
        if not keys or max(keys.values()) > 1:
            return False
        if "stimulus" not in self.roles:
            return True
        trials = Counter((*key[:-2], key[-1]) for key in keys)
        return max(trials.values()) > 1

    def _headings(self, *roles: str) -> list[str]:
        return [self.roles[role] for role in roles if role in self.roles]

    def find_repeat(self) -> RepeatedTrial | None:
        """Find two rows of one person, item, stimulus and number, in one part of the study.

        What most people have may be no slip: then the numbers are anew in each of another column's words, as
        of a condition, or a number holds several rows.
        """
        counts = self._counts()
        if not counts or "person" not in self.roles:
            return None
        free = [head for head in self.heads if head and head not in self.used and head not in counts]
        parts = [head for head in free if _stem(head) in PARTS]
        trial = [*counts, *self._headings("person", "item", "stimulus"), *parts]
        repeats = self._repeats(trial)
        if self._are_frequent(repeats):
            numbered = any(_plain(head) in TRIALS for head in counts)
            others = [head for head in free if head not in parts and len(self.words(head)) <= MOST_STIMULI]
            longer = [[*trial, head] for head in others if numbered]
            fewest = min(longer, key=lambda key: len(self._repeats(key)), default=trial)
            if not self._are_frequent(self._repeats(fewest)):
                repeats, trial = self._repeats(fewest), fewest
            elif self._are_designed(repeats, numbered):
                return None
        return RepeatedTrial(*repeats[0], tuple(trial)) if repeats else None

    def _repeats(self, key: Sequence[str]) -> list[tuple[int, int]]:
        """Return the places of rows that agree with an earlier one, after its place; key[0] numbers rows."""
        first: dict[tuple[str, ...], int] = {}
        rows = enumerate(zip(*map(self.cells, (*key, *self._headings("excluded"))), strict=True))
        found = [(first.setdefault(cells, place), place) for place, cells in rows if cells[0]]
        return [(before, place) for before, place in found if before != place]

    def _are_frequent(self, repeats: Sequence[tuple[int, int]]) -> bool:
        """Whether most people have repeats."""
        people = self.cells(self.roles["person"])
        return 2 * len({people[place] for _, place in repeats}) > len(set(people))

    def _are_designed(self, repeats: Sequence[tuple[int, int]], numbered: bool) -> bool:
        """Whether a number holds several rows: no copies, and in most trials if it is called a trial's."""
        trials, several = len(self.rows) - len(repeats), len({before for before, _ in repeats})
        copied = all(self.rows[before] == self.rows[place] for before, place in repeats)
        return not copied and (not numbered or 2 * several > trials)


def _plain(head: str) -> str:
    return re.sub(r"[^a-z0-9]", "", head.lower())


def _stem(head: str) -> str:
    """Return a heading as _plain does, without the word for a number at its end."""
    return re.sub(r"(?<=.)(id|no|nr|num|number|index)$", "", _plain(head))


def _parted(head: str) -> tuple[str, str, str]:
    """Part RATING_STIMULUS at its last mark; the mark is "" where it has none."""
    found = re.fullmatch(r"(.+)([_.: -])([^_.: -]+)", head)
    return (found[1], found[2], found[3]) if found else (head, "", "")
