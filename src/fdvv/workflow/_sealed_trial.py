"""What was rendered in a trial, as bytes of one length whatever they tell; the seal locks them."""

from __future__ import annotations

import msgspec
import numpy as np

from fdvv.errors import ModelError
from fdvv.study import Rendered
from fdvv.workflow._study_people import SealedTrial

SEALED_BYTES = 16_384
"""Of every trial: hidden renderings, presses or faults that need more or fewer letters do not show."""
_LABEL_BYTES, _PRESS_BYTES = 1_200, 22
_LARGEST, _FAULTS, _FAULT = 99_999.0, 6, 40


def sealed_bytes(trial: SealedTrial) -> bytes:
    """Write a trial in exactly SEALED_BYTES. ModelError where it has too many labels for that.

    Of very many presses as many are kept as fit, evenly over all: their middle error decides whether a trial
    counts.
    """
    room = SEALED_BYTES // max(1, len(trial.rendered)) - _LABEL_BYTES
    kept = tuple(_short(one, max(1, room // _PRESS_BYTES)) for one in trial.rendered)
    text = msgspec.json.encode(msgspec.structs.replace(trial, rendered=kept))
    if len(text) > SEALED_BYTES:
        raise ModelError(f"a trial of {len(trial.rendered)} renderings is too much to be sealed")
    # blanks at the end of JSON mean nothing
    return text.ljust(SEALED_BYTES)


def lost_trial(trial: SealedTrial, stimuli: dict[str, str], reason: str) -> SealedTrial:
    """Give a trial whose device went away before it could tell. stimuli : names, by label."""
    faults = ("device lost", reason)
    rendered = tuple(Rendered(label, name, faults=faults) for label, name in stimuli.items())
    return msgspec.structs.replace(trial, rendered=rendered)


def _short(one: Rendered, presses: int) -> Rendered:
    count = len(one.error_cN)
    even = np.unique(np.linspace(0, count - 1, min(count, presses)).astype(int)).tolist()
    return msgspec.structs.replace(
        one,
        error_cN=tuple(_number(one.error_cN[i]) for i in even),
        velocity_mm_s=tuple(_number(one.velocity_mm_s[i]) for i in even if i < len(one.velocity_mm_s)),
        faults=tuple(_plain(fault[:_FAULT]) for fault in one.faults[:_FAULTS]),
    )


def _plain(text: str) -> str:
    """Put ? in the place of letters that need many bytes."""
    return "".join(letter if letter.isascii() and letter.isprintable() else "?" for letter in text)


def _number(value: float | None) -> float | None:
    return None if value is None or not np.isfinite(value) else round(min(value, _LARGEST), 3)
