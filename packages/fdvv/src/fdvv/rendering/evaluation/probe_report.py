"""The report of a probe: verdict, figures, tables, and where the just noticeable differences come from."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from fdvv._version import __version__
from fdvv.force_text import force_number, force_unit
from fdvv.model.noticeable import Jnds, JndSource
from fdvv.rendering.evaluation.noticed import Noticed, summarize
from fdvv.rendering.evaluation.probe_curve import ENTRY_mm, ProbeCurve
from fdvv.rendering.evaluation.probe_figures import method_curves, plot_vibrations, worst_vibrations
from fdvv.rendering.evaluation.vibration_presses import NOT_ASKED
from fdvv.rendering.figures import plot_rendering
from fdvv.rendering.probe import ProbeResult
from fdvv.report.report import Section, Table, render_html
from fdvv.report.svg import figure_svg


def probe_report(result: ProbeResult) -> str:
    """Write the report as HTML. Needs matplotlib (BuildError without it)."""
    record = result.to_dict()
    simulated = f"the {result.device_name}; no hardware was used" if result.simulated else None
    sections = [
        _force(result),
        vibration_section(result.curves, result.simulated),
        sources_section(result.jnds),
    ]
    more = f", {result.vibration_presses} more with the vibration" if result.vibration_presses else ""
    footer = f"fdvv {__version__}; {result.presses} presses{more}; method: {result.method}"
    summary = f"{record['verdict']} {record['next_step']}"
    return render_html(f"{result.model_name} as rendered", summary, sections, footer, simulated=simulated)


def _force(result: ProbeResult) -> Section:
    low, high = result.range_mm
    text = (
        f"Judged from {low:g} to {high:g} mm of true displacement. The grey band is one JND of force around "
        "the target. A bar marks where most presses would be noticed, vibration included.",
    )
    grid = plot_rendering(method_curves({"rendered": result.curves}, result.simulated))
    figure = figure_svg(grid, "Target and rendered force per velocity and stroke, and what is noticed")
    return Section("Force", text, (figure,), (errors_table(result.curves),))


def errors_table(curves: Sequence[ProbeCurve]) -> Table:
    """Return errors of force and shares of the stroke above one JND."""
    columns = (
        "curve", *(f"{name} ({force_unit()})" for name in ("mean", "max", "ripple")), "above 1 JND (%)",
        "achieved (%)",
        f"to {ENTRY_mm:g} mm (%)", "with vibration (%)", "excess (JND)",
    )  # fmt: skip
    caption = (
        "Medians over presses; shares of the stroke over all presses. Achieved: against the model at the "
        "speed that each press had. Excess: mean of what exceeds one JND, force and vibration. Ripple: rms "
        "of the force's error from 40 to 800 Hz."
    )
    return Table(columns, tuple(map(_error_row, curves)), caption)


def _error_row(curve: ProbeCurve) -> tuple[str, ...]:
    entry = summarize(curve.force_JND[:, curve.displacement_mm <= ENTRY_mm + 1e-9])
    shares = (summarize(curve.force_JND), summarize(curve.own_speed_JND), entry, curve.total)
    outcome = curve.outcome
    return (
        _name(curve),
        force_number(outcome.mean_error_cN, ".2f"),
        force_number(outcome.max_error_cN, ".1f"),
        "–" if curve.ripple_cN is None else force_number(curve.ripple_cN, ".1f"),
        *(_percent(share) for share in shares),
        f"{curve.total.excess_JND:.2f}",
    )


def _name(curve: ProbeCurve) -> str:
    return f"{curve.stroke}, {curve.velocity_mm_s:g} mm/s"


def _percent(share: Noticed) -> str:
    return f"{100 * share.above_ratio:.0f}"


def vibration_section(curves: Sequence[ProbeCurve], simulated: bool) -> Section:
    """Return what became of the vibrations, or that none was asked for."""
    asked = [curve for curve in curves if curve.vibration.asked]
    if not asked:
        return Section("Vibration", (f"Vibration was {NOT_ASKED}: the model has none.",))
    text = (
        "Acceleration of the cap, without what is slower than half of the vibration's frequency. Force alone "
        "moves the cap too; what playing adds is the difference to presses without. Of each stroke the speed "
        "is drawn at which the vibration is noticed most.",
    )
    shown = worst_vibrations(curves)
    figures = (
        (
            figure_svg(
                plot_vibrations(curves, simulated), "Vibration asked for and rendered, in time and by bands"
            ),
        )
        if shown
        else ()
    )
    columns = (
        "curve", "outcome", "late (ms)", "late (mm)", "level (dB)", "cap alone (dB)", "likeness",
        "frequency (ratio)", "JND",
    )  # fmt: skip
    caption = (
        "Level: energy added over energy asked for; cap alone: energy of the cap's own motion over it, 40 to "
        "800 Hz. Likeness: 1 is the same shape. JND: strength, onset and frequency, squares added."
    )
    return Section("Vibration", text, figures, (Table(columns, tuple(map(_vibration_row, asked)), caption),))


def _vibration_row(curve: ProbeCurve) -> tuple[str, ...]:
    record = curve.vibration.to_dict()
    keys = {"onset_ms": 1, "onset_mm": 2, "level_dB": 1, "own_dB": 1, "likeness": 2}
    keys |= {"frequency_ratio": 2, "total_JND": 2}
    cells = (_cell(record.get(key), digits) for key, digits in keys.items())
    return (_name(curve), str(record["outcome"]), *cells)


def _cell(value: Any, digits: int) -> str:
    return "–" if value is None else f"{value:.{digits}f}"


def sources_section(jnds: Jnds) -> Section:
    """Return the just noticeable differences with their sources and assumptions."""
    text = (
        f"Judged by {jnds.origin}.",
        "No study that was read compared whole strokes of push-buttons; these numbers show what to look at "
        "first.",
    )
    return Section("Just noticeable differences", (*text, *map(_source_text, jnds.sources)))


def _source_text(source: JndSource) -> str:
    measured = f" Measured: {source.source}." if source.source else ""
    return f"{source.of.capitalize()}: {source.value}.{measured} Assumed: {source.assumed}."
