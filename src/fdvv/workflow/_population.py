"""Run a population in a folder: chunks on an executor, each on the disk before it counts. Simulated."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import msgspec
import numpy as np

from fdvv.columns import pack_column, unpack_column
from fdvv.errors import InputError
from fdvv.files import write_atomic
from fdvv.journal import Journal, JournalKind, read_records
from fdvv.optimize import Trial
from fdvv.units import FloatArray
from fdvv.workflow._executor import Executor
from fdvv.workflow._population_plan import PLAN_FILE, PopulationPlan, plan_text, read_plan
from fdvv.workflow._population_result import PopulationResult, write_result
from fdvv.workflow._population_work import PopulationWork

CHUNKS_FILE = "chunks.jsonl"
PRIOR_FILE = "prior.json"
REMEDY = "take the folder from a copy, or begin anew in another one"
KIND = JournalKind(frozenset({"chunk"}), REMEDY)

Progress = Callable[[int, int], None]
"""Is told how many chunks are done, and of how many."""


class ChunkRecord(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A chunk's columns on file, see fdvv.columns."""

    number: int
    columns: dict[str, str]


def run_population(
    folder: Path,
    plan: PopulationPlan,
    executor: Executor,
    prior: Sequence[Trial] = (),
    progress: Progress = lambda _done, _whole: None,
) -> PopulationResult:
    """Work on a plan's chunks in a folder that is new or holds the same plan; done chunks are kept.

    prior : finished trials that every person's engine begins from, as PopulationResult.prior gives them.

    Writes ``population.npz`` and ``summary.json`` when all is done. Whatever ends it before, the same call
    goes on. InputError on a folder of another run, or one at work elsewhere; WorkerError.
    """
    folder = Path(folder)
    _begin(folder, plan, tuple(prior))
    busy = InputError(folder, "folder", "another process is at work in it", "wait for it, or end it")
    journal = Journal(folder / CHUNKS_FILE, busy)
    try:
        done, end = _done(folder / CHUNKS_FILE, plan)
        journal.cut(end)
        _work(plan, PopulationWork(plan, tuple(prior)), executor, journal, done, progress)
    finally:
        journal.close()
    result = PopulationResult.of(plan, done)
    write_result(folder, result)
    return result


def _begin(folder: Path, plan: PopulationPlan, prior: tuple[Trial, ...]) -> None:
    """Write the plan into a new folder, or find the same one in it."""
    path, told = folder / PLAN_FILE, msgspec.json.encode(prior)
    if not path.exists():
        if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
            raise InputError(folder, "folder", "is not empty", "name a new one, or that of the same run")
        write_atomic(folder / PRIOR_FILE, told)
        write_atomic(path, plan_text(plan))
        return
    other = read_plan(path).differs(plan)
    if other:
        reason = f"holds a run with other {', '.join(other)}"
        raise InputError(folder, "folder", reason, "give the same options to go on, or name a new folder")
    if (folder / PRIOR_FILE).read_bytes() != told:
        raise InputError(folder, PRIOR_FILE, "the run began from other trials", "name a new folder")


def _done(path: Path, plan: PopulationPlan) -> tuple[dict[int, dict[str, FloatArray]], int]:
    """Read the chunks that are done, and where the last whole one ends."""
    found: dict[int, dict[str, FloatArray]] = {}
    end = 0
    for line, (record, after) in enumerate(read_records(path, KIND), 1):
        try:
            chunk = msgspec.convert(record["chunk"], ChunkRecord)
            columns = {name: unpack_column(text) for name, text in chunk.columns.items()}
            if not 0 <= chunk.number < plan.chunks:
                raise ValueError(f"there is no chunk {chunk.number}")
        except ValueError as error:  # of msgspec's too
            raise InputError(path, f"line {line}", str(error), REMEDY) from error
        found[chunk.number], end = columns, after
    return found, end


def _work(
    plan: PopulationPlan,
    work: PopulationWork,
    executor: Executor,
    journal: Journal,
    done: dict[int, dict[str, FloatArray]],
    progress: Progress,
) -> None:
    """Work on what is left; done is added to."""
    left = [number for number in range(plan.chunks) if number not in done]
    progress(len(done), plan.chunks)
    for place, columns in executor.run(work, left):
        packed = {name: pack_column(np.asarray(column)) for name, column in columns.items()}
        journal.write({"chunk": msgspec.to_builtins(ChunkRecord(left[place], packed))})
        done[left[place]] = columns
        progress(len(done), plan.chunks)
