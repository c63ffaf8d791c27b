"""A picture of every step between a recording and its model: one self-contained HTML file."""

from __future__ import annotations

import numpy as np

from fdvv import __version__
from fdvv.bench.figures import (
    plot_averages,
    plot_clocks,
    plot_displacement,
    plot_force,
    plot_registration,
    plot_take,
    plot_velocities,
)
from fdvv.bench.model import RecordedModel, capture_report, used_and_left_out
from fdvv.button.compare import vibration_spread
from fdvv.model.curve import Stroke
from fdvv.model.landmarks import landmark_errors, landmarks
from fdvv.preprocess.reject import Judged
from fdvv.recording.types import UNITS
from fdvv.report.model_figures import plot_model, plot_vibration
from fdvv.report.report import Section, Table, render_html
from fdvv.report.svg import figure_svg

FORCES = ("peak_cN", "valley_cN", "bottom_out_cN", "release_peak_cN", "release_valley_cN")


def capture_html(recorded: RecordedModel) -> str:
    """Write the report as HTML. Needs matplotlib (BuildError without it)."""
    model = recorded.model
    sections = [
        _streams(recorded),
        _clocks(recorded),
        _force(recorded),
        _paths(recorded),
        _presses(recorded),
        _registration(recorded),
        _curves(recorded),
        _vibration(recorded),
        _model(recorded),
    ]
    simulated = "the takes come from the twin; no hardware was used" if model.provenance.simulated else None
    footer = f"fdvv {__version__}; {'; '.join(model.provenance.assumptions)}."
    summary = f"{model.provenance.source}: {used_and_left_out(recorded.processed)}."
    present = [section for section in sections if section is not None]
    return render_html(f"{model.name}: from recording to model", summary, present, footer, simulated)


def _example(recorded: RecordedModel, fastest: bool) -> Judged:
    """Choose the press of median speed among those used at the fastest or slowest velocity."""
    used = [one for one in recorded.processed.judged if one.reason is None]
    velocities = [one.press.velocity_mm_s or 0.0 for one in used]
    asked_mm_s = max(velocities) if fastest else min(velocities)
    group = [one for one, its in zip(used, velocities, strict=True) if its == asked_mm_s]
    return sorted(group, key=lambda one: one.achieved_mm_s)[len(group) // 2]


def _streams(recorded: RecordedModel) -> Section:
    take = next(
        t for t in recorded.recording.takes if t.number == _example(recorded, fastest=True).press.take
    )
    rows = tuple(
        (
            s.name,
            f"{s.quantity} ({UNITS[s.quantity]})" if UNITS[s.quantity] != "1" else str(s.quantity),
            s.clock,
            f"{s.rate_Hz:.1f}",
            str(s.t_s.size),
        )
        for s in take.streams
    )
    columns = ("stream", "holds", "clock", "rate (Hz)", "samples")
    table = Table(columns, rows, f"Streams of take {take.number}.")
    figure = figure_svg(plot_take(recorded.recording, take.number), f"Raw streams of take {take.number}")
    text = "What the instruments wrote down, each stream on the clock of its own instrument; nothing changed."
    return Section("Raw streams", (text,), (figure,), (table,))


def _clocks(recorded: RecordedModel) -> Section | None:
    clock = recorded.processed.clock
    if not clock.edges:
        return None
    figure = figure_svg(
        plot_clocks(recorded.recording, recorded.processed), "Bounds of the light's edges about the line"
    )
    ppm = 1e6 * (clock.rate - 1)
    text = (
        f"Two frames bound when the light was switched. One line goes through the bounds of {clock.edges} "
        f"edges, {clock.refused} are refused. The camera's clock runs {ppm:+.1f} ppm fast; the bounds leave "
        f"± {1e6 * clock.doubt_s:.2g} µs of doubt."
    )
    return Section("Clocks", (text,), (figure,))


def _force(recorded: RecordedModel) -> Section:
    bench = recorded.recording.bench
    number = _example(recorded, fastest=True).press.take
    figure = figure_svg(
        plot_force(recorded.recording, recorded.processed, number), f"Force of take {number} before and after"
    )
    text = (
        f"The filter before the converter ({bench.force_filter_ms:g} ms) and the sensor's play "
        f"({bench.force_play_cN:g} cN) are undone; what is 0 had nothing to undo."
    )
    return Section("Force", (text,), (figure,))


def _paths(recorded: RecordedModel) -> Section:
    simulated = recorded.recording.simulated
    numbers = dict.fromkeys(_example(recorded, fastest).press.take for fastest in (False, True))
    figures = tuple(
        figure_svg(plot_displacement(recorded.processed, n, simulated), f"Path of take {n}") for n in numbers
    )
    text = (
        "Frames are few in a fast stroke. Between them the path follows the force and the cap's own equation "
        f"of motion. The finger at rest had pressed the cap {recorded.processed.zero_mm:.3f} mm deep, which "
        "is added to every depth."
    )
    return Section("Displacement", (text,), figures)


def _presses(recorded: RecordedModel) -> Section:
    report = capture_report(recorded)
    left = [press for press in report["presses"] if press["reason"]]
    rows = tuple(
        (
            f"take {p['take']}" + (f", press {p['part']}" if p["part"] > 1 else ""),
            "–" if p["velocity_mm_s"] is None else f"{p['velocity_mm_s']:g}",
            f"{p['achieved_mm_s']:.1f}",
            f"{p['bottom_mm']:.3f}",
            p["reason"],
        )
        for p in left
    )
    columns = ("press", "asked (mm/s)", "achieved (mm/s)", "deepest (mm)", "why it is left out")
    table = Table(columns, rows, "Presses that were left out.")
    figure = figure_svg(
        plot_velocities(recorded.processed, recorded.recording.simulated), "Speeds of all presses"
    )
    return Section(
        "Presses", (used_and_left_out(recorded.processed) + ".",), (figure,), (table,) if rows else ()
    )


def _registration(recorded: RecordedModel) -> Section:
    processed, simulated = recorded.processed, recorded.recording.simulated
    asked_mm_s = _example(recorded, fastest=True).press.velocity_mm_s
    figures = tuple(
        figure_svg(
            plot_registration(processed, curve.stroke, asked_mm_s, simulated=simulated),
            f"Samples, mean and spread of the {curve.stroke}",
        )
        for curve in processed.curves
        if curve.velocity_mm_s == asked_mm_s
    )
    text = (
        "Every sample of every press counts at the place where it was taken. The dashed line is what the "
        "recipe of the paper makes of the same presses: filtered, upsampled on lines, binned and smoothed."
    )
    return Section("Registration", (text,), figures)


def _curves(recorded: RecordedModel) -> Section:
    rows = tuple(
        (
            f"{c.stroke}",
            "–" if c.velocity_mm_s is None else f"{c.velocity_mm_s:g}",
            f"{c.achieved_mm_s:.1f} ± {c.achieved_spread_mm_s:.1f}",
            str(c.presses),
            f"{np.median(c.spread_cN):.2f}",
            f"{c.spread_cN.max():.2f}",
            f"{c.width_mm:.2f}",
        )
        for c in recorded.processed.curves
    )
    columns = (
        "stroke", "asked (mm/s)", "achieved (mm/s)", "presses", "median SD (cN)", "largest SD (cN)",
        "smoothed over (mm)",
    )  # fmt: skip
    figure = figure_svg(
        plot_averages(recorded.processed, recorded.recording.simulated), "Averaged curves of all paces"
    )
    table = Table(columns, rows, "Averaged curves; SD is that between presses.")
    return Section("Averaged curves", (), (figure,), (table,))


def _vibration(recorded: RecordedModel) -> Section:
    rows = tuple(
        (
            str(v.stroke),
            "–" if v.velocity_mm_s is None else f"{v.velocity_mm_s:g}",
            _with(spread["onset_mm"], spread["onset_spread_mm"], 3),
            _with(spread["frequency_Hz"], spread["frequency_spread_Hz"], 0),
            _with(
                1e3 * spread["duration_s"],
                spread["duration_spread_s"] and 1e3 * spread["duration_spread_s"],
                1,
            ),
            _with(spread["amplitude_m_s2"], spread["amplitude_spread_m_s2"], 2),
            "–" if spread["presses"] is None else str(spread["presses"]),
        )
        for v in recorded.model.vibrations
        for spread in (vibration_spread(v),)
    )
    columns = (
        "stroke", "asked (mm/s)", "onset (mm)", "frequency (Hz)", "duration (ms)", "amplitude (m/s²)",
        "presses",
    )  # fmt: skip
    table = Table(
        columns, rows, "Vibrations of the model by their principal mode; ± is that between presses."
    )
    figures = (plot_vibration(recorded.model),) if recorded.model.vibrations else ()
    svgs = tuple(figure_svg(figure, "Vibrations of the model") for figure in figures)
    text = tuple(f"{warning[0].upper()}{warning[1:]}." for warning in recorded.vibration.warnings)
    return Section("Vibration", text, svgs, (table,) if rows else ())


def _with(value: float, spread: float | None, decimals: int) -> str:
    return f"{value:.{decimals}f}" + ("" if spread is None else f" ± {spread:.{decimals}f}")


def _model(recorded: RecordedModel) -> Section:
    model = recorded.model
    fits = tuple(
        (
            f"{fit.curve.stroke}, {fit.curve.velocity_mm_s:g} mm/s",
            f"{fit.rmse_cN:.3f}",
            f"{fit.max_cN:.2f}",
            "no bump" if fit.bump_kept_ratio is None else f"{100 * fit.bump_kept_ratio:.1f} %",
        )
        for fit in recorded.fits
    )
    tables = [
        Table(("curve", "RMSE (cN)", "max (cN)", "bump kept"), fits, "Splines against averaged curves.")
    ]
    if model.of(Stroke.PRESS):
        tables.append(_landmarks(recorded))
    warnings = tuple(f"Warning: {warning}." for warning in recorded.warnings)
    return Section("Model", warnings, (figure_svg(plot_model(model), "Curves of the model"),), tuple(tables))


def _landmarks(recorded: RecordedModel) -> Table:
    rows = []
    for velocity in recorded.model.velocities_mm_s(Stroke.PRESS):
        marks = landmarks(recorded.model, velocity).to_dict()
        errors = landmark_errors(recorded.model, velocity)
        cells = [
            "–"
            if marks[n] is None
            else f"{marks[n]:.2f}" + (f" ± {errors[n].error:.2f}" if n in errors else "")
            for n in FORCES
        ]
        rows.append((f"{velocity:g}", *cells))
    columns = ("speed (mm/s)", *(name.replace("_cN", " (cN)").replace("_", " ") for name in FORCES))
    return Table(columns, tuple(rows), "Landmarks; ± is the standard error over presses.")
