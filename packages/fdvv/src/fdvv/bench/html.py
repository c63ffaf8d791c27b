"""A picture of every step between a recording and its model: one self-contained HTML file."""

from __future__ import annotations

import numpy as np

from fdvv._version import __version__
from fdvv.bench.figures import (
    plot_averages,
    plot_clocks,
    plot_displacement,
    plot_force,
    plot_registration,
    plot_take,
    plot_velocities,
)
from fdvv.bench.model import RecordedModel, explain_rejections
from fdvv.button.compare import vibration_spread
from fdvv.force_text import force_number, force_text, force_unit
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
    parts = (_streams, _clocks, _force, _paths, _presses, _registration, _curves, _vibration, _model)
    present = [section for part in parts if (section := part(recorded)) is not None]
    simulated = "the takes come from the twin; no hardware was used" if model.provenance.simulated else None
    footer = f"fdvv {__version__}; {'; '.join(model.provenance.assumptions)}."
    summary = f"{model.provenance.source}: {explain_rejections(recorded.processed)}."
    return render_html(f"{model.name}: from recording to model", summary, present, footer, simulated)


def _example(recorded: RecordedModel, fastest: bool) -> Judged:
    """Choose the press of median speed among those used at the fastest or slowest velocity."""
    used = [entry for entry in recorded.processed.judged if entry.reason is None]
    velocities = [entry.press.velocity_mm_s or 0.0 for entry in used]
    requested_mm_s = max(velocities) if fastest else min(velocities)
    group = [entry for entry, its in zip(used, velocities, strict=True) if its == requested_mm_s]
    return sorted(group, key=lambda entry: entry.achieved_mm_s)[len(group) // 2]


def _streams(recorded: RecordedModel) -> Section:
    number = _example(recorded, fastest=True).press.take
    (take,) = (take for take in recorded.recording.takes if take.number == number)
    holds = {q: f"{q} ({unit})" if unit != "1" else str(q) for q, unit in UNITS.items()}
    rows = tuple(
        (s.name, holds[s.quantity], s.clock, f"{s.rate_Hz:.1f}", str(s.t_s.size)) for s in take.streams
    )
    columns = ("stream", "holds", "clock", "rate (Hz)", "samples")
    table = Table(columns, rows, f"Streams of take {number}.")
    figure = figure_svg(plot_take(recorded.recording, number), f"Raw streams of take {number}")
    text = "What the instruments wrote down, each stream on the clock of its own instrument; nothing changed."
    return Section("Raw streams", (text,), (figure,), (table,))


def _clocks(recorded: RecordedModel) -> Section | None:
    clock = recorded.processed.clock
    if not clock.edges:
        return None
    plot = plot_clocks(recorded.recording, recorded.processed)
    ppm = 1e6 * (clock.rate - 1)
    text = (
        f"Two frames bound when the light was switched. One line goes through the bounds of {clock.edges} "
        f"edges, {clock.refused} are refused. The camera's clock runs {ppm:+.1f} ppm fast; the bounds leave "
        f"± {1e6 * clock.doubt_s:.2g} µs of doubt."
    )
    return Section("Clocks", (text,), (figure_svg(plot, "Bounds of the light's edges about the line"),))


def _force(recorded: RecordedModel) -> Section:
    bench = recorded.recording.bench
    number = _example(recorded, fastest=True).press.take
    plot = plot_force(recorded.recording, recorded.processed, number)
    text = (
        f"The filter before the converter ({bench.force_filter_ms:g} ms) and the sensor's play "
        f"({force_text(bench.force_play_cN)}) are undone; what is 0 had nothing to undo."
    )
    return Section("Force", (text,), (figure_svg(plot, f"Force of take {number} before and after"),))


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
    rows = tuple(
        (
            entry.press.name,
            _speed(entry.press.velocity_mm_s),
            f"{entry.achieved_mm_s:.1f}",
            f"{entry.spans.bottom_mm:.3f}",
            str(entry.reason),
        )
        for entry in recorded.processed.judged
        if entry.reason
    )
    columns = ("press", "asked (mm/s)", "achieved (mm/s)", "deepest (mm)", "why it is left out")
    tables = (Table(columns, rows, "Presses that were left out."),) if rows else ()
    plot = plot_velocities(recorded.processed, recorded.recording.simulated)
    text = explain_rejections(recorded.processed) + "."
    return Section("Presses", (text,), (figure_svg(plot, "Speeds of all presses"),), tables)


def _speed(velocity_mm_s: float | None) -> str:
    return "–" if velocity_mm_s is None else f"{velocity_mm_s:g}"


def _registration(recorded: RecordedModel) -> Section:
    processed, simulated = recorded.processed, recorded.recording.simulated
    requested_mm_s = _example(recorded, fastest=True).press.velocity_mm_s
    figures = tuple(
        figure_svg(
            plot_registration(processed, curve.stroke, requested_mm_s, simulated=simulated),
            f"Samples, mean and spread of the {curve.stroke}",
        )
        for curve in processed.curves
        if curve.velocity_mm_s == requested_mm_s
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
            _speed(c.velocity_mm_s),
            f"{c.achieved_mm_s:.1f} ± {c.achieved_spread_mm_s:.1f}",
            str(c.presses),
            force_number(float(np.median(c.spread_cN)), ".2f"),
            force_number(float(c.spread_cN.max()), ".2f"),
            f"{c.width_mm:.2f}",
        )
        for c in recorded.processed.curves
    )
    columns = (
        "stroke", "asked (mm/s)", "achieved (mm/s)", "presses", f"median SD ({force_unit()})",
        f"largest SD ({force_unit()})",
        "smoothed over (mm)",
    )  # fmt: skip
    plot = plot_averages(recorded.processed, recorded.recording.simulated)
    figure = figure_svg(plot, "Averaged curves of all paces")
    table = Table(columns, rows, "Averaged curves; SD is that between presses.")
    return Section("Averaged curves", (), (figure,), (table,))


def _vibration(recorded: RecordedModel) -> Section:
    rows = tuple(
        (
            str(v.stroke),
            _speed(v.velocity_mm_s),
            _with(spread["onset_mm"], spread["onset_spread_mm"], 3),
            _with(spread["frequency_Hz"], spread["frequency_spread_Hz"], 0),
            _with(spread["duration_s"], spread["duration_spread_s"], 1, 1e3),
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
    text = tuple(f"{warning[0].upper()}{warning[1:]}." for warning in recorded.vibration.warnings)
    if not rows:
        return Section("Vibration", text)
    caption = "Vibrations of the model by their principal mode; ± is that between presses."
    figure = figure_svg(plot_vibration(recorded.model), "Vibrations of the model")
    return Section("Vibration", text, (figure,), (Table(columns, rows, caption),))


def _with(value: float, spread: float | None, decimals: int, scale: float = 1.0) -> str:
    return f"{scale * value:.{decimals}f}" + ("" if spread is None else f" ± {scale * spread:.{decimals}f}")


def _with_force(force_cN: float, error_cN: float | None) -> str:
    more = "" if error_cN is None else f" ± {force_number(error_cN, '.2f')}"
    return force_number(force_cN, ".2f") + more


def _model(recorded: RecordedModel) -> Section:
    model = recorded.model
    fits = tuple(
        (
            f"{fit.curve.stroke}, {fit.curve.velocity_mm_s:g} mm/s",
            force_number(fit.rmse_cN, ".3f"),
            force_number(fit.max_cN, ".2f"),
            "no bump" if fit.bump_kept_ratio is None else f"{100 * fit.bump_kept_ratio:.1f} %",
        )
        for fit in recorded.fits
    )
    columns = ("curve", f"RMSE ({force_unit()})", f"max ({force_unit()})", "bump kept")
    tables = [Table(columns, fits, "Splines against averaged curves.")]
    if model.of(Stroke.PRESS):
        tables.append(_landmarks(recorded))
    warnings = tuple(f"Warning: {warning}." for warning in recorded.warnings)
    return Section("Model", warnings, (figure_svg(plot_model(model), "Curves of the model"),), tuple(tables))


def _landmarks(recorded: RecordedModel) -> Table:
    rows = []
    for velocity in recorded.model.velocities_mm_s(Stroke.PRESS):
        marks = landmarks(recorded.model, velocity).to_dict()
        errors = {name: error.error for name, error in landmark_errors(recorded.model, velocity).items()}
        cells = ["–" if (at := marks[name]) is None else _with_force(at, errors.get(name)) for name in FORCES]
        rows.append((f"{velocity:g}", *cells))
    columns = (
        "speed (mm/s)",
        *(name.replace("_cN", f" ({force_unit()})").replace("_", " ") for name in FORCES),
    )
    return Table(columns, tuple(rows), "Landmarks; ± is the standard error over presses.")
