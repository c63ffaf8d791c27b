"""What simulated participants say of FD and FDVV, beside the paper's 77.31 %, and why. Simulated.

The proxy's constants come from psychophysics, none from the paper's study; nothing is fitted here. The six
built-in buttons are not the paper's six: four of them were measured at rest and know no velocity, so that FD
and FDVV are the same. The shipped study has the paper's six, five of them captured on simulated buttons.

    python -m benchmarks.simulated_participants [--parts buttons,sweep,speed] [--studies 400]
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from fdvv.model.file import builtin_names, load_builtin
from fdvv.model.model import FDVVModel
from fdvv.rendering.probe import fd_only
from fdvv_people.study.plan.claim import claim_holds
from fdvv_people.study.plan.plan_file import write_template
from fdvv_people.study.simulation.people import ProxySettings
from fdvv_people.study.simulation.perception import Senses, haptic_features, perceived_difference
from fdvv_people.study.simulation.power import ItemEffect, PowerDesign, simulate_scores
from fdvv_people.study.simulation.study_power import open_plan, study_power
from fdvv_people.study.stimulus.renderer import stimulus_model

PAPER_percent = 77.31
PEOPLE = 12
CHANGES: dict[str, tuple[float, ...]] = {
    "weber_ratio": (0.04, 0.1, 0.15, 0.2),
    "floor_cN": (10.0, 60.0),
    "threshold_um": (0.05, 1.0),
    "pace_mm_s": (40.0, 150.0),
    "speed_weight": (0.0,),
    "release_weight": (0.0,),
    "pooling": (1.0, 4.0, 16.0),
    "criterion_JND": (0.0, 0.3, 1.5),
    "lapse_ratio": (0.0, 0.1),
    "taste_ratio": (0.0, 1.0),
    "noise_JND": (0.7, 1.5),
}
"""Constants one at a time, as far as sources or doubt go."""
KEEN = {"weber_ratio": 0.04, "pooling": 4.0, "criterion_JND": 0.0, "taste_ratio": 0.0}
"""Constants at their ends that speak for FDVV, together."""


def builtin_models() -> dict[str, FDVVModel]:
    return {name: load_builtin(name) for name in builtin_names()}


def study_models() -> dict[str, FDVVModel]:
    with tempfile.TemporaryDirectory() as folder:
        plan, there = open_plan(write_template("realism", Path(folder)))
        return {item.name: stimulus_model(item.stimuli[1], there) for item in plan.items}


def design(models: dict[str, FDVVModel], senses: Senses) -> PowerDesign:
    """Return the paper's study of buttons whose reference is the whole model itself."""

    def effect(name: str, model: FDVVModel) -> ItemEffect:
        whole, fd = haptic_features(model, senses), haptic_features(fd_only(model), senses)
        apart = perceived_difference(whole, fd, senses)
        return ItemEffect(name, apart, perceived_difference(whole, whole, senses), apart)

    effects = tuple(effect(name, model) for name, model in models.items())
    return PowerDesign("realism", effects, rounds=6, ties=True, alpha=0.05)


def shares_of(of: PowerDesign, studies: int, settings: ProxySettings) -> tuple[np.ndarray, float]:
    """Return shares per item for, equal and against, and the power of twelve people."""
    found = simulate_scores(of, PEOPLE, studies, settings=settings)
    upheld = claim_holds(found.scores, of.alpha) & (found.scores.sum(axis=1) > 0)
    return found.shares, float(upheld.mean())


def buttons(studies: int) -> None:
    for title, models in (("six built-in buttons", builtin_models()), ("shipped study", study_models())):
        of = design(models, Senses())
        shares, power = shares_of(of, studies, ProxySettings())
        print(f"{title}, simulated           JND   % FDVV  % equal  % FD   % FDVV of not equal")
        for effect, row in zip(of.effects, shares, strict=True):
            print(f"  {effect.item:28s} {effect.between.total_JND:7.2f} {as_text(row)}")
        print(f"  {'all':28s} {'':7s} {as_text(shares.mean(axis=0))}   power of {PEOPLE} people {power:.2f}")
        print(f"  {'the paper, measured':28s} {'':7s} {PAPER_percent:8.2f}        -      -\n")


def sweep(studies: int) -> None:
    models = {"built-in": builtin_models(), "shipped study": study_models()}
    print(f"{'':28s} {'built-in buttons':>30s} {'shipped study':>34s}")
    print(f"{'changed, simulated':28s} {'% FDVV':>16s} {'of not equal':>13s}", end="     ")
    print(f"{'% FDVV':>16s} {'of not equal':>13s} {'power':>9s}")
    line("nothing", models, studies, ProxySettings())
    for name, values in CHANGES.items():
        for value in values:
            line(f"{name} {value:g}", models, studies, ProxySettings().changed(name, value))
    keen = ProxySettings()
    for name, value in KEEN.items():
        keen = keen.changed(name, value)
    line("all that helps FDVV", models, studies, keen)
    print(f"the paper, measured: {PAPER_percent} % FDVV, of other buttons on a rig with errors")


def line(label: str, models: dict[str, dict[str, FDVVModel]], studies: int, settings: ProxySettings) -> None:
    cells = []
    for of in models.values():
        shares, power = shares_of(design(of, settings.senses), studies, settings)
        chosen, _, other = shares.mean(axis=0)
        cells.append(f"{100 * chosen:16.1f} {100 * chosen / (chosen + other):13.1f}")
    print(f"{label:28s} {'     '.join(cells)} {power:9.2f}")


def speed(_studies: int) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = write_template("realism", Path(folder))
        began, cpu = time.perf_counter(), time.process_time()
        study_power(path, range(6, 41))
        print(f"table of 6 to 40 people, 2000 studies: {time.perf_counter() - began:.1f} s, ", end="")
        print(f"{time.process_time() - cpu:.1f} s of one core")


def as_text(row: Sequence[float] | np.ndarray) -> str:
    chosen, equal, other = row
    part = 100 * chosen / (chosen + other)
    return f"{100 * chosen:8.1f} {100 * equal:8.1f} {100 * other:6.1f} {part:10.1f}"


PARTS: dict[str, Callable[[int], None]] = {"buttons": buttons, "sweep": sweep, "speed": speed}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--parts", default=",".join(PARTS))
    parser.add_argument("--studies", type=int, default=400)
    asked = parser.parse_args()
    for name in asked.parts.split(","):
        PARTS[name](asked.studies)
        print()


if __name__ == "__main__":
    main()
