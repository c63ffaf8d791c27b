"""fdvv program: list, show, make, check, compile and render."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fdvv.cli import ui
from fdvv.cli.options import jnds_option
from fdvv.errors import InputError
from fdvv.force_text import force_name, force_number, force_text
from fdvv.io.files import write_atomic

if TYPE_CHECKING:
    from fdvv.program.check import Report
    from fdvv.program.program import Program, State
    from fdvv.program.surface import Limits

weight_option = ui.option(
    "--weight-cN",
    "weight_cN",
    type=ui.Force(min=-400, max=400),
    help="Weight that the rig's force carries; 19.6 by default, 0 for a rig that lies.",
)
opposing_option = ui.option(
    "--opposing-cN",
    "opposing_cN",
    type=ui.Force(min=0),
    help="Friction that may keep the cap down; 5 by default.",
)


@click.group()
def program() -> None:
    """Work with programs: list, show, make, check, compile, render.

    A program is what a device runs: states with their forces, and what leads from one to another.
    PROGRAM is a shipped program's name or a *.fdvv-program.json file (docs/reference/program-file.md).
    """


@program.command("list")
@ui.json_option
def list_(as_json: bool) -> None:
    """List the shipped programs and their parameters."""
    from fdvv.program.library import programs

    found = programs()
    if as_json:
        entries = [
            {key: getattr(p, key) for key in ("name", "summary", "details")}
            | {"parameters": {q.name: q.default for q in p.parameters}}
            for p in found
        ]
        ui.print_json({"programs": entries})
        return
    for recipe in found:
        ui.print_wrapped(f"{recipe.name}: {recipe.summary}")
        if recipe.parameters:
            click.echo("  " + ", ".join(f"{p.name}={p.default:g}" for p in recipe.parameters))


@program.command()
@click.argument("program")
@ui.json_option
def show(program: str, as_json: bool) -> None:
    """Show the states of a program and what leads from one to another.

    PROGRAM may also be a compiled image, whose parts are numbered.
    """
    from fdvv.program.describe import describe
    from fdvv.program.library import open_program

    path = Path(program)
    if path.is_file() and path.read_bytes()[:4] == b"FDVP":
        parts: Any = describe(path.read_bytes(), path)
        title = f"{parts.name}: image of {parts.size_bytes} bytes"
    else:
        parts = open_program(program)
        title = f"{parts.name}: {parts.description}"
    if as_json:
        ui.print_json(dataclasses.asdict(parts))
        return
    ui.print_wrapped(title)
    click.echo(f"  travel {parts.travel_mm:g} mm, starts in {parts.start!r}")
    rows = [_row(state) for state in parts.states]
    ui.print_table(
        ["state", "press", "release", "plays", "key", "fade_ms", force_name("bias_cN")], rows, left=4
    )
    for state in parts.states:
        for transition in state.transitions:
            click.echo(f"{state.name}: {transition}")


def _row(state: State) -> list[object]:
    plays = [
        state.enter_signal or "",
        f"{state.repeat_signal}/{state.repeat_ms} ms" if state.repeat_ms else "",
    ]
    bias: object = state.bias_cN
    if state.bias_ms:
        bias = "…".join(map(force_number, (state.bias_cN, state.bias_end_cN)))
    played = ", ".join(filter(None, plays)) or "–"
    return [state.name, state.press, state.release, played, state.key, state.fade_ms, bias]


@program.command()
@click.argument("name")
@ui.option("--base", help="Button it stands on: a built-in, a *.fdvv.json or a measured file.")
@ui.option("--set", "given", multiple=True, metavar="NAME=NUMBER", help="A parameter; may be repeated.")
@ui.option("-o", "--output", type=ui.NEW_FILE, required=True, help="The *.fdvv-program.json to write.")
def make(name: str, base: str | None, given: tuple[str, ...], output: Path) -> None:
    """Make a shipped program with parameters of your own, over a button of your choice.

    NAME is one of fdvv program list, as in: make rapid-trigger --set press_mm=0.1 -o r.fdvv-program.json
    """
    from fdvv.button.open import open_button
    from fdvv.program.check import check_program
    from fdvv.program.file import PROGRAM_SUFFIX, save_program
    from fdvv.program.library import make as make_shipped

    ui.check_output(output, PROGRAM_SUFFIX)
    model = None if base is None else open_button(base)
    made = make_shipped(name, model, **dict(map(_parameter, given)))
    save_program(made, output)
    click.echo(f"{output}: {ui.counted(len(made.states), 'state')}, travel {made.travel_mm:.3f} mm")
    refused = check_program(made).refused
    ui.print_warnings(
        [f"a rig refuses it: {one}; {one.remedy}, with --set or another base" for one in refused[:1]]
    )


def _parameter(text: str) -> tuple[str, float]:
    name, equals, value = text.partition("=")
    try:
        if not equals:
            raise ValueError
        return name.strip().replace("-", "_"), float(value)
    except ValueError:
        raise InputError(
            "--set", "parameter", f"{text!r} is not NAME=NUMBER", "write e.g. trigger_mm=1.2"
        ) from None


@program.command()
@click.argument("program")
@weight_option
@opposing_option
@ui.json_option
def check(program: str, weight_cN: float | None, opposing_cN: float | None, as_json: bool) -> None:
    """Check a program against the paper's rig: forces, heat, hangs, and that the cap comes back.

    Exit status 1 if it is refused. What is proven is in docs/explanation/programs.md.
    """
    from fdvv.program.check import check_program
    from fdvv.program.library import open_program

    opened = open_program(program)
    report = check_program(opened, _limits(weight_cN, opposing_cN))
    if as_json:
        ui.print_json(_report(opened, report))
    else:
        for finding in report.findings:
            ui.print_wrapped(f"{finding.severity}: {finding}")
        click.echo(f"{opened.name}: {'refused' if report.refused else 'accepted'}")
        if report.return_s is not None:
            click.echo(f"  back at the top within {report.return_s:.2f} s of letting go")
        click.echo(
            f"  steepest {force_text(report.stiffness_cN_mm, '.0f', per='/mm')}, coil {report.rise_K:.1f} K "
            "warmer if held"
        )
    if report.refused:
        raise click.exceptions.Exit(1)


def _limits(weight_cN: float | None, opposing_cN: float | None) -> Limits:
    from fdvv.program.surface import Limits

    limits: dict[str, Any] = {"weight_cN": weight_cN, "opposing_cN": opposing_cN}
    return Limits(**{name: value for name, value in limits.items() if value is not None})


def _report(opened: Program, report: Report) -> dict[str, Any]:
    findings = [
        {"severity": str(f.severity), "state": f.state, "place": f.place, "reason": f.reason}
        for f in report.findings
    ]
    return {
        "name": opened.name,
        "accepted": not report.refused,
        **{key: getattr(report, key) for key in ("return_s", "stiffness_cN_mm", "rise_K")},
        "findings": findings,
    }


@program.command("compile")
@click.argument("program")
@weight_option
@opposing_option
@ui.option("-o", "--output", type=ui.NEW_FILE, required=True, help="The *.fdvv-image to write.")
@ui.json_option
def compile_(
    program: str, weight_cN: float | None, opposing_cN: float | None, output: Path, as_json: bool
) -> None:
    """Check a program and compile it to the image that a device takes.

    Columns of a surface are evenly spaced in an image; the output says what that and rounding cost.
    """
    from fdvv.program.check import require_accepted
    from fdvv.program.compile import compile_program
    from fdvv.program.library import open_program

    ui.check_output(output, ".fdvv-image")
    opened = open_program(program)
    limits = _limits(weight_cN, opposing_cN)
    report = require_accepted(opened, limits)
    compiled = compile_program(opened, limits)
    write_atomic(output, compiled.image)
    if as_json:
        surfaces = {
            name: {"columns": columns, "grid_error_cN": compiled.grid_error_cN[name]}
            for name, columns in compiled.columns.items()
        }
        ui.print_json({"output": str(output), "bytes": len(compiled.image), "surfaces": surfaces})
    else:
        worst_cN = max(compiled.grid_error_cN.values())
        click.echo(f"{output}: {len(compiled.image)} bytes, forces within {force_text(worst_cN, '.2f')}")
    ui.print_warnings([str(finding) for finding in report.warnings])


@program.command()
@click.argument("program")
@ui.option(
    "--rig-known", type=ui.FILE, help="*.rig.json of this rig, as fdvv compensate --save-rig writes it."
)
@ui.option("--learned", type=ui.FILE, help="*.actuation.json of a button whose surfaces the program has.")
@ui.option("--device", "spec", default="twin", help="'twin' is simulated; see fdvv device.")
@ui.option(
    "--rig",
    type=ui.RIG,
    help="Of the twin: a TOML file or a name, recommended unless you say.",
)
@ui.option("--seed", type=ui.COUNT, default=0, help="Repeats the twin.")
@ui.speeds_option("--velocity", "velocities_mm_s", help="mm/s; repeatable.")
@ui.option("--presses", type=click.IntRange(1, 50), default=3, help="Per speed, as it is and rendered.")
@ui.option("-o", "--output", type=ui.NEW_FILE, help="The *.fdvv-image to write, for this rig.")
@jnds_option
@ui.json_option
def render(
    program: str, rig_known: Path | None, learned: Path | None, output: Path | None, **options: Any
) -> None:
    """Render a program on an identified rig, and measure in every state how it is felt.

    A rig with a load cell holds the program's forces with its loop closed; on another one they become the
    commands that this rig needs. The twin presses the program as it is and as it is rendered: errors are at
    the finger, in true displacement, against what the active state intends. Any other device gets the
    rendering and is ready to be pressed.
    """
    from fdvv.cli.program_render import render as run

    run(program, rig_known, learned, output, **options)
