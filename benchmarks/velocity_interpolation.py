"""How well is the force at a speed predicted from the curves at other speeds?

Leave one speed out, on the ten published curves: each is predicted from the four others of its stroke and
compared from 0.25 mm to 4 mm. ``python -m benchmarks.velocity_interpolation --all`` prints every rule. The
speeds inside (50, 100, 150 mm/s) test interpolation, the ends (0.5, 200 mm/s) extrapolation. Six curves judge
42 rules. The nested choice, in which the judged curve has no say, tells how that flatters.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

import numpy as np
from scipy.optimize import nnls

from benchmarks.velocity_rules import MODEL, RULES, Rule, X_mm
from fdvv.model.curve import Stroke
from fdvv.units import FloatArray

Case = tuple[Stroke, int]

SPEEDS_mm_s = np.array(MODEL.velocities_mm_s("press"))
FORCE_cN = {s: np.stack([c.force_cN(X_mm) for c in MODEL.of(s)]) for s in Stroke}
INSIDE: list[Case] = [(s, i) for s in Stroke for i in (1, 2, 3)]
ENDS: list[Case] = [(s, i) for i in (0, 4) for s in Stroke]
NESTED = ("linear", "pchip", "linear in sqrt v", "linear in log v")
SHOWN = ("nearest", *NESTED, "mean of all", "modified Akima", "cubic spline", "2 landmarks aligned, pchip")


def error_cN(rule: Rule, case: Case, also_left_out: int | None = None) -> FloatArray:
    """Predict one curve from the others of its stroke; (nx,) predicted less measured."""
    stroke, out = case
    keep = [i for i in range(5) if i not in (out, also_left_out)]
    F = FORCE_cN[stroke]
    return np.asarray(rule(SPEEDS_mm_s[keep], F[keep], float(SPEEDS_mm_s[out])) - F[out])


def rms(errors: Sequence[FloatArray] | FloatArray) -> float:
    return float(np.sqrt(np.mean(np.square(errors))))


def nested_choice(case: Case, strokes: Sequence[Stroke]) -> str:
    """Choose among NESTED by leaving out one more speed, the judged one never seen."""
    inside = [i for i in range(5) if i != case[1]][1:-1]
    return min(
        NESTED, key=lambda n: rms([error_cN(RULES[n], (s, i), case[1]) for s in strokes for i in inside])
    )


def hindsight_cN(case: Case) -> tuple[float, float]:
    """Return the least RMSE that any mix of the two neighbours, and of all four curves, could have had."""
    stroke, out = case
    F = FORCE_cN[stroke]

    def best(others: list[int]) -> float:
        # a heavy last row makes the weights add up to 1
        A = np.vstack([F[others].T, np.full(len(others), 1e5)])
        weights, _ = nnls(A, np.append(F[out], 1e5))
        return rms(weights @ F[others] - F[out])

    return best([out - 1, out + 1]), best([i for i in range(5) if i != out])


def row(rule: Rule) -> tuple[float, ...]:
    """Return RMSE inside for press, release, both; largest error inside; RMSE at 0.5, at 200 mm/s."""
    press, release = ([error_cN(rule, c) for c in INSIDE if c[0] is s] for s in Stroke)
    ends = (rms([error_cN(rule, c) for c in ENDS if c[1] == i]) for i in (0, 4))
    return (rms(press), rms(release), rms(press + release), float(np.abs(press + release).max()), *ends)


def nested_cN(per_stroke: bool) -> float:
    """Return the RMSE inside when the rule itself is chosen anew for each curve that judges."""
    picks = {c: nested_choice(c, (c[0],) if per_stroke else tuple(Stroke)) for c in INSIDE}
    return rms([error_cN(RULES[name], c) for c, name in picks.items()])


def main() -> None:
    print("leave one speed out, cN: RMSE inside (press, release, both), max; RMSE at 0.5, at 200 mm/s")
    for name in RULES if "--all" in sys.argv else SHOWN:
        print(f"{name:30}" + "".join(f"{figure:8.2f}" for figure in row(RULES[name])))
    print(f"nested choice: one for both strokes {nested_cN(False):.2f}, per stroke {nested_cN(True):.2f}")
    linear, pchip = ([rms(error_cN(RULES[n], c)) ** 2 for c in INSIDE] for n in ("linear", "pchip"))
    gain = np.subtract(linear, pchip)
    t = gain.mean() / gain.std(ddof=1) * 6**0.5
    print(f"pchip beats linear on {np.sum(gain > 0)} of 6 curves, paired t of the squared errors {t:.2f}")
    two, four = np.sqrt(np.mean(np.square([hindsight_cN(c) for c in INSIDE]), axis=0))
    print(f"hindsight: best mix of the two neighbours {two:.2f}, of all four {four:.2f}")
    less_offset = rms([e - e.mean() for e in (error_cN(RULES["linear"], c) for c in INSIDE)])
    print(f"linear, with the mean error of each judged curve removed: {less_offset:.2f}")


if __name__ == "__main__":
    main()
