"""fdvv mechanism: springs, leaves and domes that give a model's curves."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from fdvv.cli._output import (
    Finite,
    check_folder,
    json_option,
    number,
    print_json,
    print_table,
    print_wrapped,
    stages,
)

if TYPE_CHECKING:
    from fdvv.workflow import MechanismResult


@click.command()
@click.argument("model")
@click.option(
    "--kind",
    type=click.Choice(["auto", "spring", "leaf", "dome"]),
    default="auto",
    show_default=True,
    help="What to design; auto tries all and takes the simplest of the best.",
)
@click.option(
    "--wire",
    type=click.Choice(["steel", "stainless"]),
    default="steel",
    show_default=True,
    help="Of the spring.",
)
@click.option(
    "--strip",
    type=click.Choice(["beryllium-copper", "bronze", "stainless"]),
    default="beryllium-copper",
    show_default=True,
    help="Of the leaf.",
)
@click.option(
    "--friction",
    "friction_ratio",
    type=Finite(min=0.02, max=0.6),
    default=0.2,
    show_default=True,
    help="Coefficient between leaf and cam.",
)
@click.option(
    "--speed",
    "speeds_mm_s",
    type=Finite(min=5, max=500),
    multiple=True,
    default=(50.0, 100.0, 200.0),
    show_default=True,
    help="Press the design on the twin at this speed too, mm/s; repeatable.",
)
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path, file_okay=False),
    help="Write all files into this folder.",
)
@json_option
def mechanism(
    model: str,
    kind: str,
    wire: str,
    strip: str,
    friction_ratio: float,
    speeds_mm_s: tuple[float, ...],
    output: Path | None,
    as_json: bool,
) -> None:
    """Design a real switch that gives a model's curves.

    MODEL is a built-in, a *.fdvv.json file or a measured file. A coil, a coil with a leaf on a cam, or a
    rubber dome is designed for its slowest press and release, in sizes that can be bought or made. The
    command tells what is missed and why, what tolerances do, and presses the design on the twin (simulated).
    The folder gets sizes, curves, cam and drawings (DXF), a button for fdvv press, and a report. Exit status
    1: nothing that can be made comes within 3 cN rms on both strokes.
    """
    from fdvv.mechanism import Making
    from fdvv.workflow import design_mechanism, open_model, write_mechanism

    if output:
        check_folder(output)
    opened = open_model(model)
    making = Making(wire=wire, strip=strip, friction_ratio=friction_ratio)
    with stages() as told:
        result = design_mechanism(opened, kind, making, speeds_mm_s, told)
    written = write_mechanism(result, output) if output else ()
    if as_json:
        print_json({**result.to_dict(), "files": [str(path) for path in written]})
    else:
        _print(result)
        if output:
            click.echo(f"written: {output} ({', '.join(path.name for path in written)})")
    raise click.exceptions.Exit(0 if result.met else 1)


def _print(result: MechanismResult) -> None:
    """Print the choice, the sizes, what is missed and why, the tolerances and the twin's word."""
    from fdvv.mechanism import facts_of

    print_wrapped(f"{result.model.name}: {result.recommendation}")
    for part, facts in facts_of(result.mechanism, result.target).items():
        told = (v if isinstance(v, str) else f"{name} {v:.4g}" for name, v in facts.items())
        print_wrapped(f"{part}: {', '.join(told)}")
    for reason in (*result.residual.reasons, *result.notes):
        print_wrapped(reason)
    _print_tolerances(result)
    _print_misses(result)


def _print_tolerances(result: MechanismResult) -> None:
    band, worst = result.band, result.band.shares[:3]
    told = ", ".join(f"{s.tolerance.name} {s.rms_cN:.1f}" for s in worst)
    bump = ""
    if band.peak_cN and band.snap_ratio:
        bump = (
            f", peak {band.peak_cN[0]:.0f} to {band.peak_cN[1]:.0f} cN, "
            f"snap ratio {band.snap_ratio[0]:.2f} to {band.snap_ratio[1]:.2f}"
        )
    print_wrapped(
        f"within tolerance, 5 to 95 %: press ± {band.half_width_cN:.1f} cN{bump}; most from (cN rms): {told}"
    )


def _print_misses(result: MechanismResult) -> None:
    residual = result.residual
    rows = [["design", number(residual.press.rms_cN), number(residual.release.rms_cN), "the slow curves"]]
    for p in result.pressed:
        against = "the model at that speed" if p.own_speed else "the slow curves"
        name = f"twin {p.speed_mm_s:g} mm/s (simulated)"
        rows.append([name, number(p.press.rms_cN), number(p.release.rms_cN), against])
    print_table(["missed, cN rms", "press", "release", "against"], rows)
    if result.twin_refused:
        print_wrapped(f"the twin cannot take this design: {result.twin_refused}")
