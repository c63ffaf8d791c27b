"""What is sealed of a trial is as long whatever was rendered, and comes back."""

from __future__ import annotations

import random

import msgspec
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.errors import ModelError
from fdvv_people.study.files.people import SealedTrial
from fdvv_people.study.plan.plan_file import read_plan_text, template_text
from fdvv_people.study.plan.trial import Rendered, StudyTrial
from fdvv_people.study.session.trial import SEALED_BYTES, ReconnectableRenderer, sealed_bytes
from fdvv_people.study.simulation.participant import NullRenderer

ODD = (None, float("nan"), float("inf"), 1e9, 0.0, 1.0 / 3.0)
NAMES = ("FD", "x" * 60, "\u00fc" * 60, "\x01" * 60, "\U0001f600" * 60)


def rendered(label: str, rng: random.Random) -> Rendered:
    count = rng.choice([0, 1, 3, 50, 400])
    errors, speeds = (tuple(rng.choice([*ODD, 99.0 * rng.random()]) for _ in range(count)) for _ in range(2))
    faults = tuple(rng.choice(NAMES) * 2 for _ in range(rng.choice([0, 1, 20])))
    return Rendered(label, rng.choice(NAMES), count, errors, speeds, 10 ** rng.randint(0, 4), faults)


@settings(deadline=None, max_examples=40)
@given(st.integers(0, 8), st.integers())
def test_every_trial_is_as_long_and_names_what_was_rendered(labels: int, seed: int) -> None:
    rng = random.Random(seed)
    whole = SealedTrial(
        rng.randint(0, 400), rng.random(), tuple(rendered(c, rng) for c in "ABCDEFGX"[:labels])
    )
    data = sealed_bytes(whole)
    assert len(data) == SEALED_BYTES
    found = msgspec.json.decode(data, type=SealedTrial)
    assert (found.number, found.ratio) == (whole.number, whole.ratio)
    for one, wanted in zip(found.rendered, whole.rendered, strict=True):
        assert (one.label, one.stimulus, one.presses) == (wanted.label, wanted.stimulus, wanted.presses)


def test_of_a_trial_of_usual_length_nothing_is_left_out() -> None:
    whole = SealedTrial(
        3, 0.25, (Rendered("A", "FD", 3, (0.5, None, 2.125), (80.0, 81.5, None), 2, ("lag",)),)
    )
    assert msgspec.json.decode(sealed_bytes(whole), type=SealedTrial) == whole


def test_of_very_many_presses_as_many_are_kept_as_fit_evenly_over_all() -> None:
    errors = tuple(float(i) for i in range(3000))
    many = SealedTrial(0, 0.0, (Rendered("A", "FD", 3000, errors, errors),))
    (kept,) = msgspec.json.decode(sealed_bytes(many), type=SealedTrial).rendered
    left = np.array(kept.error_cN, dtype=np.float64)
    assert kept.presses == 3000
    assert len(left) > 190
    assert (left[0], left[-1]) == (0.0, 2999.0)
    assert np.ptp(np.diff(left)) <= 1.0
    assert kept.velocity_mm_s == kept.error_cN


def test_more_renderings_than_a_page_holds_are_refused() -> None:
    with pytest.raises(ModelError, match="too much"):
        sealed_bytes(SealedTrial(0, 0.0, tuple(Rendered("A", "x" * 60) for _ in range(200))))


def test_of_a_lost_trial_every_label_tells_so() -> None:
    plan = read_plan_text(template_text("realism"), "realism")
    trial = StudyTrial(3, plan.items[0].name, 0, {"A": "FD", "B": "FDVV"}, ratio=0.25)
    found = ReconnectableRenderer(plan, NullRenderer()).lost(trial, "line broke")
    assert (found.number, found.ratio) == (3, 0.25)
    assert [(one.label, one.stimulus, one.faults) for one in found.rendered if one.label != "X"] == [
        ("A", "FD", ("device lost", "line broke")),
        ("B", "FDVV", ("device lost", "line broke")),
    ]
