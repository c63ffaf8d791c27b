"""fdvv fit."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fdvv.cli import ui
from fdvv.force_text import ForceTitle, force_text

if TYPE_CHECKING:
    from fdvv.button.fit import FitSettings, FolderFit, ModelFit


def _control_points(_ctx: click.Context, _param: click.Parameter, value: str) -> int | None:
    if value == "auto":
        return None
    try:
        count = int(value)
    except ValueError:
        raise click.BadParameter(f"{value!r} is neither a number nor 'auto'") from None
    if not 4 <= count <= 64:
        raise click.BadParameter(f"{count} is not between 4 and 64")
    return count


@click.command()
@click.argument("path", type=ui.EXISTING)
@ui.choice_option("--method", ("adaptive", "uniform"), help="Knots where needed, or the paper's equal spans.")
@ui.option(
    "--control-points",
    callback=_control_points,
    default="auto",
    help="Per curve, 4 to 64; 'auto' lets BIC* choose and keeps the bump, 15 is the paper's.",
)
@ui.option("--degree", type=click.IntRange(1, 3), help="Of the spline; 2 for adaptive, 3 for uniform knots.")
@ui.option(
    "--smoothing-mm",
    type=ui.Finite(min=0, max=5),
    default=0.0,
    help="Sigma of a Gaussian before the fit; errors are against the raw curve.",
)
@ui.option("--accept-implausible", is_flag=True, help="Fit also what cannot be a button's force and travel.")
@ui.option("-o", "--output", type=ui.PATH, help="Where to write the model (a folder's models: a folder).")
@ui.option(
    "--max-rmse-cN", "max_rmse_cN", type=ui.Force(min=0), help="Exit status 1 above this error of a curve."
)
@ui.json_option
def fit(
    path: Path, method: str, output: Path | None, max_rmse_cN: float | None, as_json: bool, **options: Any
) -> None:
    """Fit measured force curves: one file, or every file of a folder.

    PATH is a file in any known format (docs/reference/force-files.md) or a folder of them. The report
    tells the error against the raw curve, how much of the bump is kept, and what was repaired.
    """
    from fdvv.button.fit import FitSettings
    from fdvv.model.fit import FitMethod

    settings = FitSettings(FitMethod(method), **options)
    worst, where = (_folder if path.is_dir() else _file)(path, settings, output, as_json)
    if max_rmse_cN is not None and worst > max_rmse_cN:
        reason = f"RMSE of {force_text(worst, '.3f')} exceeds the bound of {force_text(max_rmse_cN)}"
        raise ui.failed(f"{ui.one_line(where)}: {reason}")


def _file(path: Path, settings: FitSettings, output: Path | None, as_json: bool) -> tuple[float, str]:
    from fdvv.button.fit import fit_file
    from fdvv.model.file import MODEL_SUFFIX, save_model

    ui.check_output(output, MODEL_SUFFIX)
    if output and output.exists() and output.samefile(path):
        raise click.UsageError(f"{output} is the measurement itself; give the model another name")
    found = fit_file(path, settings)
    if output:
        save_model(found.model, output)
    if as_json:
        ui.print_json(found.to_dict())
    else:
        _print_fit(found)
        ui.print_written(output)
        if output is None:
            click.echo(f"nothing was saved; add -o NAME{MODEL_SUFFIX} to keep the model")
    worst = max(found.fits, key=lambda f: f.rmse_cN)
    return worst.rmse_cN, f"{path}, {worst.curve.stroke}"


def _print_fit(found: ModelFit) -> None:
    click.echo(f"{ui.one_line(found.model.name)}: {found.model.provenance.method}")
    ui.print_table(
        ["curve", ForceTitle("RMSE {}", 3), ForceTitle("max {}"), "points", "bump kept", "ms"],
        [
            [
                f"{f.curve.stroke}" + (f" {f.curve.velocity_mm_s:g} mm/s" if f.curve.velocity_mm_s else ""),
                *(f.rmse_cN, f.max_cN, f.curve.control_points_cN.size),
                *(ui.bump_kept(f.bump_kept_ratio), 1e3 * f.time_s),
            ]
            for f in found.fits
        ],
        digits={"ms": 1},
    )
    ui.print_warnings(found.warnings)


def _folder(path: Path, settings: FitSettings, output: Path | None, as_json: bool) -> tuple[float, str]:
    from fdvv.button.fit import fit_files, measured_files, summarise
    from fdvv.model.file import MODEL_SUFFIX, save_model

    if output:
        ui.check_folder(output)
    results = []
    files = measured_files(path)
    with ui.progress("fitting", len(files)) as advance:
        for result in fit_files(files, settings):
            results.append(result)
            advance(len(results), len(files))
            if output and result.fit:
                relative = result.file.relative_to(path)
                save_model(result.fit.model, output / relative.with_name(relative.name + MODEL_SUFFIX))
    summary = summarise(results)
    if as_json:
        fitted = [{"file": str(r.file), **r.fit.to_dict()} for r in results if r.fit]
        refused = [{"file": str(r.file), "reason": r.reason} for r in results if not r.fit]
        ui.print_json({"results": fitted, "refused": refused, "summary": summary})
    else:
        _print_folder(results, summary)
        if output:
            click.echo(f"{ui.counted(len(files) - summary['refused'], 'model')} written below {output}")
        else:
            click.echo("nothing was saved; add -o FOLDER to keep the models")
    if summary["refused"] == len(files):
        raise ui.failed(f"{path}: no file of it could be fitted; the reasons are above", 2)
    return max((f.rmse_cN, str(r.file)) for r in results if r.fit for f in r.fit.fits)


def _print_folder(results: list[FolderFit], summary: dict[str, Any]) -> None:
    for result in results:
        if not result.fit:
            ui.print_stderr(f"refused: {ui.one_line(result.reason)}")
            continue
        ui.print_warnings([f"{result.file.name}: {w}" for w in result.fit.warnings])
    click.echo(f"{ui.counted(summary['files'], 'file')}, {summary['refused']} refused")
    ui.print_table(
        ["stroke", ForceTitle("RMSE {} median", 3), ForceTitle("90 %", 3), "ms median", "90 %"],
        [
            [
                stroke,
                *s["rmse_cN"].values(),
                *(ui.number(1e3 * value, 1) for value in s["time_s"].values()),
            ]
            for stroke, s in summary["strokes"].items()
        ],
    )
    if summary["bumps"]:
        click.echo(f"{summary['bumps_kept']} of {summary['bumps']} bumps kept to 95 % or more")
