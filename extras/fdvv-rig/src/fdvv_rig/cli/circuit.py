"""fdvv hardware bill and circuit: what to buy, and what is connected to what."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from fdvv.cli import ui
from fdvv.force_text import force_number, force_text, force_unit

rig_option = ui.option(
    "--rig",
    type=click.Choice(["paper", "recommended"]),
    default="paper",
    help="The paper's rig, or the recommended one: load cell, current drive, ATSAMD51.",
)


@click.command()
@ui.option("--csv", "as_csv", is_flag=True, help="Print the lines as CSV and nothing else.")
@rig_option
@ui.json_option
def bill(as_csv: bool, rig: str, as_json: bool) -> None:
    """List what to buy: makers, part numbers, alternatives, counts, prices, beside the paper's cost.

    Counts come from the circuit and the printed parts. Prices are estimates with their date.
    """
    from fdvv.errors import InputError
    from fdvv_rig.bill import PAPER_USD, group_totals, load_bill, summary, to_csv
    from fdvv_rig.circuit.circuit import load_circuit

    if as_csv and as_json:
        raise InputError("--csv", "with --json", "only one of them can be printed", "leave one out")
    found = load_bill(load_circuit(rig=rig))
    if as_csv:
        click.echo(to_csv(found), nl=False)
        return
    if as_json:
        totals = {f"{group}_USD": total for group, total in group_totals(found).items()}
        ui.print_json({"lines": found.rows(), "total_USD": found.total_USD, "paper_USD": PAPER_USD} | totals)
        return
    ui.print_table(
        ["role", "maker", "part number", "count", "USD"],
        [
            [b.role, b.maker, b.part_number[:34], str(b.count), "quote" if b.asked else f"{b.total_USD:.2f}"]
            for b in found.lines
        ],
        left=3,
    )
    ui.print_wrapped(summary(found))


@click.command()
@ui.option("--file", "file", type=ui.FILE, help="Another circuit's TOML in place of the rig's own.")
@rig_option
@ui.option(
    "-o",
    "--output",
    type=ui.NEW_FOLDER,
    help="Write diagrams (SVG), netlists (KiCad, JSON), wiring table and values into this folder.",
)
@ui.json_option
def circuit(file: Path | None, rig: str, output: Path | None, as_json: bool) -> None:
    """Check the circuit and tell what follows from its values; exit status 1 if a rule is broken.

    Cut-offs of the filters, steps of the converters, power of every rail, the coil's current and warmth.
    """
    from fdvv.io.files import write_atomic
    from fdvv_rig.circuit.circuit import RIGS, load_circuit
    from fdvv_rig.circuit.circuit_report import circuit_files, circuit_report
    from fdvv_rig.circuit.netlist import to_document
    from fdvv_rig.circuit.rules import require_sound

    found = load_circuit(file, rig)
    if output:
        require_sound(found, file or RIGS[rig])
        ui.check_folder(output)
        for name, text in circuit_files(found).items():
            write_atomic(output / name, text)
    report = circuit_report(found)
    if as_json:
        ui.print_json(report | {"netlist": to_document(found)})
    else:
        _print(report)
        if output:
            click.echo(f"written to {output}")
    if report["violations"]:
        raise click.exceptions.Exit(1)


def _print(report: dict[str, Any]) -> None:
    click.echo(f"{report['title']}: {report['parts']} parts, {report['nets']} nets")
    for one in report["violations"]:
        ui.print_wrapped(f"{one['place']}: {one['reason']}; {one['remedy']}")
    if report["violations"]:
        return
    click.echo("every rule holds: pins, levels, floating inputs, rest levels, power")
    click.echo("")
    ui.print_table(
        ["filter", "cut-off Hz", "lowest", "highest", "time ms", "lag um", "paper Hz"],
        [
            [
                f["name"],
                *(f"{f[key]:.1f}" for key in ("cutoff_Hz", "lowest_Hz", "highest_Hz")),
                *(f"{f[key]:.3f}" for key in ("time_ms", "lag_um")),
                ", ".join(f"{value:g}" for value in f["paper_Hz"]) or "–",
            ]
            for f in report["filters"]
        ],
    )
    click.echo(f"the paper's 333 ohm and 1 uF make {report['paper_parts_cutoff_Hz']:.1f} Hz")
    click.echo("")
    ui.print_table(
        ["step of the converter", "at the pin mV", "value", "unit"],
        [[s["name"], f"{s['volts_mV']:.3f}", *_step(s)] for s in report["converter_steps"]],
    )
    click.echo("")
    ui.print_table(
        ["source", "V", "usual mA", "peak mA", "limit mA"],
        [
            [r["source"], *(f"{r[key]:g}" for key in ("V", "usual_mA", "peak_mA", "limit_mA"))]
            for r in report["rails"]
        ],
    )
    click.echo("")
    ui.print_wrapped(_coil(report["coil"]))


def _step(step: dict[str, Any]) -> tuple[str, str]:
    if step["unit"] == "cN":
        return force_number(step["value"], ".3f"), force_unit()
    return f"{step['value']:.3f}", step["unit"]


def _coil(coil: dict[str, Any]) -> str:
    at = f"coil at {force_text(coil['force_cN'], '.0f')}: {coil['current_A']:.2f} A, {coil['heat_W']:.1f} W"
    if "chop_A" in coil:
        warm = f"{coil['rise_K']:.0f} K warmer if held for ever"
        return f"{at}, {warm}; the bridge chops at {coil['chop_A']:.2f} A"
    step = f"a step of the converter {force_text(coil['step_cN'], '.2f')}"
    return f"{at}; bandwidth of the current {coil['loop_Hz']:.0f} Hz; {step}"
