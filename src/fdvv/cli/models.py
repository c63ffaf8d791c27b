"""fdvv merge and assign: make models out of models."""

from __future__ import annotations

from pathlib import Path

import click

from fdvv.cli._output import Finite, check_output, counted

OUTPUT = click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path, dir_okay=False),
    required=True,
    help="The *.fdvv.json to write.",
)


@click.command()
@click.argument("parts", nargs=-1, required=True)
@click.option("--name", required=True, help="Name of the merged button.")
@click.option(
    "--travel-mm", type=Finite(min=0, max=1000, min_open=True), help="Needed where the parts' travels differ."
)
@click.option("--actuation-mm", type=Finite(min=0), help="Needed where the parts' points differ.")
@click.option("--reset-mm", type=Finite(min=0), help="Needed where the parts' points differ.")
@click.option(
    "--conflict",
    type=click.Choice(["refuse", "first", "last"]),
    default="refuse",
    show_default=True,
    help="What to do with two different curves of one stroke and velocity.",
)
@OUTPUT
def merge(
    parts: tuple[str, ...],
    name: str,
    travel_mm: float | None,
    actuation_mm: float | None,
    reset_mm: float | None,
    conflict: str,
    output: Path,
) -> None:
    """Merge force curves at several velocities into one FDVV model.

    PARTS are FILE[:press|:release][@VELOCITY]: a built-in, a *.fdvv.json or a measured file; only that
    stroke of it; declared to be of that velocity in mm/s. Example: merge slow.csv@0.5 fast.csv:press@100
    """
    from fdvv.errors import ModelError
    from fdvv.model import SUFFIX, save_model
    from fdvv.workflow import merge_parts

    check_output(output, SUFFIX)
    try:
        model = merge_parts(parts, name, travel_mm, actuation_mm, reset_mm, conflict)
    except ModelError as error:
        raise click.UsageError(_as_option(str(error))) from error
    save_model(model, output)
    click.echo(f"{output}: {counted(len(model.curves), 'curve')}, travel {model.travel_mm:.3f} mm")


def _as_option(reason: str) -> str:
    """Turn the arguments that a model names into the options of this command."""
    for field in ("travel_mm", "actuation_mm", "reset_mm"):
        reason = reason.replace(f"pass {field}", f"pass --{field.replace('_', '-')}")
    return reason.replace('pass conflict="first" or "last"', "pass --conflict first or last")


@click.command()
@click.argument("button")
@click.argument("curve")
@click.option(
    "--stroke", type=click.Choice(["press", "release"]), required=True, help="What the curve becomes."
)
@click.option("--velocity", "velocity_mm_s", type=Finite(min=0, min_open=True), help="At which speed (mm/s).")
@click.option(
    "--segment", "segment_mm", type=Finite(), nargs=2, metavar="FROM TO", help="Only this part of it (mm)."
)
@click.option(
    "--blend-mm", type=Finite(min=0, min_open=True), default=0.1, show_default=True,
    help="Width over which old and new meet at the segment's ends.",
)  # fmt: skip
@OUTPUT
def assign(
    button: str,
    curve: str,
    stroke: str,
    velocity_mm_s: float | None,
    segment_mm: tuple[float, float] | None,
    blend_mm: float,
    output: Path,
) -> None:
    """Give a curve, or a segment of one, to press or release of a model.

    BUTTON is the model that is changed (a copy is written); CURVE is FILE[:press|:release], whose own
    stroke and velocity do not matter.
    """
    from fdvv.model import SUFFIX, save_model
    from fdvv.model import assign as assign_curve
    from fdvv.workflow import one_curve, open_model

    check_output(output, SUFFIX)

    model = assign_curve(open_model(button), one_curve(curve), stroke, velocity_mm_s, segment_mm, blend_mm)
    save_model(model, output)
    click.echo(f"{output}: {counted(len(model.curves), 'curve')}")
