"""Run a sweep in a folder, and summarise its results. Simulated."""

from __future__ import annotations

import hashlib
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np

from fdvv.errors import InputError
from fdvv.eventlog import Journal
from fdvv.io.documents import pretty
from fdvv.io.files import require_new_folder, write_atomic
from fdvv.io.part_store import PartStore, need_parquet
from fdvv.model.file import model_to_json
from fdvv.model.model import FDVVModel
from fdvv.parallel.campaign import Progress, run_campaign
from fdvv.parallel.executor import DEADLY, Executor
from fdvv.twin.files import OLD_RIG_NAMES, button_to_toml, finger_to_toml, rig_to_toml
from fdvv_campaigns.sweep.plan import REPEAT, Row, SweepPlan, SweepWork, Value, sweep_schema, sweep_work
from fdvv_people.optimize.population.plan import seed_of

if TYPE_CHECKING:
    from pyarrow import Table

PLAN_FILE, RESULTS, LOCK = "sweep.json", "results.parquet", ".lock"
CHUNK_s = 0.5
"""Least duration of a chunk: a killed process repeats at most so much."""
TIMED = 3
"""Cells that a preview tries."""
MOST_levels = 12
"""A factor with more values is left out of the summary."""
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
        """Return the report of ``fdvv sweep --json``."""
        return {
            "measure": self.plan.measure,
            "simulated": True,
            "cells": self.cells,
            "failed": self.failed,
            "worked": self.worked,
            "results": str(self.path),
            "factors": {name: list(values) for name, values in self.plan.levels().items()},
        }

    def first_reason(self) -> str | None:
        """Return the reason of the first cell that failed; None if none did."""
        return next((reason for reason in self.table().column("reason").to_pylist() if reason), None)

    def table(self, columns: Sequence[str] | None = None) -> Table:
        """Read the rows, all columns or those named, as a pyarrow.Table."""
        import pyarrow.parquet as pq

        return pq.read_table(self.path, columns=columns)


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
        return (self.cells - self.done) * self.cell_s / processes


def run_sweep(
    plan: SweepPlan,
    folder: Path,
    executor: Executor,
    progress: Progress = lambda _done, _total: None,
    beside: Path = Path(),
    work: Callable[[tuple[Cell, ...]], list[Row]] | None = None,
) -> SweepResult:
    """Run every cell of a plan, in a folder that is new or holds the same sweep; done cells are kept.

    beside : the folder that files of the plan are relative to. work : what is done to a chunk of cells.
    An interrupted sweep is continued by the same call; its final file is the same however it was run.
    Raises InputError on a plan that cannot be carried out, on a folder of another sweep or one in use;
    BuildError without the extra `sweep`; WorkerError; OSError.
    """
    need_parquet()
    import pyarrow as pa

    opened = sweep_work(plan, beside)
    folder = Path(folder)
    _begin(folder, plan, opened)
    schema = sweep_schema(plan)

    def failure_row(cell: Cell) -> Row:
        seed = seed_of(plan.seed, int(cell[1][REPEAT]))
        return {"cell": cell[0], **cell[1], "state": "failed", "reason": DEADLY, "seed": seed}

    def keep(_cells: tuple[Cell, ...], rows: list[Row]) -> None:
        full = [{**row, "measure": plan.measure, "simulated": True} for row in rows]
        store.add(pa.Table.from_pylist(full, schema))

    busy = InputError(folder, "folder", "another process is at work in it", "wait for it")
    with Journal(folder / LOCK, busy):
        store = PartStore(folder / RESULTS, schema, ("cell",))
        worked = run_campaign(
            executor,
            work or opened,
            list(enumerate(plan.cells())),
            keep,
            done=lambda cell: (cell[0],) in store,
            progress=progress,
            item_s=plan.measured.about_s,
            chunk_s=CHUNK_s,
            lost=failure_row,
        )
        store.finish([(number,) for number in range(plan.count)])
        states = (state for table in store.tables(["state"]) for state in table.column("state").to_pylist())
        failed = sum(state == "failed" for state in states)
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
    start = time.process_time()
    rows += work(tried)
    cell_s = (time.process_time() - start) / len(tried)
    reasons = dict.fromkeys(row["reason"] for row in rows if row["state"] == "failed")
    return SweepPreview(plan.count, done, cell_s, tuple(reasons))


def _begin(folder: Path, plan: SweepPlan, work: SweepWork) -> None:
    """Write the plan into a new folder, or check that the folder holds the same one."""
    path = folder / PLAN_FILE
    record = {**msgspec.to_builtins(plan), "settings": dict(work.settings), "sha256": _digests(work)}
    if not path.exists():
        require_new_folder(folder, "name a new one, or that of the same sweep")
        write_atomic(path, pretty(record) + "\n")
        return
    try:
        stored = msgspec.json.decode(path.read_bytes(), type=dict[str, Any])
    except msgspec.MsgspecError as error:
        raise InputError(path, "whole file", f"is damaged ({error})", "name a new folder") from error
    stored["sha256"] = _update_names(stored.get("sha256", {}), record["sha256"])
    other = [name for name in {**record, **stored} if stored.get(name) != record.get(name)]
    if other:
        reason = f"holds a sweep with other {', '.join(name.replace('sha256', 'files') for name in other)}"
        raise InputError(folder, "folder", reason, "give the same plan to go on, or name a new folder")


def _update_names(stored: dict[str, str], wanted: dict[str, str]) -> dict[str, str]:
    """Return digests with the present name of a rig that an older plan left out."""
    digests = dict(stored)
    for old, name in OLD_RIG_NAMES.items():
        if f"rig {name}" in wanted and f"rig {old}" in digests:
            digests[f"rig {name}"] = digests.pop(f"rig {old}")
    return digests


def _digests(work: SweepWork) -> dict[str, str]:
    """Return the SHA-256 of the rigs, fingers and buttons of a sweep, each under its name."""
    texts: dict[str, str] = {f"rig {name}": rig_to_toml(rig) for name, rig in work.rigs.items()}
    texts |= {f"finger {name}": finger_to_toml(finger) for name, finger in work.fingers.items()}
    texts |= {
        f"button {name}": model_to_json(button) if isinstance(button, FDVVModel) else button_to_toml(button)
        for name, button in work.buttons.items()
    }
    return {name: hashlib.sha256(text.encode()).hexdigest() for name, text in texts.items()}


def sweep_summary(result: SweepResult) -> list[dict[str, Any]]:
    """Return the first numeric figure by each factor that varies: median, 5 and 95 % over the cells done."""
    plan = result.plan
    figure = next(f.name for f in plan.measured.figures if f.type == "double")
    levels = {name: values for name, values in plan.levels().items() if name != REPEAT}
    factors = [name for name, values in levels.items() if 1 < len(values) <= MOST_levels]
    if not factors:
        factors = [next(iter(levels))]
    by_level: dict[tuple[str, Value], list[float]] = {}
    for batch in result.table([*factors, figure]).to_batches():
        for line in batch.to_pylist():
            if line[figure] is not None:
                for name in factors:
                    by_level.setdefault((name, line[name]), []).append(line[figure])
    return [
        {
            "factor": name,
            "figure": figure,
            "rows": [_row(value, by_level.get((name, value), [])) for value in levels[name][:MOST_levels]],
        }
        for name in factors
    ]


def _row(value: Value, figures: list[float]) -> dict[str, Any]:
    low, median, high = np.percentile(figures, (5, 50, 95)).tolist() if figures else (None, None, None)
    return {"value": value, "cells": len(figures), "median": median, "low": low, "high": high}
