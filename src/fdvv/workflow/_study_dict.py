"""An analysis as plain values, for JSON."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import msgspec

from fdvv.study import Multiverse
from fdvv.workflow._study_choice_records import ClaimResult
from fdvv.workflow._study_records import RatedResult, StudyAnalysis, ThresholdResult, TimingResult

PROXY = "simulated participants: a proxy, no evidence"
"""What stands wherever simulated answers are shown."""


def analysis_dict(found: StudyAnalysis) -> dict[str, Any]:
    """Give everything an analysis found; units are in the names, shares and ratios are parts of 1."""
    return {
        "study": found.title,
        "kind": found.kind,
        "simulated": found.simulated,
        **({"proxy": PROXY} if found.simulated else {}),
        "buttons": list(found.buttons),
        "stimuli": list(found.stimuli),
        "screening": _screening(found),
        "claim": found.claim and _claim(found.claim),
        "tests": [one.to_dict() for one in found.tests],
        "ordinal": [asdict(one) for one in found.scales],
        "preference": found.preference and found.preference.to_dict(),
        "by_button": [one.to_dict() for one in found.by_button],
        "rated": [_rated(one) for one in found.rated],
        "threshold": found.threshold and asdict(found.threshold),
        "thresholds": [_threshold(one) for one in found.thresholds],
        "timing": found.timing and _timing(found.timing),
        "multiverse": found.multiverse and _multiverse(found.multiverse),
        "people": [asdict(one) for one in found.people],
        "notes": list(found.notes),
    }


def _screening(found: StudyAnalysis) -> dict[str, Any]:
    told = found.screening
    return {
        "people": len(told.people),
        "people_counted": told.people_counted,
        "trials": told.planned,
        "answered": told.answered,
        "counted": told.counted,
        "reasons": dict(told.reasons),
        "left_out": dict(told.left_out),
    }


def _claim(found: ClaimResult) -> dict[str, Any]:
    return {
        **msgspec.to_builtins(found.claim),
        "registered": found.registered,
        "measured_by": found.measure,
        "supported": found.supported,
        "test": asdict(found.test),
    }


def _rated(found: RatedResult) -> dict[str, Any]:
    return {
        "button": found.button,
        "rating": found.rating,
        "stimuli": {name: asdict(one) for name, one in found.spreads.items()},
        "friedman": found.friedman and asdict(found.friedman),
        "pairs": [asdict(one) for one in found.pairs],
    }


def _threshold(found: ThresholdResult) -> dict[str, Any]:
    return {
        "person": found.person,
        "button": found.button,
        "trials": int(found.ratios.size),
        "threshold_ratio": found.threshold.value,
        "low": found.threshold.low,
        "high": found.threshold.high,
    }


def _timing(found: TimingResult) -> dict[str, Any]:
    return {
        "measure": found.measure,
        "people": len(found.scores),
        "means": {
            f"{button}, {level}": float(found.scores[:, i, j].mean())
            for i, button in enumerate(found.buttons)
            for j, level in enumerate(found.levels)
        },
        "anova": found.anova and [asdict(one) for one in found.anova.effects],
        "pairs": {level: [asdict(one) for one in pairs] for level, pairs in found.pairs.items()},
    }


def _multiverse(found: Multiverse) -> dict[str, Any]:
    return {
        "ways": len(found.specifications),
        "agreeing": found.agreeing,
        "significant": found.significant,
        "alpha": found.alpha,
        "specifications": [asdict(one) for one in found.specifications],
    }
