"""A designed mechanism as one HTML file: target, design, band, residual, parts, and the twin's word."""

from __future__ import annotations

from fdvv._version import __version__
from fdvv.force_text import force_number, force_text, force_unit
from fdvv.model.curve import Stroke
from fdvv.report.report import Section, Table, render_html
from fdvv.report.svg import figure_svg
from fdvv_switch.design_button import MechanismResult
from fdvv_switch.facts import facts_of
from fdvv_switch.figures import DesignedStroke, plot_mechanism, plot_parts
from fdvv_switch.residual import WANTED_cN
from fdvv_switch.section import drawings_of
from fdvv_switch.target import STOP_mm
from fdvv_switch.twin import PressedDesign


def mechanism_report(result: MechanismResult) -> str:
    """Write the report as HTML. Needs matplotlib (BuildError without it)."""
    summary = f"{result.model.name}: {result.recommendation}."
    sections = [_curves(result), _parts(result), _tolerances(result), _kinds(result), _twin(result)]
    footer = f"fdvv {__version__}; {result.model.provenance.citation or result.model.provenance.source}"
    title = f"A {result.mechanism.kind} for {result.model.name}"
    simulated = "no part was made; what was pressed is the twin"
    return render_html(title, summary, sections, footer, simulated=simulated)


def designed_strokes(result: MechanismResult) -> tuple[DesignedStroke, ...]:
    """Return both strokes as a figure takes them."""
    target, band = result.target, result.band
    x = target.displacement_mm
    press, release = result.mechanism.strokes_cN(x)
    slow = result.pressed[0] if result.pressed else None
    at, down, up = (slow.displacement_mm, slow.press_cN, slow.release_cN) if slow else (None, None, None)
    lows, highs = (band.press_low_cN, band.release_low_cN), (band.press_high_cN, band.release_high_cN)
    return (
        DesignedStroke(Stroke.PRESS, x, target.press_cN, press, lows[0], highs[0], at, down),
        DesignedStroke(Stroke.RELEASE, x, target.release_cN, release, lows[1], highs[1], at, up),
    )


def _curves(result: MechanismResult) -> Section:
    grid = plot_mechanism(designed_strokes(result), WANTED_cN, result.model.name)
    rows = []
    for name, miss in (("press", result.residual.press), ("release", result.residual.release)):
        errors = (
            *(force_number(cN, ".2f") for cN in (miss.rms_cN, miss.seated_rms_cN)),
            force_number(miss.largest_cN, "+.1f"),
        )
        rows.append((name, *errors, f"{miss.largest_mm:.2f}"))
    columns = (
        "stroke",
        *(f"{name} ({force_unit()})" for name in ("rms", "rms from 0.1 mm", "largest")),
        "at (mm)",
    )
    caption = f"Design less target, from 0 to {STOP_mm:g} mm before the bottom stop."
    sentences = tuple(f"{text[0].upper()}{text[1:]}." for text in result.residual.reasons)
    figure = figure_svg(grid[0, 0].figure, "Target, design, tolerance band and residual of press and release")
    return Section("Curves", sentences, (figure,), (Table(columns, tuple(rows), caption),))


def _parts(result: MechanismResult) -> Section:
    figure = figure_svg(plot_parts(drawings_of(result.mechanism))[0].figure, "Drawings of the parts")
    rows = tuple(
        (part, name, value if isinstance(value, str) else f"{value:.4g}")
        for part, facts in facts_of(result.mechanism, result.target).items()
        for name, value in facts.items()
    )
    notes = tuple(f"{note[0].upper()}{note[1:]}." for note in result.notes)
    return Section("Parts", notes, (figure,), (Table(("part", "size", "value"), rows),))


def _tolerances(result: MechanismResult) -> Section:
    band = result.band
    rows = tuple(
        (
            s.tolerance.name,
            s.tolerance.path,
            f"{s.tolerance.half:.3g}",
            force_number(s.rms_cN, ".2f"),
            s.tolerance.source,
        )
        for s in band.shares
    )
    text = [
        f"Nine parts in ten give the press within {force_text(band.half_width_cN, '.1f')} of the middle, on "
        "average."
    ]
    for what, interval, digits in (
        ("Peak", band.peak_cN, 1),
        ("Valley", band.valley_cN, 1),
        ("Snap ratio", band.snap_ratio, 2),
    ):
        if interval:
            write, unit = (format, "") if digits == 2 else (force_number, f" {force_unit()}")
            low, high = (write(end, f".{digits}f") for end in interval)
            text.append(f"{what}: {low} to {high}{unit}.")
    columns = ("tolerance", "of", "±", f"alone, rms ({force_unit()})", "source")
    caption = "What each tolerance does alone, at its limit; the first matters most."
    return Section("Tolerances", tuple(text), (), (Table(columns, rows, caption),))


def _kinds(result: MechanismResult) -> Section:
    rows = tuple(
        (
            k.kind,
            "–" if k.residual is None else force_number(k.residual.press.rms_cN, ".2f"),
            "–" if k.residual is None else force_number(k.residual.release.rms_cN, ".2f"),
            k.refused or "; ".join(k.residual.reasons if k.residual else ()),
        )
        for k in result.kinds
    )
    columns = ("kind", *(f"{stroke}, rms ({force_unit()})" for stroke in ("press", "release")), "why")
    return Section("Kinds that were tried", (), (), (Table(columns, rows),))


def _twin(result: MechanismResult) -> Section:
    if not result.pressed:
        return Section("On the twin", (f"The twin cannot take this design: {result.twin_refused}.",))
    text = (
        "The design as a real button of the twin (button.toml), pressed slowly by a stiff tester and by the "
        "default person at speeds. Simulated.",
    )
    rows = tuple(_pressed_row(p) for p in result.pressed)
    columns = ("mm/s", "against", *(f"{stroke}, rms ({force_unit()})" for stroke in ("press", "release")))
    return Section("On the twin", text, (), (Table(columns, rows),))


def _pressed_row(pressed: PressedDesign) -> tuple[str, str, str, str]:
    against = "the model at that speed" if pressed.own_speed else "the model's slow curves"
    press, release = (f"{miss.rms_cN:.2f}" for miss in (pressed.press, pressed.release))
    return f"{pressed.speed_mm_s:g}", against, press, release
