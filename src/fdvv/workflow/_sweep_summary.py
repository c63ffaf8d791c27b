"""What a sweep says at a glance: its first figure by every factor that varies. Simulated."""

from __future__ import annotations

from typing import Any

import numpy as np

from fdvv.workflow._parquet import open_parquet
from fdvv.workflow._sweep import SweepResult
from fdvv.workflow._sweep_plan import REPEAT, Value

MOST_levels = 12
"""A factor with more values is not summed up."""


def sweep_summary(result: SweepResult) -> list[dict[str, Any]]:
    """Give the first figure that is a number by each factor: median, 5 and 95 % of the cells done."""
    plan = result.plan
    figure = next(f.name for f in plan.measured.figures if f.type == "double")
    levels = {name: values for name, values in plan.levels().items() if name != REPEAT}
    factors = [name for name, values in levels.items() if 1 < len(values) <= MOST_levels]
    if not factors:
        factors = [next(iter(levels))]
    found: dict[tuple[str, Value], list[float]] = {}
    opened = open_parquet(result.path)
    try:
        for group in range(opened.num_row_groups):
            lines = opened.read_row_group(group, columns=[*factors, figure]).to_pylist()
            for line in lines:
                if line[figure] is not None:
                    for name in factors:
                        found.setdefault((name, line[name]), []).append(line[figure])
    finally:
        opened.close()
    return [
        {
            "factor": name,
            "figure": figure,
            "rows": [_row(value, found.get((name, value), [])) for value in levels[name][:MOST_levels]],
        }
        for name in factors
    ]


def _row(value: Value, figures: list[float]) -> dict[str, Any]:
    low, median, high = np.percentile(figures, (5, 50, 95)).tolist() if figures else (None, None, None)
    return {"value": value, "cells": len(figures), "median": median, "low": low, "high": high}
