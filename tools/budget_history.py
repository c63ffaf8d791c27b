"""Who raised a limit: a commit may raise limits if it touches ``budget.toml`` alone."""

from __future__ import annotations

import subprocess
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from tools.budget_file import Limits, Row, find_raises, parse_limits

NAME = "budget.toml"
WORKING_TREE = "the working tree"
MOST_COMMITS = 20
"""As many of the commits that touch the budget are looked at, the newest ones."""


class NoHistoryError(Exception):
    """There is no history to look at; the text says why."""


@dataclass(frozen=True)
class Change:
    """A commit that touches the budget, or the working tree; ``alone`` if it touches nothing else."""

    title: str
    old: Limits
    new: Limits
    alone: bool


def refuse_raises(root: Path) -> list[str]:
    """Return a line for each limit that was raised beside other files and is still that high.

    A later commit that raises the same limit, alone, mends it.

    Raises
    ------
    NoHistoryError : git is missing, or this is no whole repository with a commit.
    """
    if _git(root, "rev-parse", "--is-shallow-repository").strip() == "true":
        raise NoHistoryError("the clone is shallow")
    current = _parse((root / NAME).read_text(encoding="utf-8"))
    refused: list[str] = []
    mended: set[Row] = set()
    for change in _changes(root, current):
        raises = find_raises(change.old, change.new)
        if change.alone:
            mended.update(raises)
            continue
        standing = [row for row in raises if current.get(row, 0) > change.old.get(row, 0)]
        refused += [_refusal(row, change) for row in standing if row not in mended]
    return refused


def _refusal(row: Row, change: Change) -> str:
    before = "" if change.title == WORKING_TREE else "put it back, then "
    return (
        f"{NAME}: {row} raised from {change.old.get(row, 0):,} to {change.new[row]:,} beside other files in "
        f"{change.title}; {before}raise it in a commit of {NAME} alone that names what came in and what went "
        "out"
    )


def _changes(root: Path, current: Limits) -> Iterator[Change]:
    """Yield the working tree, then the commits, the newest first."""
    if head := _limits_in(root, "HEAD"):
        others = [line for line in _git(root, "status", "--porcelain").splitlines() if line[3:] != NAME]
        yield Change(WORKING_TREE, head, current, alone=not others)
    log = _git(
        root,
        *("-c", "log.showSignature=false", "log", "--topo-order", f"--max-count={MOST_COMMITS}"),
        *("--full-diff", "--name-only", "--format=%x00%h %p", "--", NAME),
    )
    for entry in log.split("\0")[1:]:
        hashes, *names = entry.split("\n")
        commit, *parents = hashes.split()
        if old := _best_of([_limits_in(root, parent) for parent in parents]):
            yield Change(commit, old, _limits_in(root, commit), alone=set(filter(None, names)) == {NAME})


def _best_of(parents: list[Limits]) -> Limits:
    """Return the highest limit of each row: a merge raises what no parent had."""
    return {row: max(limits.get(row, 0) for limits in parents) for limits in parents for row in limits}


def _limits_in(root: Path, commit: str) -> Limits:
    """Return the limits in a commit; none where it has no budget that can be read."""
    try:
        return _parse(_git(root, "show", f"{commit}:./{NAME}"))
    except (NoHistoryError, ValueError, KeyError):
        return {}


@cache
def _parse(text: str) -> Limits:
    return parse_limits(tomllib.loads(text))


def _git(root: Path, *arguments: str) -> str:
    try:
        done = subprocess.run(
            ["git", *arguments], cwd=root, capture_output=True, text=True, encoding="utf-8", check=True
        )
    except OSError as error:
        raise NoHistoryError(f"git does not run: {error}") from error
    except subprocess.CalledProcessError as error:
        raise NoHistoryError(error.stderr.removeprefix("fatal: ").partition("\n")[0]) from error
    return done.stdout
