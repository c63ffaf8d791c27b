"""Build the shipped linear, tactile, clicky and rubber-dome buttons.

Run as ``python tools/make_switches.py FOLDER``, the folder of bluepylons' .ods files. The Cherry MX models
are fits of real press and release curves (CC BY 4.0). The dome has no measurement behind it: it is drawn
through landmarks cited in its provenance, and says so.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.interpolate import PchipInterpolator

from fdvv.button.fit import FitSettings, fit_file
from fdvv.model.curve import MeasuredCurve, Stroke
from fdvv.model.file import save_model
from fdvv.model.fit import fit_curve
from fdvv.model.model import FDVVModel, Provenance

OUTPUT = Path(__file__).parents[1] / "packages/fdvv/src/fdvv/model/builtin"

SWITCHES = {
    "mx-red": ("Cherry-MX-Red.ods", "linear"),
    "mx-black": ("Cherry-MX-Hyperglide-Black.ods", "linear"),
    "mx-brown": ("Cherry-MX-Hyperglide-Brown.ods", "tactile"),
    "mx-blue": ("Cherry-MX-Hyperglide-Blue.ods", "clicky"),
}
CREDIT = "bluepylons, Open Switch Curve Meter, github.com/bluepylons/Open-Switch-Curve-Meter, commit 2d26c0a"
SLOW = "The bench measures at rest, step by step: the model knows no velocity."

# press at 0.5 mm/s: (mm, cN); a 3.6 mm key of the HP PR1101U's kind
DOME_mm_cN = ((0.0, 2.0), (0.2, 16.0), (0.6, 42.0), (1.15, 60.0), (1.8, 45.0), (2.5, 33.0), (3.0, 39.0),
              (3.4, 60.0), (3.6, 82.0))  # fmt: skip
DOME_LOOP_cN = 8.0
DOME_GAIN_PER_E_FOLD = 0.024
DOME_VELOCITIES_mm_s = (0.5, 50.0, 100.0, 150.0, 200.0)
DOME = Provenance(
    source="drawn through landmarks, not measured: a rubber-dome key of 3.6 mm travel",
    licence="MIT (this project)",
    citation="travel: Liao et al., CHI 2020; +12 % peak force from 0.5 to 80 mm/s: Nagurka & Marklin 2005",
    method="PCHIP through nine points, then 15 control points with free knots",
    assumptions=(
        "Peak 60 cN at 1.15 mm, snap ratio 0.45 and 60 cN at 3.4 mm are the middle of plausible ranges.",
        "Force grows by 2.4 % per e-fold of velocity, the log law through the cited 12 %.",
        "The release lies 8 cN below the press at mid-travel; measured Topre and NiZ domes have 4 to 12 cN.",
        "Activation and reset lie where the fall is half done, at 1.8 mm.",
    ),
)


def switch(name: str, path: Path, kind: str) -> FDVVModel:
    """Fit one bluepylons file and credit it."""
    found = fit_file(path, FitSettings(control_points=15)).model
    provenance = Provenance(
        source=f"{found.name} ({kind}), press and release, {path.name}",
        licence="CC BY 4.0",
        citation=CREDIT,
        method=found.provenance.method,
        assumptions=(SLOW,),
    )
    return replace(found, name=name, provenance=provenance)


def dome() -> FDVVModel:
    """Draw the rubber dome at five velocities."""
    x_mm, force_cN = np.array(DOME_mm_cN).T
    travel_mm = float(x_mm[-1])
    x = np.round(np.arange(0, travel_mm + 1e-9, 0.005), 3)
    press_cN = PchipInterpolator(x_mm, force_cN)(x)
    loop_cN = DOME_LOOP_cN * np.sin(np.pi * x / travel_mm) ** 0.5
    curves = []
    for stroke, still_cN in ((Stroke.PRESS, press_cN), (Stroke.RELEASE, np.maximum(press_cN - loop_cN, 0.5))):
        for velocity_mm_s in DOME_VELOCITIES_mm_s:
            gain = 1 + DOME_GAIN_PER_E_FOLD * np.log(velocity_mm_s / DOME_VELOCITIES_mm_s[0])
            measured = MeasuredCurve(x, gain * still_cN, stroke, velocity_mm_s)
            curves.append(fit_curve(measured, control_points=15).curve)
    return FDVVModel("rubber-dome", travel_mm, tuple(curves), 1.8, 1.8, provenance=DOME)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        raise SystemExit("usage: python tools/make_switches.py FOLDER")
    models = [switch(name, Path(sys.argv[1]) / file, kind) for name, (file, kind) in SWITCHES.items()]
    for model in (*models, dome()):
        save_model(model, OUTPUT / f"{model.name}.fdvv.json")
        print(OUTPUT / f"{model.name}.fdvv.json")
