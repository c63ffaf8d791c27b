"""Build the shipped real buttons of the twin; run as ``python tools/make_buttons.py``.

The Cherry MX are built from the project's own shipped models, whose sources and licences they carry; the two
domes have no measurement behind them: they are drawn through landmarks in plausible ranges, and say so.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.interpolate import PchipInterpolator

from fdvv.model.file import load_builtin
from fdvv.twin.button import ButtonPhysics, Curve, button_of_model
from fdvv.twin.files import button_to_toml
from fdvv.units import N_from_cN, m_from_mm

OUTPUT = Path(__file__).parents[1] / "packages/fdvv/src/fdvv/twin/buttons"
STEP_mm = 0.02
SLOW_mm_s = 0.5

# where the circuit closes (mm), and how deep the top stop shapes the curve. Clear: its drawn curves leave the
# leaf no energy to lose before 2.15 mm, so the nominal 2.0 mm cannot be where it lands.
SWITCHES = {
    "mx-clear": (2.15, 0.3),
    "mx-brown": (None, 0.1),
    "mx-black": (None, 0.1),
    "mx-red": (None, 0.1),
}


@dataclass(frozen=True)
class Landmarks:
    """A dome drawn by hand, press at 0.5 mm/s; every number is assumed."""

    what: str
    press_mm_cN: tuple[tuple[float, float], ...]
    loop_cN: float
    close_mm: float
    open_mm: float


DOMES = {
    "hp-pr1101u": Landmarks(
        "HP PR1101U, travel 3.6 mm",
        ((0.0, 2.0), (0.2, 16.0), (0.6, 42.0), (1.15, 60.0), (1.8, 45.0), (2.5, 33.0), (3.0, 39.0),
         (3.4, 60.0), (3.6, 82.0)),
        8.0, 2.4, 2.2,
    ),
    "macbook-pro-2011": Landmarks(
        "MacBook Pro 2011, travel 2.2 mm",
        ((0.0, 2.0), (0.12, 18.0), (0.35, 43.0), (0.7, 60.0), (1.1, 43.0), (1.5, 31.5), (1.8, 37.0),
         (2.05, 60.0), (2.2, 85.0)),
        7.0, 1.45, 1.3,
    ),
}  # fmt: skip


def dome(name: str, marks: Landmarks) -> ButtonPhysics:
    """Draw a dome through its landmarks, its release a loop below its press."""
    at_mm, force_cN = np.array(marks.press_mm_cN).T
    travel_mm = float(at_mm[-1])
    x_mm = STEP_mm * np.arange(round(travel_mm / STEP_mm) + 1)
    press_cN = np.asarray(PchipInterpolator(at_mm, force_cN)(x_mm))
    loop_cN = marks.loop_cN * np.sin(np.pi * np.clip(x_mm / travel_mm, 0, 1)) ** 0.5
    curve = Curve(
        kind="dome",
        speed_m_s=m_from_mm(SLOW_mm_s),
        travel_m=round(m_from_mm(travel_mm), 9),
        close_m=round(m_from_mm(marks.close_mm), 9),
        open_m=round(m_from_mm(marks.open_mm), 9),
        seat_m=0.0,
    )
    return ButtonPhysics(
        name,
        f"{marks.what} (Liao et al., CHI 2020); all else assumed: drawn through landmarks, not measured",
        "MIT (this project)",
        N_from_cN(press_cN),
        N_from_cN(np.maximum(press_cN - loop_cN, 0.5)),
        curve,
    )


def buttons() -> tuple[ButtonPhysics, ...]:
    """Build all six."""
    switches = [button_of_model(load_builtin(name), close, seat) for name, (close, seat) in SWITCHES.items()]
    return (*switches, *(dome(name, marks) for name, marks in DOMES.items()))


if __name__ == "__main__":
    for button in buttons():
        path = OUTPUT / f"{button.name}.toml"
        path.write_text(button_to_toml(button))
        print(path)
