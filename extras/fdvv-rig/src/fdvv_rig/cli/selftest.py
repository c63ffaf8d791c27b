"""fdvv hardware selftest: which part of a rig is wrong."""

from __future__ import annotations

from dataclasses import asdict
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fdvv.cli._output import check_output, json_option, print_json, print_table, stages

if TYPE_CHECKING:
    from fdvv.device import Remote
    from fdvv.hardware import Diagnosis, Evidence


@click.command()
@click.option(
    "--device",
    "spec",
    default="twin",
    show_default=True,
    help="twin (the firmware on the simulated rig), host, emulated or serial:PORT.",
)
@click.option(
    "--rig",
    type=click.Path(path_type=Path, exists=True, dir_okay=False),
    help="TOML file of a simulated rig.",
)
@click.option("--fault", help="Break a simulated rig on purpose; 'list' names what can be broken.")
@click.option("--no-exciter", is_flag=True, help="None is fitted.")
@click.option("--apply", "apply", is_flag=True, help="If every part passes, give the device its calibration.")
@click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True, help="Of a simulated rig.")
@click.option(
    "-o", "--output", type=click.Path(path_type=Path), help="Write a receipt (.json) if every part passes."
)
@json_option
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
    from fdvv.hardware import diagnose
    from fdvv.workflow import RIG_FAULTS, measure_rig, open_rig

    if fault == "list":
        print_table(
            ["fault", "part", "what is wrong"], [[n, f.part, f.about] for n, f in RIG_FAULTS.items()], left=3
        )
        return
    check_output(output, ".json")
    _check_person(spec)
    device, hands = open_rig(spec, _ask, rig, seed, fault)
    try:
        with stages() as advance:
            evidence = measure_rig(device, hands, advance, exciter=not no_exciter)
        found = diagnose(evidence)
        told = _told(device, found, evidence)
        if found.passed:
            _finish(device, found, evidence, told, output, apply)
    finally:
        device.close()
    _show(told, found, as_json)
    if not found.passed:
        raise click.exceptions.Exit(1)


def _check_person(spec: str) -> None:
    """Refuse a real rig where nobody can answer. Raises InputError."""
    import sys

    from fdvv.errors import InputError

    if spec.startswith("serial:") and not sys.stdin.isatty():
        raise InputError("--device", spec, "a person must lay gauges and a weight", "run it in a terminal")


def _ask(text: str) -> None:
    """Say what to do and wait for Enter."""
    import sys

    click.echo(f"{text} Then press Enter.", err=True)
    sys.stdin.readline()


def _told(device: Remote, found: Diagnosis, evidence: Evidence) -> dict[str, Any]:
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
    told: dict[str, Any],
    output: Path | None,
    apply: bool,
) -> None:
    """Work the calibration out, give it to the device if asked, and leave a receipt."""
    from fdvv.workflow import calibrated, changed, write_selftest

    before = device.settings()
    after = calibrated(before, evidence)
    told["settings"] = changed(before, after)
    if apply:
        device.configure(after)
    if output:
        head = {
            "device": told["device"],
            "serial": device.client.hello.serial,
            "simulated": told["simulated"],
            "tested": datetime.now(UTC).isoformat(timespec="seconds"),
            "settings": told["settings"],
        }
        write_selftest(output, found, evidence, head)
        told["receipt"] = str(output)


def _show(told: dict[str, Any], found: Diagnosis, as_json: bool) -> None:
    from fdvv.hardware import Verdict

    if as_json:
        print_json(told)
    else:
        source = f"{told['device']}{' (simulated)' if told['simulated'] else ''}"
        click.echo(f"{source}: {'every part passed' if found.passed else 'not every part passed'}")
        print_table(
            ["part", "verdict", "what was seen"],
            [[one.part, str(one.verdict), one.evidence] for one in found.findings],
            left=3,
        )
        for name, value in told["settings"].items():
            click.echo(f"calibration: {name} = {value}")
        if told["receipt"]:
            click.echo(f"receipt written to {told['receipt']}")
    if not found.passed and not found.wrong:
        missing = ", ".join(f.part for f in found.findings if f.verdict is Verdict.NOT_TESTED)
        click.echo(f"fdvv: not tested: {missing}; {'; '.join(told['evidence']['notes'])}", err=True)
    if found.wrong:
        click.echo(f"fdvv: {found.wrong.part}: {found.wrong.evidence}; {found.wrong.remedy}", err=True)
