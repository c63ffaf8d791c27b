"""fdvv show."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fdvv.cli import ui
from fdvv.cli.options import jnds_option, opened_jnds
from fdvv.errors import InputError
from fdvv.force_text import ForceTitle, force_name, force_number, force_unit
from fdvv.io.documents import ACTUATION, own_kind

if TYPE_CHECKING:
    from fdvv.button.compare import Comparison
    from fdvv.model.landmarks import LandmarkError
    from fdvv.model.model import FDVVModel
    from fdvv.model.noticeable import Jnds

LABEL_WIDTH, NAME_WIDTH = 19, 28
"""Of the names of landmarks, and what the columns of LANDMARKS or TABLE leave for the names of buttons."""

MOST_SENTENCES = 6
"""Of a comparison, one for each button; a folder is a table."""

LANDMARKS = ("travel_mm", "peak_cN", "peak_mm", "snap_ratio", "bottom_out_cN", "work_mJ")
TABLE = ("travel_mm", "actuation_mm", "peak_cN", "peak_mm", "snap_ratio", "bottom_out_cN")


@click.command()
@click.argument("buttons", nargs=-1, required=True)
@ui.velocity_option(help="Compare at this speed, mm/s; default: the slowest.")
@ui.option("--figure", type=ui.PATH, help="Draw the overlay: .svg, .png or .pdf.")
@ui.option("--report", type=ui.PATH, help="Write a page to share: .html with chart, tables and models.")
@jnds_option
@ui.json_option
def compare(
    buttons: tuple[str, ...],
    velocity_mm_s: float | None,
    figure: Path | None,
    report: Path | None,
    jnds_from: Path | None,
    as_json: bool,
) -> None:
    """Compare buttons: landmarks side by side and force differences.

    BUTTONS are two or more built-ins, *.fdvv.json files, files of measured curves or folders of either.
    The first is the reference; displacement counts from each button's contact.
    """
    from fdvv.button.compare import compare as compare_models
    from fdvv.button.open import open_models
    from fdvv.model.curve import Stroke

    ui.check_output(figure, *ui.FIGURES)
    ui.check_output(report, ".html")
    jnds = opened_jnds(jnds_from)
    refused: list[str] = []
    with ui.progress("opening", len(buttons)) as advance:
        opened = open_models(buttons, refused, advance)
    models = [model for model in opened if model.of(Stroke.PRESS)]
    refused += [f"{model.name}: has no press curve" for model in opened if not model.of(Stroke.PRESS)]
    ui.print_warnings([f"refused: {reason}" for reason in refused])
    if len(models) < 2:
        raise click.UsageError(f"two or more buttons with a press are needed, got {len(models)}")
    result = compare_models(models, velocity_mm_s)
    if figure:
        from fdvv.report.model_figures import plot_comparison

        ui.save_figure(plot_comparison(models, velocity_mm_s=velocity_mm_s).figure, figure)
    if report:
        _write_page(report, models, velocity_mm_s, jnds)
    if as_json:
        ui.print_json({**result.to_dict(), "refused": refused})
        return
    if len(models) <= MOST_SENTENCES:
        from fdvv.button.page import counted_in, difference_sentences

        for sentence in (*difference_sentences(models, jnds), counted_in(jnds)):
            ui.print_wrapped(sentence)
        click.echo("")
        _draw(models, velocity_mm_s)
    widths = [
        2 + max(16 if errors else 8, len(name))
        for name, errors in zip(result.names, result.errors, strict=True)
    ]
    if LABEL_WIDTH + sum(widths) <= ui.WIDTH:
        _print_columns(result)
    else:
        _print_lines(result)
    ui.print_written(report)


def _draw(models: Sequence[FDVVModel], velocity_mm_s: float | None) -> None:
    """Draw the curves where standard output is a terminal that can show them."""
    from fdvv.cli.terminal_chart import can_draw, print_curves

    if can_draw():
        print_curves(models, velocity_mm_s)


def _write_page(path: Path, models: Sequence[FDVVModel], velocity_mm_s: float | None, jnds: Jnds) -> None:
    from fdvv.button.page import buttons_page
    from fdvv.report.report import write_report

    write_report(path, buttons_page(models, velocity_mm_s, jnds))


def _print_columns(result: Comparison) -> None:
    pairs = [(m.to_dict(), e) for m, e in zip(result.landmarks, result.errors, strict=True)]
    rows = [
        [force_name(key), *((marks[key], getattr(errors.get(key), "error", None)) for marks, errors in pairs)]
        for key in pairs[0][0]
    ]
    ui.print_table(["landmark", *result.names], rows, digits=dict.fromkeys(result.names, 3))
    if any(result.errors):
        click.echo("±: standard error over presses")
    click.echo("")
    ui.print_table(
        [
            f"force less {result.names[0]}",
            "stroke",
            *map(ForceTitle, ("rms {}", "mean {}", "max {}")),
            "at mm",
        ],
        [[d.name, d.stroke, d.rms_cN, d.mean_cN, d.max_cN, d.max_mm] for d in result.differences],
    )


def _print_lines(result: Comparison) -> None:
    click.echo(f"rms {force_unit()}: force of the press less that of {ui.one_line(result.names[0])}")
    rms = {d.index: d.rms_cN for d in result.differences if d.stroke == "press"}
    rows = [
        [ui.one_line(name, NAME_WIDTH), *(marks.to_dict()[key] for key in LANDMARKS), rms.get(i)]
        for i, (name, marks) in enumerate(zip(result.names, result.landmarks, strict=True))
    ]
    ui.print_table(["button", *map(force_name, LANDMARKS), ForceTitle("rms {}")], rows)


@click.command()
@click.argument("button")
@ui.velocity_option(help="Landmarks of the press nearest to this (mm/s); default: slowest.")
@ui.option("--figure", type=ui.PATH, help="Draw the curves into this .svg, .png or .pdf.")
@ui.option("--report", type=ui.PATH, help="Write a page to share: .html with chart, landmarks and model.")
@ui.json_option
def show(
    button: str, velocity_mm_s: float | None, figure: Path | None, report: Path | None, as_json: bool
) -> None:
    """Show landmarks and curves of a button.

    BUTTON is a built-in's name, a *.fdvv.json file, a file of measured curves, or a folder of them (a
    table, one line per button). Of an *.actuation.json file, or of the folder of a session, the receipt is
    shown: rig, method, presses, errors.
    """
    from fdvv.button.compare import spread_reports
    from fdvv.button.kind import kind_sentence
    from fdvv.button.open import open_button
    from fdvv.model.landmarks import landmark_errors, landmarks

    ui.check_output(figure, *ui.FIGURES)
    ui.check_output(report, ".html")
    if _show_receipt(button, as_json):
        return
    if button and Path(button).is_dir():
        if figure or report:
            option = "--figure draws" if figure else "--report shows"
            raise click.UsageError(f"{option} one button, and {button} is a folder")
        _show_folder(Path(button), velocity_mm_s, as_json)
        return
    model = open_button(button)
    if not model.of("press"):
        raise InputError(
            button, "curves", "it has no press, which landmarks are read from", "merge one into it"
        )
    marks, errors = landmarks(model, velocity_mm_s).to_dict(), landmark_errors(model, velocity_mm_s)
    if figure:
        from fdvv.report.model_figures import plot_model

        ui.save_figure(plot_model(model).figure, figure)
    if report:
        _write_page(report, [model], velocity_mm_s, opened_jnds(None))
    if as_json:
        uncertain = {name: vars(error) for name, error in errors.items()}
        source = model.provenance.source
        head = {"name": model.name, "source": source, "landmarks": marks, "landmark_errors": uncertain}
        ui.print_json({**head, **spread_reports(model)})
        return
    ui.print_wrapped(kind_sentence(model))
    ui.print_wrapped(f"{model.name}: {model.provenance.source or 'source not stated'}")
    for stroke in ("press", "release"):
        speeds = ", ".join(f"{v:g}" for v in model.velocities_mm_s(stroke))
        if model.of(stroke):
            click.echo(f"  {stroke} at {speeds + ' mm/s' if speeds else 'one unknown speed'}")
    click.echo("")
    _draw([model], velocity_mm_s)
    _print_landmarks(marks, errors)
    _print_spreads(spread_reports(model))
    ui.print_written(report)


def _print_landmarks(marks: dict[str, float | None], errors: dict[str, LandmarkError]) -> None:
    if not errors:
        plain = [[force_name(name), value] for name, value in marks.items()]
        ui.print_table(["landmark", "value"], plain, digits={"value": 3})
        return
    known = {name: [_plus_minus(name, error.error), error.presses] for name, error in errors.items()}
    rows: list[list[object]] = [
        [force_name(name), value, *known.get(name, ["", ""])] for name, value in marks.items()
    ]
    ui.print_table(["landmark", "value", "standard error", "presses"], rows, digits={"value": 3})


def _plus_minus(name: str, error: float) -> str:
    write = force_number if isinstance(force_name(name), ForceTitle) else format
    return f"± {write(error, '.3f')}"


def _print_spreads(report: dict[str, Any]) -> None:
    """Print how the presses behind a model's curves differ; nothing where none has a spread."""
    spread = [c for c in report["curves"] if c["presses"] is not None]
    if not spread:
        return
    click.echo("")
    ui.print_table(
        [
            "measured curve",
            "mm/s",
            "achieved mm/s",
            "presses",
            ForceTitle("median spread {}"),
            ForceTitle("largest"),
        ],
        [
            [
                *(c["stroke"], c["velocity_mm_s"], (c["achieved_mm_s"], c["achieved_spread_mm_s"])),
                *(c["presses"], c["median_spread_cN"], c["largest_spread_cN"]),
            ]
            for c in spread
        ],
        digits={"mm/s": 1, "achieved mm/s": 1},
    )


def _show_receipt(button: str, as_json: bool) -> bool:
    path = Path(button)
    if not button or not (path.is_dir() or button.endswith(".actuation.json") or own_kind(path) == ACTUATION):
        return False
    # most that is shown is no session: only a receipt is worth loading all that renders
    from fdvv.cli.rendering.session import print_receipt
    from fdvv.rendering.actuation_file import open_run_summary

    receipt = open_run_summary(path)
    if receipt is None:
        return False
    if as_json:
        ui.print_json(receipt.to_dict())
    else:
        print_receipt(receipt.to_dict())
    return True


def _show_folder(folder: Path, velocity_mm_s: float | None, as_json: bool) -> None:
    from fdvv.button.open import button_files, open_files
    from fdvv.model.landmarks import landmarks

    found, refused = [], []
    files = button_files(folder)
    with ui.progress("opening", len(files)) as advance:
        for done, button in enumerate(open_files(files), start=1):
            if button.model and button.model.of("press"):
                found.append((str(button.file), landmarks(button.model, velocity_mm_s).to_dict()))
            else:
                reason = button.reason or f"{button.file}: curves: holds no press; merge one into it"
                refused.append({"file": str(button.file), "reason": reason})
            advance(done, len(files))
    if as_json:
        ui.print_json({"results": [{"file": f, "landmarks": m} for f, m in found], "refused": refused})
    elif found:
        rows = [[ui.one_line(Path(f).name, NAME_WIDTH), *(m[key] for key in TABLE)] for f, m in found]
        ui.print_table(["button", *map(force_name, TABLE)], rows)
    ui.print_warnings([f"refused: {r['reason']}" for r in refused])
    if not found:
        raise ui.failed(f"{folder}: no button of it can be shown; the reasons are above", 2)
