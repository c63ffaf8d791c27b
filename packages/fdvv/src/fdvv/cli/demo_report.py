"""The demo's report: one self-contained HTML file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from fdvv._version import __version__
from fdvv.button.figures import plot_fit, plot_scan
from fdvv.cli.demo_run import DemoResult
from fdvv.cli.ui import bump_kept
from fdvv.force_text import force_number, force_text, force_unit
from fdvv.rendering.evaluation.probe_figures import method_curves
from fdvv.rendering.evaluation.probe_report import sources_section, vibration_section
from fdvv.rendering.evaluation.verdict import headline, headline_figures, verdict
from fdvv.rendering.figures import PAPER_ERROR_cN, plot_convergence, plot_rendering
from fdvv.report.model_figures import plot_model, plot_surface
from fdvv.report.records import ErrorHistory, RenderedCurve
from fdvv.report.report import Headline, Section, Table, render_html
from fdvv.report.svg import figure_svg


def demo_report(result: DemoResult) -> str:
    """Write the report as HTML. Needs matplotlib (BuildError without it)."""
    source = (
        f"the twin, seed {result.seed} for learning, {result.seed + 1000} for judging; no hardware was used"
    )
    before, after = result.renderings[0].judged.curves, result.renderings[-1].judged.curves
    found = headline(after, before)
    summary = (
        f"{result.button.name}, the published FDVV button, on the simulated rig at four speeds, judged on "
        f"fresh presses. {found[0].upper()}{found[1:]}. To open it in the studio, run fdvv studio and search "
        f"for {result.button.name}."
    )
    footer = f"fdvv {__version__}; {result.time_s:.0f} s; built-in sources and licences: fdvv library --json"
    detail = (_every_rendering, _vibration, _learning, _button, _scan)
    sections = [_before_and_after(result), _switch(result)]
    sections += [replace(make(result), folded=True) for make in detail]
    sections.append(replace(sources_section(result.renderings[-1].judged.jnds), folded=True))
    figures = [Headline(*figure) for figure in headline_figures(after, before)]
    return render_html("fdvv demo", summary, sections, footer, simulated=source, headlines=figures)


def _before_and_after(result: DemoResult) -> Section:
    """Show target and rendered force of one speed at a time, with and without compensation."""
    first, last = result.renderings[0].judged.curves, result.renderings[-1].judged.curves
    methods = {"uncompensated": first, "compensated": last}
    shown = method_curves(methods, simulated=True)
    speeds = sorted({curve.velocity_mm_s for curve in shown})
    choices = tuple(
        (f"{v:g} mm/s", _figure(_of_speed(shown, v), f"Target and rendered force at {v:g} mm/s"))
        for v in speeds
    )
    text = "The grey band is one JND of force around the target. A bar marks where a finger would notice it."
    return Section("Before and after compensation", (text,), choices=choices)


def _of_speed(curves: Sequence[RenderedCurve], velocity_mm_s: float) -> Any:
    return plot_rendering([c for c in curves if c.velocity_mm_s == velocity_mm_s], simulated=True)


def _figure(drawn: Any, text: str) -> str:
    axes = np.ravel(np.asarray(drawn, dtype=object))[0]
    return figure_svg(axes.figure, text)


def _switch(result: DemoResult) -> Section:
    fitted = result.switch.adaptive
    rows = [
        (
            f"{fit.curve.stroke}, {fit.method} knots",
            force_number(fit.rmse_cN, ".3f"),
            force_number(fit.max_cN, ".2f"),
            f"{fit.curve.control_points_cN.size}",
            bump_kept(fit.bump_kept_ratio),
            f"{fit.time_s * 1e3:.1f}",
        )
        for fit in (*fitted.fits, *result.switch.uniform)
    ]
    columns = (
        "curve",
        f"RMSE ({force_unit()})",
        f"max ({force_unit()})",
        "control points",
        "bump kept",
        "time (ms)",
    )
    press = (fitted.fits[0], result.switch.uniform[0])
    drawn = plot_fit(fitted.measured[0], press, title=fitted.model.name)
    figures = (_figure(drawn, "Raw press and two fits"),)
    text = (
        f"{fitted.model.name}: measured, from contact to bottom-out, not smoothed. Errors are against the "
        "raw curve, each distinct displacement counting once.",
        *(f"Warning: {warning}." for warning in fitted.warnings),
    )
    return Section("A real switch, fitted", text, figures, (Table(columns, tuple(rows)),))


def _scan(result: DemoResult) -> Section:
    drawn = plot_scan(result.switch.scan, title=result.switch.adaptive.model.name)
    figure = _figure(drawn, "BIC* over the number of control points")
    return Section("How many control points the switch needs", figures=(figure,))


def _button(result: DemoResult) -> Section:
    button = result.button
    text = (f"{button.name}: {button.provenance.source}.", f"Credit: {button.provenance.citation}.")
    figures = (
        _figure(plot_model(button), "Press and release curves of the button"),
        _figure(plot_surface(button), "Force over displacement and velocity"),
    )
    return Section("The published button", text, figures)


def _every_rendering(result: DemoResult) -> Section:
    labels = [r.label for r in result.renderings]
    columns = ("curve", *(f"{label}, mean / max ({force_unit()})" for label in labels))
    rows = [
        (
            f"{row['stroke']} at {row['velocity_mm_s']:g} mm/s",
            *(
                " / ".join(force_number(row[k][f"{name}_error_cN"], ".2f") for name in ("mean", "max"))
                for k in labels
            ),
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
    grid = plot_rendering(method_curves(learned, simulated=True), title=result.button.name, simulated=True)
    figure = _figure(grid, "Target and rendered force per velocity and stroke")
    return Section(
        "Every speed, and what each part of the model brings",
        text,
        (figure,),
        (Table(columns, tuple(rows), caption),),
    )


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
        f"The line at {force_text(PAPER_ERROR_cN)} is what the paper's hardware reached.",
    )
    figure = _figure(
        plot_convergence(histories, paper=True, simulated=True), "Error of each press while learning"
    )
    return Section("Learning the actuation", text, (figure,))
