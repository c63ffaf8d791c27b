"""fdvv device new, serve and conform: a rig of one's own."""

from __future__ import annotations

import time
from pathlib import Path

import click

from fdvv.cli import ui
from fdvv.cli.options import device_option, remote

SPEAK_s = 1.0  # assumed: nobody reads a count faster


@click.command()
@click.argument("name")
@ui.option("-o", "--output", type=ui.PATH, help="Folder to make; fdvv-NAME by default.")
def new(name: str, output: Path | None) -> None:
    """Write a package for a rig of your own called NAME: a simulated one that works, ready to be replaced.

    The lines to replace are marked. It is pressed with --device rig:FILE.py:Rig, or by its name once it is
    installed.
    """
    from fdvv.device.own_package import write_package

    folder = output or Path(f"fdvv-{name}")
    rig = write_package(name, folder)[0]
    click.echo(f"{folder}: a simulated rig that works. Replace what {rig} marks, then")
    for command in ("press mx-clear", "conform", "serve"):
        where = f"rig:{rig}:Rig"
        click.echo(f"  fdvv device {command} " + (where if command == "serve" else f"--device {where}"))


@click.command()
@click.argument("rig")
@ui.option("--seed", type=ui.COUNT, default=0, help="Of the simulated hand and sensors.")
def serve(rig: str, seed: int) -> None:
    """Run RIG in real time behind a pseudo-terminal, with the firmware, until Ctrl-C; simulated.

    RIG is 'twin', FILE.py:NAME, or the name of an installed rig. Every command opens the terminal that is
    printed as --device serial:TERMINAL. A simulated hand presses while the rig is armed.
    """
    from fdvv.device.open import person_of
    from fdvv.device.serve import RigServer

    server = RigServer(person_of(rig, seed))
    server.start()
    click.echo(f"{rig} (simulated): --device serial:{server.path}; end with Ctrl-C")
    try:
        with ui.live() as shown:
            while server.is_alive():
                if shown:
                    shown.update(f"{server.counts['presses']} presses, {server.counts['ticks']} ticks")
                time.sleep(SPEAK_s)
    except KeyboardInterrupt:
        pass
    finally:
        server.end()
    click.echo(f"ended after {ui.counted(server.counts['presses'], 'press')}")


@click.command()
@device_option
@ui.option("--no-press", is_flag=True, help="Leave out the rules for which somebody must press.")
@ui.json_option
def conform(spec: str, no_press: bool, as_json: bool) -> None:
    """Check every rule of the link on a device, and say what to mend; exit status 1 if one is broken.

    A person presses a real rig twice, through its travel. Its settings are put back. A rig of your own may
    use other firmware: what it must honour is in docs/how-to/add-a-device.md.
    """
    from fdvv.testing.link_checks import check_link

    results = []
    with remote(spec) as found:
        name, is_simulated = found.info().name, found.info().simulated
        for result in check_link(found, not no_press):
            results.append(result)
            if not as_json:
                click.echo(f"{'kept  ' if result.passed else 'BROKEN'}  {result.name}")
                if result.found:
                    ui.print_wrapped(f"        {result.found}; {result.mend}")
    broken = sum(not result.passed for result in results)
    if as_json:
        rows = [{"rule": r.name, "kept": r.passed, "found": r.found, "mend": r.mend} for r in results]
        ui.print_json({"device": name, "simulated": is_simulated, "rules": rows})
    else:
        click.echo(
            f"{name}{ui.simulated(is_simulated)}: {len(results) - broken} of {len(results)} rules kept"
        )
    if broken:
        raise ui.failed(f"{spec}: {ui.counted(broken, 'rule')} broken")
