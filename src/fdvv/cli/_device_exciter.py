"""fdvv device exciter: know how volts move the cap."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path

import click

from fdvv.cli._device_options import device_option, opened
from fdvv.cli._output import Finite, check_output, json_option, number, print_json, print_table, progress


@click.command()
@device_option
@click.option(
    "--rig",
    type=click.Path(path_type=Path, exists=True, dir_okay=False),
    help="TOML file of a simulated device's rig.",
)
@click.option(
    "--rig-known",
    type=click.Path(path_type=Path, exists=True, dir_okay=False),
    help="*.rig.json of this rig: the lag of its position sensor sharpens the gain.",
)
@click.option(
    "--tone-s",
    type=Finite(min=0.3, max=4),
    default=3.0,
    show_default=True,
    help="Length of each of 14 tones or so.",
)
@click.option(
    "--seed", type=click.IntRange(min=0), default=0, show_default=True, help="Of a simulated device."
)
@click.option("-o", "--output", type=click.Path(path_type=Path), help="The *.exciter.json to write.")
@json_option
def exciter(
    spec: str,
    rig: Path | None,
    rig_known: Path | None,
    tone_s: float,
    seed: int,
    output: Path | None,
    as_json: bool,
) -> None:
    """Know the exciter of a rig from tones that its position sensor sees; nobody touches the button.

    The motor holds the cap in the middle while tones of 260 to 860 Hz sound. Gain, resonance and quality are
    told with their standard errors; --exciter of other commands plays vibrations through the inverse.
    """  # fmt: skip
    from fdvv.compensate import load_rig
    from fdvv.vibration import EXCITER_SUFFIX, save_exciter
    from fdvv.workflow import identify_exciter

    check_output(output, EXCITER_SUFFIX)
    known = load_rig(rig_known) if rig_known else None
    with opened(spec, rig=rig, seed=seed) as found, progress("tones", 14) as advance:
        result = identify_exciter(found, known, tone_s, advance, lambda text: click.echo(text, err=True))
        name = found.info().name
    if output:
        save_exciter(result, output)
    if as_json:
        print_json({"device": name, **asdict(result)})
        return
    told = " (simulated)" if result.simulated else ""
    click.echo(f"{name}{told}, {result.tones} tones, {100 * result.residual_ratio:.0f} % rms off the fit")
    units = {"gain_m_s2_V": "gain, m/s2/V", "resonance_Hz": "resonance, Hz", "quality": "quality"}
    rows = [
        [label, number(getattr(result, key)), f"{100 * result.error[key]:.0f} %"]
        for key, label in units.items()
    ]
    print_table(["of the exciter on its cap", "found", "standard error"], rows)
    if output:
        click.echo(f"written to {output}")
