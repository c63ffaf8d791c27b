"""Fit a folder of force curves, and sum up how well that went."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from fdvv.capture import find_force_files
from fdvv.errors import FdvvError, InputError
from fdvv.model import BUMP_KEPT_ratio, Stroke
from fdvv.workflow._fit import FitSettings, ModelFit, fit_file
from fdvv.workflow._kind import own_kind


@dataclass(frozen=True, eq=False)
class FolderFit:
    """What became of one file of a folder: a fit, or the reason why not."""

    file: Path
    fit: ModelFit | None
    reason: str = ""


def measured_files(folder: Path) -> list[Path]:
    """List the files below a folder that may hold measured curves, in order; fdvv's own are passed over.

    Raises InputError if there is none.
    """
    files = [path for path in find_force_files(folder) if not own_kind(path)]
    if not files:
        raise InputError(
            folder, "folder", "no .csv, .ods, .json or .txt file of measurements in it", "name another folder"
        )
    return files


def fit_folder(
    folder: Path, settings: FitSettings | None = None, workers: int | None = None
) -> Iterator[FolderFit]:
    """Fit the measured_files of a folder, as fit_files does. Raises InputError if there is none."""
    yield from fit_files(measured_files(folder), settings, workers)


def fit_files(
    files: Sequence[Path], settings: FitSettings | None = None, workers: int | None = None
) -> Iterator[FolderFit]:
    """Fit files of force curves, in order; a refused file yields its reason.

    The compiled fits release the interpreter lock, so threads share the cores.
    """

    def one(path: Path) -> FolderFit:
        try:
            return FolderFit(path, fit_file(path, settings))
        except FdvvError as error:
            return FolderFit(path, None, str(error))

    with ThreadPoolExecutor(workers or os.cpu_count() or 1) as pool:
        yield from pool.map(one, files)


@dataclass(frozen=True)
class FolderSummary:
    """The spread of a folder's fits, per stroke.

    Attributes
    ----------
    rmse_cN, rows_rmse_cN, time_s : (median, 90th percentile) by stroke.
    bumps, bumps_kept : strokes with a bump, and those of which at least 95 % was kept.
    """

    files: int
    refused: int
    rmse_cN: dict[str, tuple[float, float]] = field(default_factory=dict)
    rows_rmse_cN: dict[str, tuple[float, float]] = field(default_factory=dict)
    time_s: dict[str, tuple[float, float]] = field(default_factory=dict)
    bumps: int = 0
    bumps_kept: int = 0

    def to_dict(self) -> dict[str, Any]:
        """Give the summary of ``fdvv fit FOLDER --json``."""
        strokes = {
            stroke: {
                "rmse_cN": {"median": self.rmse_cN[stroke][0], "p90": self.rmse_cN[stroke][1]},
                "rows_rmse_cN": {"median": self.rows_rmse_cN[stroke][0], "p90": self.rows_rmse_cN[stroke][1]},
                "time_s": {"median": self.time_s[stroke][0], "p90": self.time_s[stroke][1]},
            }
            for stroke in self.rmse_cN
        }
        counts = {"files": self.files, "refused": self.refused}
        return {**counts, "bumps": self.bumps, "bumps_kept": self.bumps_kept, "strokes": strokes}


def summarise(results: Sequence[FolderFit]) -> FolderSummary:
    """Sum up a folder: medians and 90th percentiles per stroke, bumps kept."""
    fits = [f for r in results if r.fit for f in r.fit.fits]
    kept = [f.bump_kept_ratio for f in fits if f.bump_kept_ratio is not None]

    def spread(attribute: str) -> dict[str, tuple[float, float]]:
        found: dict[str, tuple[float, float]] = {}
        for stroke in Stroke:
            values = [getattr(f, attribute) for f in fits if f.curve.stroke is stroke]
            if values:
                found[str(stroke)] = (float(np.median(values)), float(np.percentile(values, 90)))
        return found

    return FolderSummary(
        files=len(results),
        refused=sum(r.fit is None for r in results),
        rmse_cN=spread("rmse_cN"),
        rows_rmse_cN=spread("rows_rmse_cN"),
        time_s=spread("time_s"),
        bumps=len(kept),
        bumps_kept=sum(ratio >= BUMP_KEPT_ratio for ratio in kept),
    )
