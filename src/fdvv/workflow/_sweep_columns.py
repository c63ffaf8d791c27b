"""The columns of a sweep's results: its factors, then the figures of its measure."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fdvv.workflow._sweep_plan import REPEAT, SweepPlan

if TYPE_CHECKING:
    from pyarrow import Schema

FIRST = (
    ("cell", "int64", "number of the cell, the last factor changing fastest"),
    ("measure", "string", "as in the plan"),
    ("simulated", "bool", "true: every figure comes from the twin"),
)
LAST = (
    ("seed", "int64", "of all that was random; cells of one repeat share it"),
    ("state", "string", "done or failed"),
    ("reason", "string", "why it failed, else null; the figures of a failed cell are null"),
)


def sweep_schema(plan: SweepPlan) -> Schema:
    """Give the schema of a plan's results."""
    import pyarrow as pa

    types = {"int64": pa.int64(), "double": pa.float64(), "string": pa.string(), "bool": pa.bool_()}
    factors = {
        name: "int64" if name == REPEAT else "string" if all(isinstance(v, str) for v in values) else "double"
        for name, values in plan.levels().items()
    }
    figures = [(figure.name, figure.type) for figure in plan.measured.figures]
    first, last = ([(name, kind) for name, kind, _ in told] for told in (FIRST, LAST))
    fields = [*first, *factors.items(), *last, *figures]
    said = {"format": "fdvv-sweep", "version": "1"}
    return pa.schema([(name, types[kind]) for name, kind in fields], metadata=said)
