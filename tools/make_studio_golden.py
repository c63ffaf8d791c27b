"""Write the numbers that the page's mathematics is checked against: web/tests/golden/*.json.

They come from fdvv itself. Run from the repository root.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from scipy.interpolate import BSpline

from fdvv.button.compare import compare
from fdvv.errors import ModelError
from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.edit import assign, copy_curve, merge, remove_curve
from fdvv.model.file import builtin_names, load_builtin
from fdvv.model.landmarks import landmarks
from fdvv.model.model import FDVVModel
from fdvv.model.spread import CurveSpread, PointSpread
from fdvv.model.velocity import Interpolation
from fdvv.model.vibration import Mode, Vibration
from fdvv.vibration.wave import vibration_samples
from fdvv_studio.project.patch import apply_patch, inverse_patch, patch_between, record_of

TARGET = Path(__file__).resolve().parents[1] / "web" / "tests" / "golden"
SEED = 20201
PLACES = np.linspace(-0.3, 4.7, 17)


def random_curve(
    rng: np.random.Generator, degree: int, velocity_mm_s: float | None, stroke: str = "press"
) -> ForceCurve:
    """Draw a curve over 4 mm with inner knots that may repeat."""
    inner = np.sort(rng.choice(np.linspace(0.2, 3.8, 19), size=int(rng.integers(0, 9)), replace=False))
    repeats = rng.choice([1, 1, 1, 2, degree], size=inner.size).clip(max=degree)
    knots = np.concatenate([np.zeros(degree + 1), np.repeat(inner, repeats), np.full(degree + 1, 4.0)])
    points = np.cumsum(rng.normal(4.0, 12.0, knots.size - degree - 1)).round(3)
    return ForceCurve(Stroke(stroke), velocity_mm_s, degree, knots, points)


def example_models() -> dict[str, FDVVModel]:
    """Make models at the edges of what a model may be."""
    rng = np.random.default_rng(SEED)
    unknown = FDVVModel("unknown", 4.0, (random_curve(rng, 3, None),))
    two = FDVVModel(
        "two",
        3.6,
        tuple(random_curve(rng, k, v) for k, v in ((2, 10.0), (4, 80.0))),
        actuation_mm=1.7,
    )
    mixed = FDVVModel(
        "mixed",
        4.0,
        tuple(
            random_curve(rng, k, v, stroke)
            for stroke, paces in (
                (Stroke.PRESS, (1.0, 3.0, 40.0, 200.0)),
                (Stroke.RELEASE, (1.0, 40.0, 90.0)),
            )
            for k, v in zip((1, 3, 5, 2), paces, strict=False)
        ),
        actuation_mm=2.0,
        reset_mm=0.0,
        vibrations=(
            Vibration(Stroke.PRESS, 40.0, 2.1, 0.02, (Mode(240, 12.5, 90, 0.3), Mode(611.5, -4, 250))),
            Vibration(Stroke.RELEASE, None, 1.0, 0.01, (Mode(100, 3.0, 0.0),)),
        ),
    )
    flat = FDVVModel("flat", 0.002, (ForceCurve(Stroke.PRESS, 5.0, 1, np.array([1.0, 1, 2, 2]), np.ones(2)),))
    spread = CurveSpread(np.array([0.0, 2.0, 4.0]), np.array([0.5, 0.25, 1.0]), 7, 9.5, 0.5)
    spreads = replace(
        two,
        name="spreads",
        curves=tuple(replace(c, spread=spread) for c in two.curves),
        actuation_spread=PointSpread(0.02, 9),
    )
    return {m.name: m for m in (unknown, two, mixed, flat, spreads)}


def splines() -> list[dict[str, Any]]:
    """Return splines of every degree, their values and slopes, and one with a knot more."""
    rng = np.random.default_rng(SEED + 1)
    cases = []
    for degree in (1, 2, 3, 4, 5) * 3:
        curve = random_curve(rng, degree, None)
        x = np.concatenate([PLACES, curve.knots_mm[degree:-degree]])
        at = float(np.round(rng.uniform(0.05, 3.95), 3))
        more = BSpline(curve.knots_mm, curve.control_points_cN, degree).insert_knot(at)
        cases.append(
            {
                "degree": degree,
                "knots_mm": curve.knots_mm,
                "control_points_cN": curve.control_points_cN,
                "control_points_mm": curve.control_points_mm,
                "x_mm": x,
                "force_cN": curve.force_cN(x),
                "stiffness_cN_mm": curve.stiffness_cN_mm(x),
                "inserted_mm": at,
                "inserted_knots_mm": more.t,
                "inserted_points_cN": more.c[: more.t.size - degree - 1],
            }
        )
    return cases


def buttons() -> list[dict[str, Any]]:
    """Return force between velocities, landmarks and vibrations of models."""
    models = {**{name: load_builtin(name) for name in builtin_names()}, **example_models()}
    return [_button(model, name in builtin_names()) for name, model in models.items()]


def _button(model: FDVVModel, built_in: bool) -> dict[str, Any]:
    speeds = (0.2, 73.0, 400.0)
    x = PLACES[::2]
    fields = [
        {
            "stroke": stroke,
            "interpolation": method,
            "velocity_mm_s": v,
            "force_cN": m.force_cN(x, v, stroke),
            "stiffness_cN_mm": m.stiffness_cN_mm(x, v, stroke),
            "damping_cN_s_mm": m.damping_cN_s_mm(x, v, stroke),
        }
        for method in Interpolation
        for stroke in Stroke
        for v in (speeds if len(model.of(stroke)) > 1 else speeds[:1])
        for m in [replace(model, interpolation=method)]
        if model.of(stroke)
    ]
    return {
        "model": model.name,
        "built_in": built_in,
        "x_mm": x,
        "fields": fields,
        "landmarks": [[v, landmarks(model, v).to_dict()] for v in (None, 73.0)],
        "vibrations": [vibration_samples(v, 8000, 0.001)[: 4 * 40 : 4] for v in model.vibrations[:2]],
    }


def differences() -> list[dict[str, Any]]:
    """Compare every built-in button with the first."""
    models = [load_builtin(name) for name in builtin_names()]
    return [
        {"names": [models[0].name, d.name], "velocity_mm_s": v, **vars(d)}
        for v in (None, 60.0)
        for d in compare(models, v).differences
    ]


def edited_models() -> dict[str, FDVVModel]:
    """Make the models that are edited."""
    models = example_models()
    mixed, two = models["mixed"], models["two"]
    first = two.curves[0]
    moved = replace(two, curves=(replace(first, control_points_cN=first.control_points_cN + 1),))
    points = np.array([1.0, 9, 4, 30])
    cubic = ForceCurve(Stroke.PRESS, 200.0, 3, np.repeat([0.0, 4.0], 4), points)
    base = replace(mixed, name="base", curves=(cubic, *mixed.of("press")[1:3]), vibrations=())
    return {**models, "moved": moved.renamed("moved"), "base": base}


def edits() -> list[dict[str, Any]]:
    """Return what the edits of fdvv.model make of models; null where they refuse."""
    models = edited_models()
    base, fast = models["base"], models["mixed"].of("press")[3]
    slow = models["mixed"].of("press")[0]
    rng = np.random.default_rng(SEED + 2)
    segments = [tuple(np.round(np.sort(rng.uniform(0, 4, 2)), 3).tolist()) for _ in range(6)]
    segments += [(0.0, 4.0), (0.0, 1.25), (3.0, 4.0), (1.0, 1.0), (1.0, 4.5)]
    made: list[tuple[dict[str, Any], Any]] = []
    for i, segment in enumerate(segments):
        blend = (0.1, 0.3)[i % 2]
        op = {"op": "assign", "on": "base", "curve": fast, "to": _at("press", 200.0), "segment_mm": segment}
        made.append(({**op, "blend_mm": blend}, _try(assign, base, fast, "press", 200.0, segment, blend)))
    whole = {"op": "assign", "on": "mixed", "curve": slow, "to": _at("release", 7.0)}
    made.append((whole, _try(assign, models["mixed"], slow, "release", 7.0)))
    for on, a, b in (
        ("spreads", ("press", 10.0), ("release", 10.0)),
        ("spreads", ("press", 10.0), ("press", 10.0)),
        ("two", ("press", 10.0), ("press", None)),
    ):
        op = {"op": "copy", "on": on, "from": _at(*a), "to": _at(*b)}
        made.append((op, _try(copy_curve, models[on], *a, *b)))
    for on, at in (("two", ("press", 80.0)), ("two", ("press", 81.0)), ("unknown", ("press", None))):
        made.append(({"op": "remove", "on": on, "at": _at(*at)}, _try(remove_curve, models[on], *at)))
    return [{**op, "made": result} for op, result in (*made, *_merges(models))]


def _merges(models: dict[str, FDVVModel]) -> Iterator[tuple[dict[str, Any], Any]]:
    at_four: dict[str, Any] = {"travel_mm": 4.0, "actuation_mm": 2.0}
    cases: list[tuple[tuple[str, ...], dict[str, Any]]] = [
        (("moved",), {}),
        (("spreads",), {}),
        (("mixed",), {}),
        (("mixed",), at_four),
        (("spreads", "moved"), {}),
    ]
    for others, given in cases:
        for rule in ("refuse", "first", "last"):
            op = {"op": "merge", "on": "two", "others": others, "options": {"conflict": rule, **given}}
            parts = [models["two"], *(models[name] for name in others)]
            yield op, _try(merge, parts, "two", conflict=rule, **given)


def _at(stroke: str, velocity_mm_s: float | None) -> dict[str, Any]:
    return {"stroke": stroke, "velocity_mm_s": velocity_mm_s}


def _try(work: Any, *args: Any, **kwargs: Any) -> Any:
    try:
        return work(*args, **kwargs)
    except ModelError:
        return None


def patches() -> list[dict[str, Any]]:
    """Return differences between models, and models that they do not fit."""
    models = example_models()
    two, mixed, spreads, unknown = (models[n] for n in ("two", "mixed", "spreads", "unknown"))
    points = two.curves[0].control_points_cN.copy()
    points[[0, -1]] += (1.5, -0.25)
    nudged = replace(two, curves=(replace(two.curves[0], control_points_cN=points), two.curves[1]))
    provenance = replace(mixed.provenance, source="x", assumptions=("a", "b"), simulated=True)
    pairs = [
        (two, two),
        (two, nudged),
        (two, spreads),
        (spreads, nudged),
        (two, replace(two, travel_mm=3.5, reset_mm=1.0, interpolation=Interpolation.LINEAR)),
        (
            mixed,
            replace(mixed, vibrations=mixed.vibrations[:1], provenance=provenance),
        ),
        (mixed, remove_curve(mixed, "release", 40.0)),
        (unknown, mixed),
    ]
    return [_patched(record_of(a), record_of(b), record_of(unknown)) for a, b in pairs]


def _patched(a: dict[str, Any], b: dict[str, Any], other: dict[str, Any]) -> dict[str, Any]:
    patch = patch_between(a, b)
    assert apply_patch(a, patch) == b
    assert apply_patch(b, inverse_patch(patch)) == a
    try:
        fits = apply_patch(other, patch) is not None
    except ModelError:
        fits = False
    return {"before": a, "after": b, "patch": msgspec.to_builtins(patch), "fits_unknown": fits}


def models() -> list[dict[str, Any]]:
    """Return the models that the other files name."""
    return [record_of(model) for model in edited_models().values()]


def reference() -> Iterator[tuple[str, str]]:
    """Return every file: its name and its text."""
    made = {
        "models": models(),
        "splines": splines(),
        "buttons": buttons(),
        "differences": differences(),
        "edits": edits(),
        "patches": patches(),
    }
    for name, cases in made.items():
        rows = ",\n".join(json.dumps(case, default=_plain, separators=(",", ":")) for case in cases)
        yield f"{name}.json", f"[\n{rows}\n]\n"


def _plain(value: Any) -> Any:
    if isinstance(value, FDVVModel):
        return record_of(value)
    if isinstance(value, ForceCurve):
        one = FDVVModel("one", 1.0, (value,))
        return record_of(one)["curves"][0]
    return value.tolist()


if __name__ == "__main__":
    TARGET.mkdir(parents=True, exist_ok=True)
    for file, text in reference():
        (TARGET / file).write_text(text)
        print(TARGET / file, len(text))
