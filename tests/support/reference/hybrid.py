"""A hybrid automaton integrated by SciPy: smooth pieces, and the moments at which one follows another."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Literal

import numpy as np

from fdvv.units import FloatArray

Rates = Callable[[float, FloatArray], FloatArray]
Guard = Callable[[FloatArray], float]
Method = Literal["DOP853", "Radau"]
Dense = Callable[[float], FloatArray]

RTOL, ATOL = 1e-9, 1e-12
INSTANT_s = 1e-13
MOST_SWITCHES = 200
"""In one span; more is a system that chatters, and a mistake in its guards."""


def first_crossing(guards: Sequence[Guard], dense: Dense, a: float, b: float) -> tuple[float, int] | None:
    """Return the time at which a guard first leaves the positive, with its number; None if none does.

    A guard that is not positive at `a` has just switched there: it counts once it has been positive.
    """
    from scipy.optimize import brentq

    found: tuple[float, int] | None = None
    for number, guard in enumerate(guards):
        if guard(dense(b)) >= 0:
            continue
        low = a
        if guard(dense(a)) <= 0:
            inside = [t for t in np.linspace(a, b, 9)[1:-1] if guard(dense(t)) > 0]
            low = inside[-1] if inside else b
        when = (
            a if low == b else float(brentq(lambda t, g=guard: g(dense(t)), low, b, xtol=1e-14, rtol=1e-15))
        )
        if found is None or when < found[0]:
            found = when, number
    return found


def solve_span(
    rates: Callable[[], Rates],
    guards: Callable[[], Sequence[Guard]],
    switch: Callable[[int, FloatArray], None],
    span: tuple[float, float],
    y: FloatArray,
    reads: FloatArray,
    method: Method,
) -> tuple[FloatArray, FloatArray]:
    """Solve over a span in which inputs are smooth; return the state at its end and at the times of `reads`.

    rates, guards : of the present mode. switch : changes the mode, given the guard crossed and the state.
    """
    from scipy.integrate import DOP853, Radau

    kinds: dict[str, Any] = {"DOP853": DOP853, "Radau": Radau}
    t, end = span
    seen, switches = np.zeros((reads.size, y.size)), 0
    while end - t > INSTANT_s:
        solver = kinds[method](rates(), t, y, end, rtol=RTOL, atol=ATOL, first_step=min(2e-5, end - t))
        while solver.status == "running":
            solver.step()
            if solver.status == "failed":
                raise ArithmeticError(f"the reference fails at {solver.t} s")
            a, b = float(solver.t_old), float(solver.t)
            dense = solver.dense_output()
            crossing = first_crossing(guards(), dense, a, b)
            until = b if crossing is None else crossing[0]
            for i in np.flatnonzero((reads > a) & (reads <= until + INSTANT_s)):
                seen[i] = dense(float(reads[i]))
            t, y = until, (solver.y if crossing is None else dense(until))
            if crossing is None:
                continue
            switch(crossing[1], y)
            switches += 1
            if switches > MOST_SWITCHES:
                raise ArithmeticError(f"the reference chatters at {t} s")
            break
    return y, seen
