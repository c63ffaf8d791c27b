"""From a model to a real switch: every kind that can be made, the one to choose, the twin's word on it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from fdvv.errors import InputError, ModelError
from fdvv.force_text import force_text
from fdvv.model.model import FDVVModel
from fdvv.twin.button import ButtonPhysics
from fdvv_switch.facts import facts_of, notes_of
from fdvv_switch.making import Making
from fdvv_switch.mechanism import KINDS, Mechanism, design
from fdvv_switch.residual import Residual, WANTED_cN, residual_of
from fdvv_switch.target import Target, target_of
from fdvv_switch.tolerance import Band, band_of
from fdvv_switch.twin import PressedDesign, SPEEDS_mm_s, mechanism_button, press_design

AUTO = "auto"
AS_GOOD_cN = 0.5
"""A simpler kind is preferred to one that is better by no more than this."""


@dataclass(frozen=True, eq=False)
class DesignedKind:
    """What became of one kind: a mechanism and what it misses, or the reason why there is none."""

    kind: str
    mechanism: Mechanism | None
    residual: Residual | None
    refused: str = ""


@dataclass(frozen=True, eq=False)
class MechanismResult:
    """A mechanism for a model.

    Attributes
    ----------
    kinds : every kind that was tried, the simplest first.
    mechanism, residual, band : of the chosen one.
    recommendation : why it was chosen, a sentence.
    button : the design as a real button of the twin; None if the twin cannot take it, and then twin_refused.
    pressed : what the twin gave, slow first; simulated.
    """

    model: FDVVModel
    target: Target
    making: Making
    kinds: tuple[DesignedKind, ...]
    mechanism: Mechanism
    residual: Residual
    band: Band
    recommendation: str
    button: ButtonPhysics | None
    pressed: tuple[PressedDesign, ...] = ()
    twin_refused: str = ""
    notes: tuple[str, ...] = field(default=())

    @property
    def met(self) -> bool:
        """Return whether the design, and the twin pressed slowly, give both strokes within WANTED_cN."""
        if not self.residual.met or not self.pressed:
            return False
        return max(self.pressed[0].press.rms_cN, self.pressed[0].release.rms_cN) <= WANTED_cN

    def to_dict(self) -> dict[str, object]:
        """Return it for JSON, units in the names."""
        band = self.band
        shares = [
            {"tolerance": s.tolerance.name, "half": s.tolerance.half, "of": s.tolerance.path}
            | {"source": s.tolerance.source, "rms_cN": s.rms_cN}
            for s in band.shares
        ]
        return {
            "model": self.model.name,
            "kind": self.mechanism.kind,
            "recommendation": self.recommendation,
            "met": self.met,
            "wanted_cN": WANTED_cN,
            "travel_mm": self.target.travel_mm,
            "close_mm": self.target.close_mm,
            "parts": facts_of(self.mechanism, self.target),
            "notes": list(self.notes),
            "residual": self.residual.to_dict(),
            "band": {
                "percent": [5, 95],
                "half_width_cN": band.half_width_cN,
                "peak_cN": band.peak_cN,
                "valley_cN": band.valley_cN,
                "snap_ratio": band.snap_ratio,
                "shares": shares,
            },
            "kinds": [
                {"kind": k.kind, "refused": k.refused or None}
                | ({} if k.residual is None else {"residual": k.residual.to_dict()})
                for k in self.kinds
            ],
            "twin": {
                "simulated": True,
                "refused": self.twin_refused or None,
                "pressed": [p.to_dict() for p in self.pressed],
            },
        }


def design_mechanism(
    model: FDVVModel,
    kind: str = AUTO,
    making: Making | None = None,
    speeds_mm_s: Sequence[float] = SPEEDS_mm_s,
    progress: Callable[[str, int, int], None] = lambda _label, _done, _total: None,
) -> MechanismResult:
    """Design the mechanism that gives a model's slow curves, and press it on the twin.

    kind : one of KINDS, or auto: all are tried and the simplest of the best is chosen. making : what can be
    made. speeds_mm_s : at which the twin presses it beside the slow press.

    Raises InputError if no kind can be made: every reason is in it.
    """
    making = making or Making()
    try:
        target = target_of(model)
    except ModelError as error:
        reason = str(error).removeprefix(f"{model.name}: ")
        raise InputError(model.name, "curves", reason, "choose a model with press and release") from error
    asked = KINDS if kind == AUTO else (kind,)
    kinds = []
    for done, one in enumerate(asked):
        progress("designing", done, len(asked))
        kinds.append(_designed(target, one, making))
    chosen = _chosen(kinds, model.name)
    assert chosen.mechanism is not None
    assert chosen.residual is not None
    progress("pressing on the twin", 0, 1)
    band = band_of(chosen.mechanism, target.displacement_mm)
    button, pressed, refused = _verified(chosen.mechanism, target, model, speeds_mm_s)
    return MechanismResult(
        model,
        target,
        making,
        tuple(kinds),
        chosen.mechanism,
        chosen.residual,
        band,
        _why(chosen, kinds),
        button,
        pressed,
        refused,
        tuple(notes_of(chosen.mechanism, target)),
    )


def _designed(target: Target, kind: str, making: Making) -> DesignedKind:
    try:
        mechanism = design(target, kind, making)
    except ModelError as error:
        return DesignedKind(kind, None, None, str(error))
    return DesignedKind(kind, mechanism, residual_of(target, mechanism, making))


def _chosen(kinds: Sequence[DesignedKind], name: str) -> DesignedKind:
    made = [(k, k.residual.worst_cN) for k in kinds if k.residual is not None]
    if not made:
        reasons = "; ".join(f"{k.kind}: {k.refused}" for k in kinds)
        raise InputError(name, "mechanism", reasons, "change the limits or the curves")
    best = min(worst for _, worst in made)
    return next(k for k, worst in made if worst <= best + AS_GOOD_cN)


def _why(chosen: DesignedKind, kinds: Sequence[DesignedKind]) -> str:
    assert chosen.residual is not None
    others = [
        f"{k.kind} "
        + ("cannot be made" if k.residual is None else f"{force_text(k.residual.worst_cN, '.1f')}")
        for k in kinds
        if k is not chosen
    ]
    beside = f" ({', '.join(others)})" if others else ""
    verdict = "gives" if chosen.residual.met else "comes nearest to"
    return (
        f"a {chosen.kind} {verdict} the curves: its worse stroke misses by "
        f"{force_text(chosen.residual.worst_cN, '.1f')} rms{beside}"
    )


def _verified(
    mechanism: Mechanism, target: Target, model: FDVVModel, speeds_mm_s: Sequence[float]
) -> tuple[ButtonPhysics | None, tuple[PressedDesign, ...], str]:
    origin = model.provenance
    try:
        button = mechanism_button(mechanism, target, origin.citation or origin.source, origin.licence)
        return button, press_design(button, model, speeds_mm_s), ""
    except ModelError as error:
        return None, (), str(error)
