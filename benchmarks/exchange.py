"""What is lost when a button goes to another program, format by format.

Run as ``python -m benchmarks.exchange``; with MuJoCo installed it pushes buttons there too (simulated).

Vibrations are drawn, seeded: one to three modes of 80 to 290 Hz, damped by 2 to 15 % of critical, any phase.
Each is written, read back by our reader and compared as acceleration at 48 kHz.
"""

from __future__ import annotations

import csv
import io
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from fdvv.button.export_file import export_button, export_vibration
from fdvv.formats.exchange.frames import recording_csv
from fdvv.model.curve import Stroke
from fdvv.model.file import builtin_names, load_builtin, load_model, save_model
from fdvv.model.model import FDVVModel
from fdvv.model.vibration import Mode, Vibration
from fdvv.recording.types import Quantity, Recording, Stream, Take
from fdvv_haptics.mjcf import mjcf
from fdvv_haptics.mujoco import mujoco_button
from fdvv_haptics.smartknob import smartknob

DRAWS, SEED = 200, 1
MEASURES = ("correlation", "spectral_similarity", "st_sim", "spqi")
SPEEDS_mm_s = (50.0, 80.0, 120.0, 160.0, 200.0)


def drawn(random: np.random.Generator, count: int) -> Vibration:
    """Draw a vibration of some modes, as long as its slowest takes to fall to a hundredth."""
    frequency = random.uniform(80, 290, count)
    decay = 2 * np.pi * frequency * random.uniform(0.02, 0.15, count)
    modes = tuple(
        Mode(float(f), float(random.uniform(0.5, 5)), float(d), float(random.uniform(-np.pi, np.pi)))
        for f, d in zip(frequency, decay, strict=True)
    )
    return Vibration(Stroke.PRESS, None, 1.0, float(np.log(100) / decay.min()), modes)


def compared(vibration: Vibration, form: str) -> dict[str, float]:
    """Write a vibration, read it back and give the measures."""
    made = export_vibration(vibration, form, "drawn", "2026-01-01")
    return {m: float(made.figures[m] or 0.0) for m in MEASURES}


def likeness(form: str, count: int) -> list[tuple[float, float]]:
    """Return the median and the tenth percentile of each measure over the draws."""
    random = np.random.default_rng(SEED)
    figures = [compared(drawn(random, count), form) for _ in range(DRAWS)]
    columns = [[f[measure] for f in figures] for measure in MEASURES]
    return [(float(np.median(c)), float(np.percentile(c, 10))) for c in columns]


def haptics() -> None:
    print(f"vibrations, {DRAWS} draws each: median (tenth percentile); 1 is the same")
    print(f"{'format':<8}{'modes':>6}" + "".join(f"{m:>24}" for m in MEASURES))
    for form in ("ahap", "haptic", "hjif", "wav"):
        for count in (1, 2, 3):
            cells = [f"{median:.3f} ({low:.3f})" for median, low in likeness(form, count)]
            print(f"{form:<8}{count:>6}" + "".join(f"{cell:>24}" for cell in cells))


def models() -> list[FDVVModel]:
    """Return the built-in buttons, and one whose press and release were measured at slightly other speeds."""
    red = load_builtin("mx-red")
    speeds = {Stroke.PRESS: 0.149, Stroke.RELEASE: 0.147}
    curves = tuple(replace(c, velocity_mm_s=speeds[c.stroke]) for c in red.curves)
    return [*map(load_builtin, builtin_names()), replace(red, name="mx-red, 0.149/0.147", curves=curves)]


def tables() -> None:
    print("\ntables, written and imported again: curves; largest rms and difference, cN; travel, mm")
    with TemporaryDirectory() as folder:
        path = Path(folder) / "a.fdvv.json"
        for model in models():
            save_model(model, path)
            print(f"{model.name:>20}  fdvv.json {'equal' if load_model(path) == model else 'not equal'}")
            for form in ("csv", "bluepylons-csv", "haata", "tester-json"):
                f = export_button(str(path), form, "a").figures
                print(
                    f"{form:>36}  {f['imported_curves']:g} of {len(model.curves)}  "
                    f"{f['imported_rms_cN']:.3f}  {f['imported_max_cN']:.3f}  {f['imported_travel_mm']:+.3f}"
                )


def recordings() -> None:
    """Read a recording's table with the standard library and compare its numbers."""
    random = np.random.default_rng(SEED)
    t, values = np.sort(random.uniform(0, 1, 5000)), random.normal(0, 50, 5000)
    stream = Stream("force", Quantity.FORCE, "clock", t, values)
    text = recording_csv(Recording("drawn", (Take(1, (stream,)),))).text
    rows = list(csv.DictReader(io.StringIO(text)))
    equal = [float(r["t_s"]) for r in rows] == t.tolist()
    equal &= [float(r["value"]) for r in rows] == stream.values.tolist()
    print(f"\nrecording-csv: {len(rows)} samples, {'equal to the last bit' if equal else 'not equal'}")


def springs() -> None:
    print("\nMuJoCo's springs against the model, cN: rms and largest, over the travel")
    head = ("button", "speed", "pieces", "press", "release", "release, followed both")
    print("".join(f"{h:>{14 if i < 3 else 24}}" for i, h in enumerate(head)))
    for name in builtin_names():
        model = load_builtin(name)
        for v in model.velocities_mm_s(Stroke.PRESS) or (None,):
            label = "" if v is None else f"_{v:g}mm_s"
            one, both = (mjcf(model, follow=f, velocity_mm_s=v).figures for f in ("press", "both"))
            cells = [pair(one, f"press{label}"), pair(one, f"release{label}"), pair(both, f"release{label}")]
            row = (name, "any" if v is None else f"{v:g}", f"{one['pieces']:g}")
            print("".join(f"{c:>14}" for c in row) + "".join(f"{c:>24}" for c in cells))


def pair(figures: Any, of: str) -> str:
    return f"{figures[f'{of}_rms_cN']:.2f}  {figures[f'{of}_max_cN']:.2f}"


def knobs() -> None:
    print("\nSmartKnob: where it snaps and returns, mm, and how much of the press the detents are")
    for name in builtin_names():
        f = smartknob(load_builtin(name)).figures
        places = ("–", "–") if f["snap_mm"] is None else (f"{f['snap_mm']:.2f}", f"{f['return_mm']:.2f}")
        print(
            f"{name:>14}  snap {places[0]:>5}  return {places[1]:>5}  "
            f"left {f['residual_rms_cN']:6.2f} cN rms  explained {f['explained_ratio']:.3f}"
        )


def pushed() -> None:
    """Lead the cap of each button at steady speeds and compare what pushes back with the model."""
    try:
        import mujoco
    except ImportError:
        print("\nMuJoCo is not installed: pip install mujoco")
        return
    print("\nA cap of 1 g led through MuJoCo at a steady speed (simulated): largest error, cN")
    print(f"{'button':>14}{'mm/s':>8}{'callback press':>18}{'release':>10}{'springs press':>18}")
    for name in builtin_names():
        model = load_builtin(name)
        made = mujoco_button(model)
        for v in SPEEDS_mm_s:
            errors = [led(mujoco, model, made.xml, v, way, made) for way in (1, -1)]
            alone = led(mujoco, model, mjcf(model, velocity_mm_s=v).text, v, 1, None)
            print(f"{name:>14}{v:>8g}{errors[0]:>18.3f}{errors[1]:>10.3f}{alone:>18.3f}")


def led(mujoco: Any, button: FDVVModel, xml: str, v_mm_s: float, way: int, made: Any) -> float:
    """Return the largest error of the force, the cap's inertia taken off."""
    servo = '<position name="finger" joint="button" kp="60000" kv="60"/></actuator>'
    model = mujoco.MjModel.from_xml_string(xml.replace("</actuator>", servo))
    data = mujoco.MjData(model)
    start = 0.05 if way > 0 else 0.97 * button.travel_mm
    data.qpos[0], data.qvel[0] = start / 1000, way * v_mm_s / 1000
    stroke = Stroke.PRESS if way > 0 else Stroke.RELEASE
    off = []
    if made:
        mujoco.set_mjcb_passive(made.passive)
    try:
        for _ in range(int(0.9 * button.travel_mm / v_mm_s / model.opt.timestep)):
            data.ctrl[1] = (start + way * v_mm_s * (data.time + 0.001)) / 1000
            x, speed = 1000 * data.qpos[0], abs(1000 * data.qvel[0])
            mujoco.mj_step(model, data)
            felt = 100 * (data.actuator_force[1] - model.body_mass[1] * data.qacc[0])
            off.append(felt - float(button.force_cN(x, speed if made else v_mm_s, stroke)))
    finally:
        mujoco.set_mjcb_passive(None)
    return float(np.abs(off[len(off) // 20 :]).max())


def main() -> None:
    haptics()
    tables()
    recordings()
    springs()
    knobs()
    pushed()


if __name__ == "__main__":
    main()
