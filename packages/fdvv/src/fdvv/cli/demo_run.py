"""The main job, end to end: fit a real switch, render the published button, judge the rendering."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import Any

from fdvv.button.fit import FitSettings, ModelFit, fit_file, fit_report
from fdvv.compensation.method import Tuning
from fdvv.compensation.rig_aware import RigAware
from fdvv.device.contract import Device
from fdvv.model.file import load_builtin
from fdvv.model.fit import PAPERS_CONTROL_POINTS, CurveFit, FitMethod, fit_curve, scan_sizes
from fdvv.model.model import FDVVModel
from fdvv.rendering.compensate import CompensationResult, compensate, start_surface
from fdvv.rendering.evaluation.vibration_presses import Playback
from fdvv.rendering.probe import ProbeResult, fd_only, probe
from fdvv.rendering.session_run import PressDone

BUTTON = "mx-clear"
SWITCH = "cherry-mx-hyperglide-brown.csv"
VELOCITIES_mm_s = (50.0, 100.0, 150.0, 200.0)  # of the published button, less the probe's 0.5 mm/s
PROBE_PRESSES, VIBRATION_PRESSES = 30, 10  # per speed; assumed: benchmarks have 20
FD_ONLY = "FD only"

Stage = Callable[[str, int, int], None]
"""Called with a label, steps done and steps in all."""


@dataclass(frozen=True, eq=False)
class Rendering:
    """One way to render a button, and how fresh presses judged it.

    Attributes
    ----------
    label : "uncompensated", "FD only" or "FDVV".
    learned : how its actuation was learned; None if it is what learning starts from, the model's own force.
    judged : the probe, always against the full model.
    """

    label: str
    learned: CompensationResult | None
    judged: ProbeResult


@dataclass(frozen=True, eq=False)
class SwitchFit:
    """The real switch: adaptive and uniform knots on the same raw curves, and the scan of sizes."""

    adaptive: ModelFit
    uniform: tuple[CurveFit, ...]
    scan: dict[str, dict[int, float]]


@dataclass(frozen=True, eq=False)
class DemoResult:
    """Everything the demo found. Rendering figures are simulated."""

    switch: SwitchFit
    button: FDVVModel
    renderings: tuple[Rendering, ...]
    seed: int
    time_s: float

    def rows(self) -> list[dict[str, Any]]:
        """Return one row per stroke and velocity: mean and maximum error of each rendering, in cN."""
        labels = [r.label for r in self.renderings]
        tables = [[c.to_dict() for c in r.judged.curves] for r in self.renderings]
        errors = ("mean_error_cN", "max_error_cN")
        return [
            {key: curves[0][key] for key in ("stroke", "velocity_mm_s")}
            | {k: {key: curve[key] for key in errors} for k, curve in zip(labels, curves, strict=True)}
            for curves in zip(*tables, strict=True)
        ]

    def to_dict(self) -> dict[str, Any]:
        """Return the report of ``fdvv demo --json``."""
        return {
            "switch": {
                **self.switch.adaptive.to_dict(),
                "uniform": {str(f.curve.stroke): fit_report(f) for f in self.switch.uniform},
            },
            "button": self.button.name,
            "renderings": [
                {
                    "label": r.label,
                    "learned": r.learned.to_dict() if r.learned else None,
                    "judged": r.judged.to_dict(),
                }
                for r in self.renderings
            ],
            "rows": self.rows(),
            "seed": self.seed,
            "time_s": self.time_s,
            "simulated": True,
        }


def demo(
    open_device: Callable[[int], Device],
    switch: Path | None = None,
    seed: int = 1,
    stage: Stage = lambda _label, _done, _total: None,
) -> DemoResult:
    """Fit a real switch, learn and judge three renderings of the published button at four velocities.

    open_device : gives a device for a seed; learning and judging use different seeds.
    switch : a file of measured curves; the shipped one if None. Raises InputError, DeviceError.
    """
    started = time.perf_counter()
    with resources.as_file(resources.files("fdvv.button") / "examples" / SWITCH) as shipped:
        fitted = _fit_switch(switch or shipped, stage)
    button = load_builtin(BUTTON)
    renderings = _render(open_device, button, seed, stage)
    return DemoResult(fitted, button, renderings, seed, time.perf_counter() - started)


def _fit_switch(path: Path, stage: Stage) -> SwitchFit:
    stage("fitting the switch", 0, 3)
    adaptive = fit_file(path, FitSettings(control_points=PAPERS_CONTROL_POINTS))
    stage("fitting the switch", 1, 3)
    uniform = tuple(fit_curve(m, FitMethod.UNIFORM, PAPERS_CONTROL_POINTS) for m in adaptive.measured)
    stage("fitting the switch", 2, 3)
    scan = {str(m): scan_sizes(adaptive.measured[0], m) for m in FitMethod}
    stage("fitting the switch", 3, 3)
    return SwitchFit(adaptive, uniform, scan)


def _render(
    open_device: Callable[[int], Device], button: FDVVModel, seed: int, stage: Stage
) -> tuple[Rendering, ...]:
    learned: dict[str, CompensationResult | None] = {"uncompensated": None}
    for label, target in ((FD_ONLY, fd_only(button)), ("FDVV", button)):
        tell = _on_press(stage, f"learning {label}")
        learned[label] = compensate(open_device(seed), target, VELOCITIES_mm_s, RigAware(), progress=tell)
    return tuple(
        Rendering(label, result, _judge(open_device(seed + 1000), button, label, result, stage))
        for label, result in learned.items()
    )


def _judge(
    device: Device, button: FDVVModel, label: str, learned: CompensationResult | None, stage: Stage
) -> ProbeResult:
    surface = learned.surface if learned else start_surface(device, button, VELOCITIES_mm_s)
    tuning = learned.outcome.tuning if learned else Tuning()
    tell = _on_press(stage, f"probing {label}")
    # force and displacement alone leave the vibration out; the other two play it
    playback = None if label == FD_ONLY else Playback(VIBRATION_PRESSES)
    about = (VELOCITIES_mm_s, PROBE_PRESSES, tell, label)
    return probe(device, button, surface, *about, tuning=tuning, playback=playback)


def _on_press(stage: Stage, label: str) -> Callable[[PressDone], None]:
    return lambda event: stage(label, event.presses_done, event.presses_total)
