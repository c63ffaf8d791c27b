"""The receipt of a result, for people."""

from __future__ import annotations

from collections import Counter
from typing import Any

import click

from fdvv.cli._output import counted, number, print_table, print_wrapped

LISTED = 10
"""Of the presses that were not used."""


def print_receipt(found: dict[str, Any]) -> None:
    """Print how a result came about."""
    told = " (simulated)" if found["simulated"] else ""
    click.echo(f"{found['task']} {found['model']['name']} on {found['device']['name']}{told}")
    print_wrapped(f"method: {found['method']}")
    spent = f"{found['pressing_s']:.0f} s of pressing in {counted(len(found['runs']), 'run')}"
    print_wrapped(f"begun {found['begun']}, last press {found['finished'] or '–'}, {spent}")
    for run in found["runs"]:
        made = ", ".join(f"{name} {version}" for name, version in run["versions"].items())
        seed = "" if run["seed"] is None else f"; seed {run['seed']}"
        click.echo(f"run of {run['started']} with {made}{seed}")
    print_wrapped(_rig(found["device"]))
    _print_presses(found)
    if found["task"] == "tune":
        click.echo("run the session's command again for its result, or to go on")
        return
    if not found["curves"]:
        click.echo("not finished; run the session's command again to go on")
        return
    print_table(
        ["curve", "presses", "first cN", "last cN", "best cN", "mean cN", "max cN"],
        [
            [
                f"{c['stroke']} {c['velocity_mm_s']:g} mm/s",
                str(c["presses"]),
                *(number(c[f"{name}_cN"]) for name in ("first", "last", "best", "mean", "max")),
            ]
            for c in found["curves"]
        ],
    )


def _rig(device: dict[str, Any]) -> str:
    """Tell a rig by its limits and, of a board, by what tells it from others."""
    told = [
        f"rig: up to {device['force_limit_cN']:.0f} cN, {device['travel_limit_mm']:.1f} mm",
        f"{1 / device['tick_s']:.0f} Hz",
    ]
    if "serial" in device:
        version = ".".join(str(device["firmware"] >> shift & 255) for shift in (16, 8, 0))
        told += [f"serial {device['serial']}, firmware {version}, {len(device['settings'])} settings"]
    told += [f"{key.partition('_')[0]} file {device[key][:12]}" for key in sorted(device) if "toml" in key]
    return ", ".join(told)


def _print_presses(found: dict[str, Any]) -> None:
    """Print how many presses were used, and why others were not."""
    unused = found["not_used"]
    if found["task"] == "tune":
        click.echo(counted(found["used"], "answer"))
        return
    click.echo(f"{counted(found['used'], 'press')} used, {len(unused)} not")
    for press in unused[:LISTED]:
        print_wrapped(f"  press {press['number']} at {press['velocity_mm_s']:g} mm/s: {press['reason']}")
    if len(unused) > LISTED:
        speeds = Counter(f"{press['velocity_mm_s']:g} mm/s" for press in unused)
        listed = ", ".join(f"{count} at {speed}" for speed, count in speeds.items())
        click.echo(f"  and {len(unused) - LISTED} more; in all {listed}")
