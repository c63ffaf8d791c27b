"""The paths of strokes: cut out of presses, found between frames, extended beside the stop.

Between a stop, or rest, and the nearest frame the path goes on by the equation that held between frames, as
far as the force was sampled before the stop took over. At 200 mm/s that is up to 0.8 mm of the stroke.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from fdvv.model.curve import Stroke
from fdvv.preprocess.fuse import CurveOfForce, Fusion, Path, Seen, fuse, zero_curve
from fdvv.preprocess.press import LEFT_mm, NEAR_mm, StrokeTrack
from fdvv.preprocess.reject import Judged
from fdvv.units import FloatArray, N_from_cN, cN_from_N

PARTS = 10
"""Steps of integration per sample of the force."""
DOUBT_s = 2.5e-4
"""A cap that moves is near an end earlier: its place is known to what it covers in this time."""
JUMP_cN = 10.0
"""Where the force changes within a sample by so much more than the button's could, the stop has been hit."""
LONGEST = 12
"""Samples that are added at most: beyond three frames of the slowest camera something else is wrong."""


def extend(
    seen: Seen,
    path: Path,
    forward: bool,
    recorded: tuple[FloatArray, FloatArray],
    shape: CurveOfForce,
    moving_g: float,
    ends_mm: tuple[float, float],
) -> Seen:
    """Add samples after a stroke's window, or before it, with a guess of the path there.

    forward : after it.
    recorded : times and forces of the whole press, on the same grid as seen.t_s.
    ends_mm : between these depths the stroke lies; samples beyond belong to rest or stop.
    """
    t_s, force_cN = recorded
    edge, way = (-1, 1) if forward else (0, -1)
    here = int(np.argmin(np.abs(t_s - seen.t_s[edge])))
    x, v = float(path.displacement_mm[edge]), float(path.velocity_mm_s[edge])
    down, step_s = v > 0, way * (t_s[1] - t_s[0]) / PARTS
    places: list[float] = []
    i = here
    while 0 <= i + way < t_s.size and len(places) < LONGEST:
        before_cN = float(shape(np.array([x]))[0][0])
        for k in range(PARTS):
            pull_cN = force_cN[i] + (force_cN[i + way] - force_cN[i]) * (k + 0.5) / PARTS
            button_cN = float(shape(np.array([x]))[0][0])
            # newtons over grams are 1e6 mm/s2
            v += step_s * 1e6 * float(N_from_cN(pull_cN - button_cN)) / moving_g
            x += step_s * v
        margin_mm = DOUBT_s * abs(v)
        # a cap that turns round, or that something other than the button holds up, is no longer in the stroke
        if not ends_mm[0] + margin_mm <= x <= ends_mm[1] - margin_mm or (v > 0) != down:
            break
        change_cN = abs(button_cN - before_cN)
        if abs(force_cN[i + way] - force_cN[i]) > JUMP_cN + 2 * change_cN:
            break
        i += way
        places.append(x)
    if not places:
        return seen
    added = slice(here + 1, i + 1) if forward else slice(i, here)
    guess = np.array(places if forward else places[::-1])
    columns = (seen.t_s, t_s[added]), (seen.force_cN, force_cN[added]), (path.displacement_mm, guess)
    times, forces, guesses = (np.concatenate(pair[:: 1 if forward else -1]) for pair in columns)
    return replace(seen, t_s=times, force_cN=forces, guess_mm=guesses)


UNKNOWN_PIECES, UNKNOWN_N = 25, 1e3
"""Spans of the button's force, and what it may be, where nothing was known of it."""
LEAST_NOISE_mm, USUAL_NOISE_mm, LEAST_STEPS = 0.002, 0.03, 30
"""A frame is never surer than the first; the second is used where there are fewer steps at rest."""
FEWEST_FRAMES = 2
"""Frames that must show a stroke on its way: one leaves its speed to the equation alone."""
FEWEST = 3
"""Presses of one kind: fewer give no spread."""


@dataclass(frozen=True)
class Paths:
    """Finds paths.

    Attributes
    ----------
    cap_g, tip_g : masses of the cap and of the force sensor's tip.
    zero_mm : added to all depths.
    """

    cap_g: float
    tip_g: float
    zero_mm: float

    def _cut_out(self, entry: Judged, stroke: Stroke) -> Seen | None:
        """Cut one stroke out, from where the cap leaves its rest to the last frame before the stop."""
        press, spans = entry.press, entry.spans
        # frames so near to the stop measure the stop, not the stroke
        near = press.frame_mm > spans.bottom_mm - NEAR_mm
        begin_s, end_s = spans.of(stroke)
        if stroke is Stroke.PRESS:
            inside = (press.frame_s <= end_s) & ~near & (press.frame_s >= begin_s - 0.01)
        else:
            # one frame of the cap back at rest bounds its arrival
            after = press.frame_s[press.frame_s > end_s]
            last_s = float(after[0]) if after.size else end_s
            inside = (press.frame_s >= begin_s) & ~near & (press.frame_s <= last_s)
        frames = np.flatnonzero(inside)
        if np.sum(inside & (press.frame_mm > LEFT_mm)) < FEWEST_FRAMES:
            return None
        low, high = press.frame_s[frames[0]], press.frame_s[frames[-1]]
        step_s = float(press.t_s[1] - press.t_s[0])
        in_window = (press.t_s >= low - 0.2 * step_s) & (press.t_s <= high + 0.2 * step_s)
        t_s = press.t_s[in_window]
        if t_s.size < 4:
            return None
        shown = (press.frame_s >= t_s[0]) & (press.frame_s <= t_s[-1])
        if shown.sum() < 2:
            return None
        depth_mm = press.frame_mm + self.zero_mm
        guess = np.interp(t_s, press.frame_s, depth_mm)
        return Seen(t_s, press.force_cN[in_window], press.frame_s[shown], depth_mm[shown], guess)

    def find(
        self, used: Sequence[Judged], stroke: Stroke, known: CurveOfForce | None
    ) -> tuple[list[Judged], list[StrokeTrack], CurveOfForce] | None:
        """Find the paths of one stroke of presses at one velocity, and the button's force behind them.

        known : the button's force as far as it is known; None if nothing is. Returns None if fewer than three
        presses show the stroke, else those that do, their tracks and the force. First between frames, then
        once more with what lies between the stop and a frame.
        """
        whole = [(entry, seen) for entry in used if (seen := self._cut_out(entry, stroke)) is not None]
        if len(whole) < FEWEST:
            return None
        moving_g = self.cap_g + self.tip_g
        fusion = Fusion(moving_g, _frame_noise_mm([entry for entry, _ in whole]))
        if known is None:
            fusion = replace(fusion, pieces=UNKNOWN_PIECES, unknown_N=UNKNOWN_N)
        known = known or zero_curve
        paths, shape = fuse([seen for _, seen in whole], known, fusion)
        longer = []
        for (entry, short), path in zip(whole, paths, strict=True):
            recorded = entry.press.t_s, entry.press.force_cN
            ends_mm = self.zero_mm + LEFT_mm, entry.spans.bottom_mm + self.zero_mm - LEFT_mm
            longer.append(extend(short, path, stroke is Stroke.PRESS, recorded, shape, moving_g, ends_mm))
        paths, shape = fuse(longer, known, fusion)
        used = [entry for entry, _ in whole]
        rows = zip(used, longer, paths, strict=True)
        return used, [self._track(entry, stroke, seen, path) for entry, seen, path in rows], shape

    def _track(self, entry: Judged, stroke: Stroke, seen: Seen, path: Path) -> StrokeTrack:
        """Return a stroke with the force between finger and cap, without the inertia of the tip."""
        tip_kg = 1e-3 * self.tip_g
        back = np.flatnonzero(path.displacement_mm < LEFT_mm) if stroke is Stroke.RELEASE else np.zeros(0)
        # what follows the return to rest is the upper stop's
        until = slice(None, int(back[0]) if back.size and back[0] > 3 else None)
        return StrokeTrack(
            entry.press.take,
            entry.press.part,
            stroke,
            seen.t_s[until],
            path.displacement_mm[until],
            path.velocity_mm_s[until],
            path.acceleration_m_s2[until],
            (seen.force_cN - cN_from_N(tip_kg * path.acceleration_m_s2))[until],
        )


def _frame_noise_mm(used: Sequence[Judged]) -> float:
    """Estimate the noise of a frame from successive frames while the cap rested."""
    rests = [entry.press.frame_mm[entry.press.frame_s < entry.spans.rest_end_s] for entry in used]
    joined = np.concatenate([np.zeros(0), *map(np.diff, rests)])
    if joined.size < LEAST_STEPS:
        return USUAL_NOISE_mm
    # 1.4826 makes a standard deviation of a median one; a step has the noise of two frames
    return max(1.4826 * float(np.median(np.abs(joined))) / float(np.sqrt(2)), LEAST_NOISE_mm)
