"""fdvv hardware: the rig as things to buy, wire and test."""

from __future__ import annotations

import click

from fdvv.cli._hardware_electric import bill, circuit
from fdvv.cli._hardware_selftest import selftest


@click.group()
def hardware() -> None:
    """Build a rig: what to buy, how to wire it, and which part is wrong."""


hardware.add_command(bill)
hardware.add_command(circuit)
hardware.add_command(selftest)
