"""Whether a run can be computed again: every suggestion anew, from what was known then."""

from __future__ import annotations

from pathlib import Path

from fdvv.optimize.problem import Comparison, Line
from fdvv.optimize.run.ledger import LEDGER_FILE, Ledger, Step, Suggested, steps_before
from fdvv.optimize.run.setup import SETUP_FILE, read_setup
from fdvv.optimize.run.state import RunState


def replay_differences(folder: Path) -> tuple[Suggested, ...]:
    """Suggest everything in a run anew, from what was known then; return what differs.

    None on the machine and the versions that a run was made with. InputError, OSError.
    """
    folder = Path(folder)
    replayed = RunState(folder, read_setup(folder / SETUP_FILE), Ledger())
    return tuple(step[-1] for step in steps_before(folder / LEDGER_FILE) if not _agrees(replayed, step))


def _agrees(run: RunState, step: Step) -> bool:
    """Return whether an engine would suggest the same again; what a person brought in always agrees."""
    trials, comparisons, lines, found = step
    if isinstance(found, Line):
        return run.line_engine is None or run.line_engine.line(run.problem, lines) == found.stops
    if isinstance(found, Comparison):
        # past the budget are the blind pairs of the retest, which no engine suggests
        if run.pair_engine is None or len(comparisons) >= run.setup.budget:
            return True
        return run.pair_engine.pair(run.problem, comparisons) == (found.first, found.second)
    if run.engine is None or found.origin != run.engine.name:
        return True
    return run.engine.suggest(run.problem, trials) == [found.design]
