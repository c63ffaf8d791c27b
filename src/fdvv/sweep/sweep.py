"""Run a sweep in a folder: chunks on an executor, each on the disk before it counts. Simulated."""

from __future__ import annotations

import hashlib
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec

from fdvv.documents import pretty
from fdvv.errors import InputError
from fdvv.files import write_atomic
from fdvv.journal import Journal
from fdvv.model import FDVVModel, model_to_json
from fdvv.twin import button_to_toml, finger_to_toml, rig_to_toml
from fdvv.workflow._executor import Executor, chunks_of
from fdvv.workflow._isolated import DEADLY, run_isolated
from fdvv.workflow._parquet import need_parquet
from fdvv.workflow._part_store import PartStore
from fdvv.workflow._population_plan import seed_of
from fdvv.workflow._sweep_columns import sweep_schema
from fdvv.workflow._sweep_plan import REPEAT, SweepPlan, Value
from fdvv.workflow._sweep_work import Row, SweepWork, sweep_work

if TYPE_CHECKING:
    from pyarrow import Table

PLAN_FILE, RESULTS, LOCK = "sweep.json", "results.parquet", ".lock"
CHUNK_s = 0.5
"""What a chunk takes at least: a killed process does so much again."""
TIMED = 3
"""Cells that a preview tries."""

Progress = Callable[[int, int], None]
"""Is told how many cells are done, and of how many."""
Cell = tuple[int, dict[str, Value]]


@dataclass(frozen=True, eq=False)
class SweepResult:
    """What a sweep found.

    Attributes
    ----------
    cells, failed : how many. worked : how many this run did; the others were done before.
    path : the Parquet file with a row for every cell, see sweep_schema.
    """

    plan: SweepPlan
    path: Path
    cells: int
    failed: int
    worked: int

    def to_dict(self) -> dict[str, Any]:
        """Give the report of ``fdvv sweep --json``."""
        counts = {"cells": self.cells, "failed": self.failed, "worked": self.worked}
        return {
            "measure": self.plan.measure,
            "simulated": True,
            **counts,
            "results": str(self.path),
            "factors": {name: list(values) for name, values in self.plan.levels().items()},
        }

    def first_reason(self) -> str | None:
        """Give the reason of the first cell that failed; None if none did."""
        return next((reason for reason in self.table().column("reason").to_pylist() if reason), None)

    def table(self) -> Table:
        """Read the rows, a pyarrow.Table."""
        import pyarrow.parquet as pq

        return pq.read_table(self.path)


@dataclass(frozen=True)
class SweepPreview:
    """What a sweep would take.

    Attributes
    ----------
    cells, done : of the plan, and those that its folder holds already. cell_s : processor time of one.
    failed : reasons of cells that were tried and failed.
    """

    cells: int
    done: int
    cell_s: float
    failed: tuple[str, ...]

    def seconds(self, processes: int) -> float:
        """Estimate how long the rest takes."""
        return (self.cells - self.done) * self.cell_s / processes


def run_sweep(
    plan: SweepPlan,
    folder: Path,
    executor: Executor,
    progress: Progress = lambda _done, _whole: None,
    beside: Path = Path(),
    work: Callable[[tuple[Cell, ...]], list[Row]] | None = None,
) -> SweepResult:
    """Try every cell of a plan, in a folder that is new or holds the same sweep; done cells are kept.

    beside : the folder that files of the plan are named from. work : what is done to a chunk of cells.
    Whatever ends it before, the same call goes on. The file at the end is the same whoever worked on it.
    InputError on a plan that cannot be carried out, on a folder of another sweep or at work elsewhere;
    BuildError without the extra `sweep`; WorkerError; OSError.
    """
    need_parquet()
    opened = sweep_work(plan, beside)
    folder = Path(folder)
    _begin(folder, plan, opened)
    lock = Journal(
        folder / LOCK, InputError(folder, "folder", "another process is at work in it", "wait for it")
    )
    try:
        store = PartStore(folder / RESULTS, sweep_schema(plan), ("cell",))
        worked = _work(plan, store, executor, progress, work or opened)
        store.finish([(number,) for number in range(plan.count)])
        states = (state for table in store.tables(["state"]) for state in table.column("state").to_pylist())
        failed = sum(state == "failed" for state in states)
    finally:
        lock.close()
    return SweepResult(plan, folder / RESULTS, plan.count, failed, worked)


def preview_sweep(plan: SweepPlan, folder: Path | None = None, beside: Path = Path()) -> SweepPreview:
    """Count a plan's cells and time a few of them, spread over the plan, in this process. InputError."""
    work = sweep_work(plan, beside)
    done = 0
    if folder is not None and (folder / PLAN_FILE).exists():
        need_parquet()
        _begin(folder, plan, work)
        done = len(PartStore(folder / RESULTS, sweep_schema(plan), ("cell",), mend=False))
    wanted = {round(i * (plan.count - 1) / max(1, TIMED - 1)) for i in range(TIMED)}
    tried = [(number, cell) for number, cell in enumerate(plan.cells()) if number in wanted]
    rows = work(tried[:1])  # what is loaded and identified once is no part of a cell
    begun = time.process_time()
    rows += work(tried)
    cell_s = (time.process_time() - begun) / len(tried)
    reasons = dict.fromkeys(row["reason"] for row in rows if row["state"] == "failed")
    return SweepPreview(plan.count, done, cell_s, tuple(reasons))


def _work(
    plan: SweepPlan,
    store: PartStore,
    executor: Executor,
    progress: Progress,
    work: Callable[[tuple[Cell, ...]], list[Row]],
) -> int:
    """Work on the cells that are left; tell how many."""
    import pyarrow as pa

    left = [(number, cell) for number, cell in enumerate(plan.cells()) if (number,) not in store]
    done = plan.count - len(left)
    progress(done, plan.count)
    chunks = chunks_of(left, plan.measured.about_s, CHUNK_s)

    def deadly(cell: Cell) -> Row:
        told = {"state": "failed", "reason": DEADLY, "seed": seed_of(plan.seed, int(cell[1][REPEAT]))}
        return {"cell": cell[0], **cell[1], **told}

    for rows in run_isolated(executor, work, chunks, deadly):
        told = [{**row, "measure": plan.measure, "simulated": True} for row in rows]
        store.add(pa.Table.from_pylist(told, sweep_schema(plan)))
        done += len(rows)
        progress(done, plan.count)
    return len(left)


def _begin(folder: Path, plan: SweepPlan, work: SweepWork) -> None:
    """Write the plan into a new folder, or find the same one in it."""
    path = folder / PLAN_FILE
    told = {**msgspec.to_builtins(plan), "settings": dict(work.settings), "sha256": dict(_digests(work))}
    if not path.exists():
        if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
            raise InputError(folder, "folder", "is not empty", "name a new one, or that of the same sweep")
        write_atomic(path, pretty(told) + "\n")
        return
    try:
        kept = msgspec.json.decode(path.read_bytes(), type=dict[str, Any])
    except msgspec.MsgspecError as error:
        raise InputError(path, "whole file", f"is damaged ({error})", "name a new folder") from error
    other = [name for name in {**told, **kept} if kept.get(name) != told.get(name)]
    if other:
        reason = f"holds a sweep with other {', '.join(name.replace('sha256', 'files') for name in other)}"
        raise InputError(folder, "folder", reason, "give the same plan to go on, or name a new folder")


def _digests(work: SweepWork) -> Iterator[tuple[str, str]]:
    """Tell by their content the rigs, fingers and buttons that a sweep was made with."""
    texts: dict[str, str] = {f"rig {name}": rig_to_toml(rig) for name, rig in work.rigs.items()}
    texts |= {f"finger {name}": finger_to_toml(finger) for name, finger in work.fingers.items()}
    for name, button in work.buttons.items():
        text = model_to_json(button) if isinstance(button, FDVVModel) else button_to_toml(button)
        texts[f"button {name}"] = text
    for name, text in texts.items():
        yield name, hashlib.sha256(text.encode()).hexdigest()
