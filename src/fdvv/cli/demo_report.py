"""The demo's report: one self-contained HTML file."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from fdvv import __version__
from fdvv.button.figures import plot_fit, plot_scan
from fdvv.cli.demo_run import DemoResult
from fdvv.cli.ui import bump_kept
from fdvv.rendering.evaluation.probe_figures import rendered_curves
from fdvv.rendering.evaluation.probe_report import sources_section, vibration_section
from fdvv.rendering.evaluation.verdict import verdict
from fdvv.rendering.figures import plot_convergence, plot_rendering
from fdvv.report.model_figures import plot_model, plot_surface
from fdvv.report.records import ErrorHistory
from fdvv.report.report import Section, Table, render_html
from fdvv.report.svg import figure_svg


def demo_report(result: DemoResult) -> str:
    """Write the report as HTML. Needs matplotlib (BuildError without it)."""
    source = (
        f"the twin, seed {result.seed} for learning, {result.seed + 1000} for judging; no hardware was used"
    )
    fit, uniform = result.switch.adaptive.fits[0], result.switch.uniform[0]
    errors = ", ".join(
        f"{r.label} {np.mean([row[r.label]['mean_error_cN'] for row in result.rows()]):.1f} cN"
        for r in result.renderings
    )
    summary = (
        f"A real switch is fitted from its raw curve to {fit.rmse_cN:.2f} cN (uniform knots: "
        f"{uniform.rmse_cN:.2f} cN). The published FDVV button is rendered on the simulated rig at four "
        "velocities and judged on fresh presses in true displacement. Mean error over all curves: "
        f"{errors}."
    )
    footer = f"fdvv {__version__}; {result.time_s:.0f} s; built-in sources and licences: fdvv library --json"
    sections = [_switch(result), _button(result), _rendering(result), _vibration(result), _learning(result)]
    sections.append(sources_section())
    return render_html("fdvv demo", summary, sections, footer, simulated=source)


def _figure(drawn: Any, text: str) -> str:
    axes = np.ravel(np.asarray(drawn, dtype=object))[0]
    return figure_svg(axes.figure, text)


def _switch(result: DemoResult) -> Section:
    fitted = result.switch.adaptive
    rows = [
        (
            f"{fit.curve.stroke}, {fit.method} knots",
            f"{fit.rmse_cN:.3f}",
            f"{fit.max_cN:.2f}",
            f"{fit.curve.control_points_cN.size}",
            bump_kept(fit.bump_kept_ratio),
            f"{fit.time_s * 1e3:.1f}",
        )
        for fit in (*fitted.fits, *result.switch.uniform)
    ]
    columns = ("curve", "RMSE (cN)", "max (cN)", "control points", "bump kept", "time (ms)")
    press = (fitted.fits[0], result.switch.uniform[0])
    figures = (
        _figure(plot_fit(fitted.measured[0], press, title=fitted.model.name), "Raw press and two fits"),
        _figure(
            plot_scan(result.switch.scan, title=fitted.model.name), "BIC* over the number of control points"
        ),
    )
    text = (
        f"{fitted.model.name}: measured, from contact to bottom-out, not smoothed. Errors are against the "
        "raw curve, each distinct displacement counting once.",
        *(f"Warning: {warning}." for warning in fitted.warnings),
    )
    return Section("A real switch, fitted", text, figures, (Table(columns, tuple(rows)),))


def _button(result: DemoResult) -> Section:
    button = result.button
    text = (f"{button.name}: {button.provenance.source}.", f"Credit: {button.provenance.citation}.")
    figures = (
        _figure(plot_model(button), "Press and release curves of the button"),
        _figure(plot_surface(button), "Force over displacement and velocity"),
    )
    return Section("The published button", text, figures)


def _rendering(result: DemoResult) -> Section:
    labels = [r.label for r in result.renderings]
    columns = ("curve", *(f"{label}, mean / max (cN)" for label in labels))
    rows = [
        (
            f"{row['stroke']} at {row['velocity_mm_s']:g} mm/s",
            *(f"{row[k]['mean_error_cN']:.2f} / {row[k]['max_error_cN']:.2f}" for k in labels),
        )
        for row in result.rows()
    ]
    low, high = result.renderings[0].judged.range_mm
    caption = (
        f"Simulated. |target - rendered| from {low:g} to {high:g} mm of true displacement, median over "
        f"{result.renderings[0].judged.presses // len(rows) * 2} fresh presses per velocity."
    )
    text = (
        "FD only renders the slowest curve at every speed, as data sheets describe a button; FDVV renders "
        "the speed's own curve. Both are learned by the default method and judged against the full model.",
        "The bands grow with speed because the simulated person varies the pace by a tenth. Bars mark where "
        "a finger would notice the difference.",
        *(f"{r.label}: {verdict(r.judged.curves)}" for r in result.renderings),
    )
    learned = {r.label: r.judged.curves for r in result.renderings if r.learned}
    grid = plot_rendering(rendered_curves(learned, simulated=True), title=result.button.name, simulated=True)
    figure = _figure(grid, "Target and rendered force per velocity and stroke")
    return Section("Rendered on the rig", text, (figure,), (Table(columns, tuple(rows), caption),))


def _vibration(result: DemoResult) -> Section:
    """Show the vibration of the last rendering, which plays it."""
    played = result.renderings[-1]
    found = vibration_section(played.judged.curves, simulated=True)
    return replace(found, title=f"{found.title}, rendered by {played.label}")


def _learning(result: DemoResult) -> Section:
    learned = result.renderings[-1].learned
    assert learned is not None
    histories = [
        ErrorHistory(c.stroke, c.velocity_mm_s, np.array(c.error_cN), simulated=True)
        for c in learned.outcome.curves
        if len(c.error_cN)
    ]
    text = (
        f"{learned.method}. {learned.outcome.sentence}",
        "The line at 2.93 cN is what the paper's hardware reached.",
    )
    figure = _figure(
        plot_convergence(histories, paper=True, simulated=True), "Error of each press while learning"
    )
    return Section("Learning the actuation", text, (figure,))
