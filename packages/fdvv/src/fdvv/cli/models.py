"""fdvv merge and assign: make models out of models."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from fdvv.cli import ui
from fdvv.errors import ModelError

OUTPUT = ui.option("-o", "--output", type=ui.NEW_FILE, required=True, help="The *.fdvv.json to write.")


@click.command()
@click.argument("parts", nargs=-1, required=True)
@ui.option("--name", required=True, help="Name of the merged button.")
@ui.option("--travel-mm", type=ui.above_0(1000), help="If the parts' travels differ.")
@ui.option("--actuation-mm", type=ui.Finite(min=0), help="Needed where the parts' points differ.")
@ui.option("--reset-mm", type=ui.Finite(min=0), help="Needed where the parts' points differ.")
@ui.choice_option(
    "--conflict", ("refuse", "first", "last"), help="If two curves of one stroke and velocity differ."
)
@OUTPUT
def merge(parts: tuple[str, ...], output: Path, **options: Any) -> None:
    """Merge force curves at several velocities into one FDVV model.

    PARTS are FILE[:press|:release][@VELOCITY]: a built-in, a *.fdvv.json or a measured file; only that
    stroke of it; declared to be of that velocity in mm/s. Example: merge slow.csv@0.5 fast.csv:press@100
    """
    from fdvv.button.open import merge_parts
    from fdvv.model.file import MODEL_SUFFIX, save_model

    ui.check_output(output, MODEL_SUFFIX)
    try:
        model = merge_parts(parts, **options)
    except ModelError as error:
        raise click.UsageError(_as_option(str(error))) from error
    save_model(model, output)
    click.echo(f"{output}: {ui.counted(len(model.curves), 'curve')}, travel {model.travel_mm:.3f} mm")


def _as_option(reason: str) -> str:
    """Turn the arguments that a model names into the options of this command."""
    for field in ("travel_mm", "actuation_mm", "reset_mm"):
        reason = reason.replace(f"pass {field}", f"pass --{field.replace('_', '-')}")
    return reason.replace('pass conflict="first" or "last"', "pass --conflict first or last")


@click.command()
@click.argument("button")
@click.argument("curve")
@ui.option("--stroke", type=ui.STROKE, required=True, help="What the curve becomes.")
@ui.velocity_option(help="At which speed (mm/s).")
@ui.option(
    "--segment", "segment_mm", type=ui.Finite(), nargs=2, metavar="FROM TO", help="Only this part of it (mm)."
)
@ui.option("--blend-mm", type=ui.POSITIVE, default=0.1, help="Width of the transition at the segment's ends.")
@OUTPUT
def assign(button: str, curve: str, output: Path, **options: Any) -> None:
    """Assign a curve, or a segment of one, to press or release of a model.

    BUTTON is the model that is changed (a copy is written); CURVE is FILE[:press|:release], whose own
    stroke and velocity do not matter.
    """
    from fdvv.button.open import one_curve, open_button
    from fdvv.model.edit import assign as assign_curve
    from fdvv.model.file import MODEL_SUFFIX, save_model

    ui.check_output(output, MODEL_SUFFIX)
    model = assign_curve(open_button(button), one_curve(curve), **options)
    save_model(model, output)
    click.echo(f"{output}: {ui.counted(len(model.curves), 'curve')}")
