"""fdvv hardware selftest: which part of a rig is wrong."""

from __future__ import annotations

import sys
from dataclasses import asdict
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fdvv.cli import ui

if TYPE_CHECKING:
    from fdvv.device.remote import Remote
    from fdvv_rig.selftest.diagnosis import Diagnosis
    from fdvv_rig.selftest.evidence import Evidence


@click.command()
@ui.option(
    "--device",
    "spec",
    default="twin",
    help="twin (the firmware on the simulated rig), host, emulated or serial:PORT.",
)
@ui.option("--rig", type=ui.FILE, help="TOML file of a simulated rig.")
@ui.option("--fault", help="Break a simulated rig on purpose; 'list' names what can be broken.")
@ui.option("--no-exciter", is_flag=True, help="None is fitted.")
@ui.option("--apply", "apply", is_flag=True, help="If every part passes, give the device its calibration.")
@ui.option("--seed", type=ui.COUNT, default=0, help="Of a simulated rig.")
@ui.option("-o", "--output", type=ui.PATH, help="Write a receipt (.json) if every part passes.")
@ui.json_option
def selftest(
    spec: str,
    rig: Path | None,
    fault: str | None,
    no_exciter: bool,
    apply: bool,
    seed: int,
    output: Path | None,
    as_json: bool,
) -> None:
    """Try every part of a rig and name the one that is wrong; exit status 1 if one fails.

    Nobody presses: gauges of 4.5 and 2 mm go under the cap and 50 g onto its force sensor, as you are asked.
    Only a test that every part passed leaves a receipt; without --output nothing is written.
    """  # fmt: skip
    from fdvv_rig.selftest.diagnosis import diagnose
    from fdvv_rig.selftest.faults import RIG_FAULTS
    from fdvv_rig.selftest.measure import measure_rig
    from fdvv_rig.selftest.open import open_rig

    if fault == "list":
        ui.print_table(
            ["fault", "part", "what is wrong"], [[n, f.part, f.about] for n, f in RIG_FAULTS.items()], left=3
        )
        return
    ui.check_output(output, ".json")
    _check_person(spec)
    device, hands = open_rig(spec, _ask, rig, seed, fault)
    try:
        with ui.stages() as advance:
            evidence = measure_rig(device, hands, advance, exciter=not no_exciter)
        found = diagnose(evidence)
        document = _document(device, found, evidence)
        if found.passed:
            _finish(device, found, evidence, document, output, apply)
    finally:
        device.close()
    _show(document, found, as_json)
    if not found.passed:
        raise click.exceptions.Exit(1)


def _check_person(spec: str) -> None:
    """Refuse a real rig where nobody can answer. Raises InputError."""
    from fdvv.errors import InputError

    if spec.startswith("serial:") and not sys.stdin.isatty():
        raise InputError("--device", spec, "a person must lay gauges and a weight", "run it in a terminal")


def _ask(text: str) -> None:
    click.echo(f"{text} Then press Enter.", err=True)
    sys.stdin.readline()


def _document(device: Remote, found: Diagnosis, evidence: Evidence) -> dict[str, Any]:
    info = device.info()
    return {
        "device": info.name,
        "simulated": info.simulated,
        "passed": found.passed,
        "wrong": found.wrong.part if found.wrong else None,
        "parts": [asdict(one) for one in found.findings],
        "evidence": asdict(evidence),
        "settings": {},
        "receipt": None,
    }


def _finish(
    device: Remote,
    found: Diagnosis,
    evidence: Evidence,
    document: dict[str, Any],
    output: Path | None,
    apply: bool,
) -> None:
    from fdvv_rig.selftest.receipt import calibrated, changed, write_selftest

    before = device.settings()
    after = calibrated(before, evidence)
    document["settings"] = changed(before, after)
    if apply:
        device.configure(after)
    if output:
        head = {
            "device": document["device"],
            "serial": device.client.hello.serial,
            "simulated": document["simulated"],
            "tested": datetime.now(UTC).isoformat(timespec="seconds"),
            "settings": document["settings"],
        }
        write_selftest(output, found, evidence, head)
        document["receipt"] = str(output)


def _show(document: dict[str, Any], found: Diagnosis, as_json: bool) -> None:
    from fdvv_rig.selftest.diagnosis import Verdict

    if as_json:
        ui.print_json(document)
    else:
        source = f"{document['device']}{' (simulated)' if document['simulated'] else ''}"
        click.echo(f"{source}: {'every part passed' if found.passed else 'not every part passed'}")
        ui.print_table(
            ["part", "verdict", "what was seen"],
            [[one.part, str(one.verdict), one.evidence] for one in found.findings],
            left=3,
        )
        for name, value in document["settings"].items():
            click.echo(f"calibration: {name} = {value}")
        if document["receipt"]:
            click.echo(f"receipt written to {document['receipt']}")
    if not found.passed and not found.wrong:
        missing = ", ".join(f.part for f in found.findings if f.verdict is Verdict.NOT_TESTED)
        click.echo(f"fdvv: not tested: {missing}; {'; '.join(document['evidence']['notes'])}", err=True)
    if found.wrong:
        click.echo(f"fdvv: {found.wrong.part}: {found.wrong.evidence}; {found.wrong.remedy}", err=True)
