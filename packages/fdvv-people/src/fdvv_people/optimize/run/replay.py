"""Whether a run can be computed again: every suggestion anew, from what was known then."""

from __future__ import annotations

from pathlib import Path

from fdvv_people.optimize.problem import Trial
from fdvv_people.optimize.run.ledger import LEDGER_FILE, Ledger, steps_before
from fdvv_people.optimize.run.setup import SETUP_FILE, read_setup
from fdvv_people.optimize.run.state import RunState


def replay_differences(folder: Path) -> tuple[Trial, ...]:
    """Suggest everything in a run anew, from what was known then; return what differs.

    None on the machine and the versions that a run was made with. InputError, OSError.
    """
    folder = Path(folder)
    run = RunState(folder, read_setup(folder / SETUP_FILE), Ledger())
    return tuple(
        trial
        for before, trial in steps_before(folder / LEDGER_FILE)
        # what a person or the retest brought in no engine suggests
        if run.name_origin(trial).origin == run.engine.name
        and tuple(run.engine.suggest(run.problem, before)) != trial.designs
    )
