"""Which design of a front is recommended: a person's own choice, else by weights, else the knee."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import msgspec

from fdvv.errors import InputError
from fdvv.io.documents import Kind, pretty, read_record
from fdvv.io.files import write_atomic
from fdvv_people.optimize.engines.multi_objective import ParetoFront
from fdvv_people.optimize.problem import Trial
from fdvv_people.optimize.run.setup import OptimizeSetup

COMPROMISE_FILE = "compromise.json"
KIND = Kind("fdvv-compromise", 1, "a chosen compromise", "delete the file; the run recommends one itself")
LARGEST_bytes = 10_000  # it holds the number of a trial in under 100 bytes; what is larger is another file


class Chosen(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """The trial whose design a person took from the front. trial : its number."""

    format: Literal["fdvv-compromise"] = "fdvv-compromise"
    version: Literal[1] = 1
    trial: int


def recommended_of(front: ParetoFront, setup: OptimizeSetup, folder: Path) -> Trial:
    """Return the recommended trial of a front. ModelError on an empty one, InputError on a damaged file."""
    path = folder / COMPROMISE_FILE
    if path.exists():
        number = read_record(path, KIND, Chosen, LARGEST_bytes).trial
        if found := next((one for one in front.trials if one.number == number), None):
            return found
    return front.weighted(setup.weights) if setup.weights else front.knee()


def keep_choice(front: ParetoFront, number: int, folder: Path) -> Trial:
    """Write down that a person takes a trial of the front. InputError where it is none of it, OSError."""
    found = next((one for one in front.trials if one.number == number), None)
    if found is None:
        remedy = f"take one of {', '.join(str(one.number) for one in front.trials) or 'a later front'}"
        raise InputError("compromise", f"trial {number}", "is not on the front", remedy)
    write_atomic(folder / COMPROMISE_FILE, pretty(msgspec.to_builtins(Chosen(trial=number))) + "\n")
    return found
