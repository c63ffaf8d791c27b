"""fdvv program render."""

from __future__ import annotations

from pathlib import Path

import click

from fdvv.button.open import open_button
from fdvv.cli import ui
from fdvv.cli.options import opened, opened_jnds
from fdvv.cli.rendering.session import recommended_for
from fdvv.compensation.identification.rig_file import LearnedRig, load_learned_rig
from fdvv.device.contract import Device
from fdvv.device.twin import TwinDevice
from fdvv.errors import InputError
from fdvv.force_text import ForceTitle, force_text
from fdvv.io.files import write_atomic
from fdvv.program.library import open_program
from fdvv.program.program import Program
from fdvv.rendering.actuation_file import load_actuation
from fdvv.rendering.program_render import ProgramRendering, ProgramReport, judge_rendering, rendering_of

IDENTIFY = "identify it with fdvv compensate BUTTON --save-rig FILE.rig.json"
HARD_cN = 400.0
"""An impact beyond what the rig itself may push with is worth a warning."""


def render(
    name: str,
    rig_known: Path | None,
    learned: Path | None,
    output: Path | None,
    spec: str,
    rig: Path | None,
    seed: int,
    velocities_mm_s: tuple[float, ...],
    presses: int,
    jnds_from: Path | None,
    as_json: bool,
) -> None:
    """Render a program, and print what it leaves in every state."""
    ui.check_output(output, ".fdvv-image")
    if rig_known is None:
        raise InputError("--rig-known", "option", "the rig is not known", IDENTIFY)
    program, known, jnds = open_program(name), load_learned_rig(rig_known), opened_jnds(jnds_from)
    with opened(spec, None, rig or recommended_for(spec), seed) as device:
        rendering = _rendering(program, device, known, learned)
        if output:
            write_atomic(output, rendering.image)
        if isinstance(device, TwinDevice):
            report = judge_rendering(device, program, rendering, velocities_mm_s, presses, jnds)
            _print(report, as_json)
        else:
            rendering.put_on(device)
            _print_active(device.info().name, program, rendering, as_json)
    if not as_json:
        ui.print_written(output)


def _rendering(program: Program, device: Device, known: LearnedRig, learned: Path | None) -> ProgramRendering:
    if learned is None:
        return rendering_of(program, device, known)
    actuation = load_actuation(learned)
    return rendering_of(program, device, known, actuation, open_button(actuation.model_name))


def _print_active(device: str, program: Program, rendering: ProgramRendering, as_json: bool) -> None:
    document = {"program": program.name, "device": device, "bytes": len(rendering.image)}
    if as_json:
        ui.print_json(document)
        return
    click.echo(f"{device}: {program.name} is active, compensated for this rig, {len(rendering.image)} bytes")


def _print(report: ProgramReport, as_json: bool) -> None:
    if as_json:
        ui.print_json(report.to_dict())
        return
    how = "force loop closed" if report.closed else "commands of this rig, no force loop"
    click.echo(f"{report.program} on {report.device}{ui.simulated(True)}, {how}")
    before = {(r.state, r.stroke, r.velocity_mm_s): r for r in report.as_is if r.bins}
    rows = [
        [
            f"{row.state}, {row.stroke} at {row.velocity_mm_s:g} mm/s",
            was.mean_cN if (was := before.get((row.state, row.stroke, row.velocity_mm_s))) else None,
            *(row.mean_cN, row.median_cN, row.max_cN),
        ]
        for row in report.rendered
        if row.bins
    ]
    ui.print_table(["state", *map(ForceTitle, ("as it is: mean {}", "mean {}", "median {}", "max {}"))], rows)
    ui.print_wrapped(report.verdict)
    for row in report.worse:
        ui.print_warnings([f"{row.state!r} on the {row.stroke} is rendered worse than as it is"])
    if report.impact_cN > HARD_cN:
        ui.print_warnings(
            [
                f"a cap that was free meets the finger with {force_text(report.impact_cN, '.0f')}: weaken "
                "its throw"
            ]
        )
    ui.print_wrapped(f"next: {report.next_step}")
