"""Run a population in a folder: chunks on an executor, each on the disk before it counts. Simulated."""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from msgspec import UNSET

from fdvv.errors import InputError, ModelError
from fdvv.eventlog import Journal, JournalKind
from fdvv.io.columns import pack_column, unpack_column
from fdvv.io.documents import pretty
from fdvv.io.files import require_new_folder, write_atomic
from fdvv.parallel.campaign import EachItem, Progress, run_campaign
from fdvv.parallel.executor import Executor
from fdvv.units import FloatArray
from fdvv_people.optimize.population.plan import (
    PLAN_FILE,
    PopulationPlan,
    PopulationWork,
    grid_designs,
    read_plan,
)
from fdvv_people.optimize.problem import Trial, TrialState
from fdvv_people.task.pointing import TemporalPointing
from fdvv_people.task.score import Score

RESULT_FILE, SUMMARY_FILE = "population.npz", "summary.json"
COMPONENTS, FEWEST = 4, 8
"""Principal components of people that a prior holds, and people from whom they can be learned."""


@dataclass(frozen=True, eq=False)
class PopulationResult:
    """What a whole population did.

    Attributes
    ----------
    plan : what was asked. columns : by name, one row per person, or per cell of a grid:
        "optimize": designs (people, budget, d), values (people, budget), best (people, d), judged and
        against (people,); "grid": values and errors (designs * people,), see PopulationPlan.cells.
        Designs are in the unit cube of the space, all else in the objective's unit.
    """

    plan: PopulationPlan
    columns: Mapping[str, FloatArray]

    @property
    def about(self) -> str:
        """What a grid is, in a few words."""
        plan = self.plan
        return f"{plan.designs} designs scored by {plan.people} simulated people, {plan.level}"

    def table(self) -> tuple[FloatArray, FloatArray]:
        """Return scores and errors of a grid, (designs, people) each."""
        if self.plan.kind != "grid":
            raise ModelError(f"a run of kind 'grid' is needed, this one is {self.plan.kind!r}")
        shape = self.plan.designs, self.plan.people
        return self.columns["values"].reshape(shape), self.columns["errors"].reshape(shape)

    def prior(self) -> tuple[Trial, ...]:
        """Return what others may begin from: every design of a grid with its mean over the people.

        The error of a mean is that between people, each taken without their own mean over all designs: how
        well somebody does altogether says nothing of which design is better. How people differ comes as the
        principal components of what is left, which an engine takes as the prior's covariance (Wang et al.,
        Pre-trained Gaussian Processes for Bayesian Optimization, 2021).
        """
        values, _ = self.table()
        people = values.shape[1]
        apart = values - values.mean(axis=0)
        errors = apart.std(axis=1, ddof=1) / np.sqrt(people) if people > 1 else np.zeros(len(values))
        name = TemporalPointing(self.plan.level).objectives[0].name
        components = _components(apart)
        scores = [Score(float(m), float(s) or None) for m, s in zip(values.mean(axis=1), errors, strict=True)]
        return tuple(
            Trial(i, design, TrialState.DONE, {name: score}, None, "", "population", tuple(more) or UNSET)
            for i, (design, score, more) in enumerate(zip(self.designs, scores, components, strict=True))
        )

    @property
    def designs(self) -> tuple[dict[str, float], ...]:
        return grid_designs(self.plan.buttons, self.plan.designs)

    def summary(self) -> dict[str, Any]:
        """Return figures for people and for programs; everything is simulated."""
        head = {"simulated": True, "plan": msgspec.to_builtins(self.plan)}
        if self.plan.kind == "grid":
            means = self.table()[0].mean(axis=1)
            best = int(np.argmin(means))
            found = {"parameters": self.designs[best], "mean_ms": float(means[best])}
            return {**head, "mean_ms": spread_of(means), "best": found}
        judged, against = self.columns["judged"], self.columns["against"]
        return {
            **head,
            "judged_ms": spread_of(judged),
            "against_ms": spread_of(against),
            "gain_percent": spread_of(100 * (1 - judged / against)),
            "better_ratio": float(np.mean(judged < against)),
        }


def _components(scores: FloatArray) -> list[list[float]]:
    """Return by design what each principal component adds, SDs over people; scores are (designs, people)."""
    people = scores.shape[1]
    if people < FEWEST:
        return [[]] * len(scores)
    left, size, _ = np.linalg.svd(scores - scores.mean(axis=1, keepdims=True), full_matrices=False)
    found: list[list[float]] = (left * size / np.sqrt(people - 1))[:, :COMPONENTS].tolist()
    return found


def spread_of(values: FloatArray) -> dict[str, float]:
    """Return median and 5 to 95 % over people or designs."""
    low, middle, high = np.percentile(values, [5, 50, 95])
    return {"median": float(middle), "low": float(low), "high": float(high)}


def _write(folder: Path, result: PopulationResult) -> None:
    buffer = io.BytesIO()
    np.savez_compressed(buffer, allow_pickle=False, **result.columns)
    write_atomic(folder / RESULT_FILE, buffer.getvalue())
    write_atomic(folder / SUMMARY_FILE, pretty(result.summary()) + "\n")


def read_population(folder: Path) -> PopulationResult:
    """Read the result of a finished run. Raises InputError."""
    folder = Path(folder)
    plan, path = read_plan(folder / PLAN_FILE), folder / RESULT_FILE
    try:
        with np.load(path, allow_pickle=False) as file:
            return PopulationResult(plan, {name: file[name] for name in file.files})
    except (OSError, ValueError) as error:
        remedy = "finish the run: give its command again"
        raise InputError(path, "whole file", f"cannot be read ({error})", remedy) from error


CHUNKS_FILE = "chunks.jsonl"
PRIOR_FILE = "prior.json"
REMEDY = "take the folder from a copy, or begin anew in another one"


class ChunkRecord(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A chunk's columns on file, see fdvv.io.columns."""

    number: int
    columns: dict[str, str]


KIND = JournalKind({"chunk": ChunkRecord}, REMEDY)


def run_population(
    folder: Path,
    plan: PopulationPlan,
    executor: Executor,
    prior: Sequence[Trial] = (),
    progress: Progress = lambda _done, _total: None,
) -> PopulationResult:
    """Run a plan in a folder that is new or holds the same plan; an interrupted run is continued.

    prior : finished trials that every person's engine begins from, as PopulationResult.prior returns them.

    Writes ``population.npz`` and ``summary.json`` at the end. Raises InputError on a folder of another run,
    or one in use; WorkerError.
    """
    folder = Path(folder)
    _begin(folder, plan, tuple(prior))
    chunks: dict[int, dict[str, FloatArray]] = {}

    def replay(_key: str, chunk: ChunkRecord) -> None:
        if not 0 <= chunk.number < plan.chunks:
            raise ValueError(f"there is no chunk {chunk.number}")
        chunks[chunk.number] = {name: unpack_column(text) for name, text in chunk.columns.items()}

    def store(numbers: tuple[int, ...], results: list[dict[str, FloatArray]]) -> None:
        for number, columns in zip(numbers, results, strict=True):
            packed = {name: pack_column(np.asarray(column)) for name, column in columns.items()}
            journal.write({"chunk": msgspec.to_builtins(ChunkRecord(number, packed))})
            chunks[number] = columns

    busy = InputError(folder, "folder", "another process is at work in it", "wait for it, or end it")
    work = EachItem(PopulationWork(plan, tuple(prior)))
    with Journal.resume(folder / CHUNKS_FILE, KIND, busy, replay) as journal:
        done = set(chunks).__contains__
        run_campaign(executor, work, range(plan.chunks), store, done=done, progress=progress)
    joined = {name: np.concatenate([chunks[n][name] for n in range(plan.chunks)]) for name in chunks[0]}
    result = PopulationResult(plan, joined)
    _write(folder, result)
    return result


def _begin(folder: Path, plan: PopulationPlan, prior: tuple[Trial, ...]) -> None:
    """Write the plan into a new folder, or check that the folder holds the same one."""
    path, trials = folder / PLAN_FILE, msgspec.json.encode(prior)
    if not path.exists():
        require_new_folder(folder, "name a new one, or that of the same run")
        write_atomic(folder / PRIOR_FILE, trials)
        write_atomic(path, pretty(msgspec.to_builtins(plan)) + "\n")
        return
    other = read_plan(path).differs(plan)
    if other:
        reason = f"holds a run with other {', '.join(other)}"
        raise InputError(folder, "folder", reason, "give the same options to go on, or name a new folder")
    if (folder / PRIOR_FILE).read_bytes() != trials:
        raise InputError(folder, PRIOR_FILE, "the run began from other trials", "name a new folder")
