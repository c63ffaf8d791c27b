"""Capture the buttons that shipped studies compare: ``python tools/make_study_buttons.py``. Simulated.

The paper's own, but for mx-clear, which is built in: each twin of a real button is recorded on the twin's
bench as ``fdvv capture`` does, at the paper's paces, and becomes a model of five speeds, spreads left out.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

from fdvv.model.file import load_model, save_model
from fdvv.model.model import FDVVModel
from fdvv.twin.files import load_button

FOLDER = Path(__file__).parents[1] / "packages/fdvv-people/src/fdvv_people/study/templates/buttons"
BUTTONS = ("mx-brown", "mx-black", "mx-red", "hp-pr1101u", "macbook-pro-2011")


def captured(name: str) -> FDVVModel:
    """Record a button on the twin's bench and make its model."""
    with tempfile.TemporaryDirectory() as below:
        model = Path(below) / f"{name}.fdvv.json"
        recording = str(Path(below) / f"{name}.recording.jsonl")
        command = [sys.executable, "-m", "fdvv", "capture", recording, "--button", name, "-o", str(model)]
        subprocess.run(command, check=True, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        return load_model(model)


def bare(model: FDVVModel) -> FDVVModel:
    """Take spreads off a model, and say where its button came from."""
    button = load_button(model.name)
    source = f"simulated: {model.provenance.source}; the twin's button is drawn from: {button.source}"
    origin = replace(model.provenance, source=source, licence=button.licence)
    curves = tuple(replace(curve, spread=None) for curve in model.curves)
    vibrations = tuple(replace(vibration, spread=None) for vibration in model.vibrations)
    return replace(model, curves=curves, vibrations=vibrations, provenance=origin)


if __name__ == "__main__":
    for name in BUTTONS:
        save_model(bare(captured(name)), FOLDER / f"{name}.fdvv.json")
        print(FOLDER / f"{name}.fdvv.json")
