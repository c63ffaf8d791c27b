"""Build the shipped model of the published button from the node table read off the paper's figure.

Run as ``python tools/make_builtin.py NODES.csv``: one row per curve, its stroke, its velocity and 15 forces.
"""

from __future__ import annotations

import csv
import math
import sys
from pathlib import Path

import numpy as np

from fdvv.model import bspline
from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.file import save_model
from fdvv.model.model import FDVVModel, Provenance
from fdvv.model.velocity import Interpolation
from fdvv.model.vibration import Mode, Vibration

OUTPUT = Path(__file__).parents[1] / "packages/fdvv/src/fdvv/model/builtin/mx-clear.fdvv.json"

# 15 evenly indexed samples of an 81-sample grid, 0.05 mm apart
NODES_mm = np.round(0.05 * np.floor(80 * np.arange(15) / 14), 2)

FREQUENCY_Hz = 239.0
DURATION_s = 0.016
ONSET_mm = 2.3
# 2.43 V on the paper's exciter, at 239 Hz, with 25 g assumed to move
AMPLITUDE_m_s2 = 4.6
# the paper's middle template falls from 2.43 V to 0.3 V over its 16 ms
DECAY_1_s = round(math.log(2.43 / 0.3) / DURATION_s, 1)

PROVENANCE = Provenance(
    source="The FDVV figure of the paper, vector version on the first author's site "
    "(github.com/yichiliao/yichiliao.github.io, images/button/fdvvmodel.pdf, commit 669fe947); "
    "measured by the paper's authors",
    licence="none stated by the publisher; numbers read from a published figure, cited",
    citation="Liao, Kim, Lee, Oulasvirta: Button Simulation and Design via FDVV Models, CHI 2020",
    method="15 nodes per curve recovered from the figure's vector paths; cubic B-splines through them with "
    "not-a-knot ends; within 0.01 cN of the drawn curves from 0.25 mm on",
    assumptions=(
        "MX Clear is a reading: the caption does not name the button; its 0.5 mm/s curve has the shape of "
        "Cherry MX Clears measured on other benches.",
        "Which curve belongs to which velocity is read from draw order and shade.",
        "Below 0.25 mm the figure draws straight lines from the node at 0 mm; the model keeps the spline, "
        "up to 6.4 cN above the line on the press; on the release up to 3.8 cN above and 2.6 cN below it, "
        "where at 150 mm/s it touches -0.03 cN.",
        "The reset point is the activation point: the figure marks 2.0 mm on both strokes.",
        "The vibration is the same at every velocity and on both strokes, at 2.3 mm, as the figure draws it.",
        "Its amplitude of 4.6 m/s² is computed from 2.43 V on an assumed exciter moving an assumed 25 g.",
        "Its decay of 130.7 1/s is that of the paper's template from 2.43 V to 0.3 V in 16 ms.",
    ),
)


def read_curves(path: Path) -> tuple[ForceCurve, ...]:
    """Read the node table: one curve a row."""
    with path.open(newline="") as stream:
        rows = list(csv.reader(stream))[1:]
    curves = []
    for stroke, velocity, *nodes in rows:
        t, c = bspline.interpolate(NODES_mm, np.array(nodes, dtype=np.float64))
        # the nodes are good to 0.001 cN; 1e-6 keeps the file the same whatever solved the system
        curves.append(ForceCurve(Stroke(stroke), float(velocity), 3, np.round(t, 2), np.round(c, 6)))
    return tuple(curves)


def build(path: Path) -> FDVVModel:
    """Build the model from the node table at path."""
    mode = Mode(FREQUENCY_Hz, AMPLITUDE_m_s2, DECAY_1_s)
    return FDVVModel(
        name="mx-clear",
        travel_mm=4.0,
        curves=read_curves(path),
        actuation_mm=2.0,
        reset_mm=2.0,
        vibrations=tuple(Vibration(stroke, None, ONSET_mm, DURATION_s, (mode,)) for stroke in Stroke),
        interpolation=Interpolation.PCHIP,
        provenance=PROVENANCE,
    )


if __name__ == "__main__":
    if len(sys.argv) != 2:
        raise SystemExit("usage: python tools/make_builtin.py NODES.csv")
    save_model(build(Path(sys.argv[1])), OUTPUT)
    print(OUTPUT)
